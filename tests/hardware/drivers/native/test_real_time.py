"""The shipped driver over pyserial and a pty, with the firmware in real time."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections import deque
from collections.abc import Iterator
from pathlib import Path

import pytest

from hardware.clock import WallClock
from hardware.codecs import native
from hardware.drivers.native.driver import NativeDriver
from hardware.drivers.native.queue import AHEAD_S
from hardware.port import Line
from planner.arrays import FloatArray
from planner.errors import HardwareError
from tests.hardware.drivers.native.runs import PERIOD_S, against_plan, driver_on, waves
from tests.hardware.emulator.emulator import Emulator
from tests.hardware.real_time import in_real_time

_RUN_S = 4.0
_SURVIVED_S = 0.4
"""A stall of the host that goes unnoticed. A virtual machine may be kept from its cores for longer than that."""
_LOOKS_S = 0.02
"""At the clock, at most so far apart, where nothing keeps the driver from it."""


def _spin(until_s: float) -> None:
    while time.monotonic() < until_s:
        pass


@pytest.fixture
def busy_cores() -> Iterator[None]:
    """One process a core that computes without end."""
    context = multiprocessing.get_context("spawn")
    busy = [context.Process(target=_spin, args=(time.monotonic() + 600,)) for _ in range(os.cpu_count() or 1)]
    for process in busy:
        process.start()
    yield
    for process in busy:
        process.kill()
        process.join()


def _play(driver: NativeDriver, plan: FloatArray) -> None:
    for positions in plan:
        driver.send(positions, PERIOD_S)


class _WatchedClock(WallClock):
    """Real time, and the longest that the driver, which looks at it every few milliseconds, was kept from it while a
    full queue lasts: at once, or in parts with no time between to fill the queue."""

    def __init__(self) -> None:
        self.watch()

    def watch(self) -> None:
        """Begin now."""
        self._last_s, self.longest_stall_s = super().now_s(), 0.0
        self._stalls: deque[tuple[float, float]] = deque()  # when each ended, and how long it was

    def now_s(self) -> float:
        now_s = super().now_s()
        if now_s - self._last_s > _LOOKS_S:
            self._stalls.append((now_s, now_s - self._last_s))
            while self._stalls[0][0] < now_s - AHEAD_S:
                self._stalls.popleft()
            self.longest_stall_s = max(self.longest_stall_s, sum(stall_s for _, stall_s in self._stalls))
        self._last_s = now_s
        return now_s


def _driver(device: Path, clock: WallClock) -> NativeDriver:
    return driver_on(Line(str(device)).open(native.BAUD), clock)


@in_real_time("the emulated controller is kept from its core while its host sends")
@pytest.mark.usefixtures("busy_cores")
def test_busy_cores_starve_nothing(pty: tuple[Emulator, Path]) -> None:
    emulator, device = pty
    plan, clock = waves(_RUN_S), _WatchedClock()
    driver = _driver(device, clock)
    driver.connect(plan[0])
    time.sleep(0.1)
    since_s = emulator.pulses(0).starts_s[-1]
    clock.watch()
    _play(driver, plan[1:])
    driver.flush()
    longest_stall_s = clock.longest_stall_s
    assert driver.executed() == len(plan) - 1
    driver.close()
    time.sleep(0.2)
    if "under-runs: 0" not in driver.statistics() and longest_stall_s >= _SURVIVED_S:
        pytest.skip(f"the machine stood still for {longest_stall_s:.2f} s, which the queue is not made for")
    assert "under-runs: 0" in driver.statistics()
    assert against_plan(emulator, plan, since_s).worst_us <= 0.5


@in_real_time("the emulated controller is kept from its core for longer than an answer is waited for")
def test_a_cable_pulled_and_put_back(pty: tuple[Emulator, Path]) -> None:
    emulator, device = pty
    plan, driver = waves(3.0), _driver(device, WallClock())
    driver.connect(plan[0])
    _play(driver, plan[1:100])
    emulator.move_cable()
    with pytest.raises(HardwareError, match="cable"):
        _play(driver, plan[100:])
    driver.close()
    emulator.move_cable()
    deadline_s = time.monotonic() + 5
    while not device.exists() and time.monotonic() < deadline_s:
        time.sleep(0.01)
    again = _driver(device, WallClock())
    again.connect(plan[0])
    _play(again, plan[1:50])
    again.flush()
    assert again.executed() == 49
    again.close()
