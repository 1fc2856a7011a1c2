from __future__ import annotations

import time

from hardware.clock import InstantClock, WallClock


def test_wall_clock_sleeps_to_the_deadline_and_not_at_all_past_it() -> None:
    clock = WallClock()
    start_s = clock.now_s()
    clock.sleep_until(start_s + 0.03)
    assert clock.now_s() >= start_s + 0.03
    began = time.perf_counter()
    clock.sleep_until(start_s - 10)
    assert time.perf_counter() - began < 0.02


def test_instant_clock_jumps_forwards_only() -> None:
    clock = InstantClock()
    began = time.perf_counter()
    clock.sleep_until(1e6)
    assert time.perf_counter() - began < 1
    assert clock.now_s() == 1e6
    clock.sleep_until(5)
    assert clock.now_s() == 1e6
