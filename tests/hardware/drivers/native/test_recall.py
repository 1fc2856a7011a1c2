"""A controller remembers how far it came when its host is lost, and the pins are where it says."""

from __future__ import annotations

import ctypes
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.codecs import native
from hardware.codecs.native import Order, State, Status
from hardware.drivers.driver import Tally
from hardware.drivers.native.driver import NativeDriver
from planner.arrays import FloatArray
from planner.errors import HardwareError
from tests.hardware.drivers.native.runs import PERIOD_S, driver_on, line_of, progress
from tests.hardware.emulator.emulator import (
    FIRMWARE,
    Build,
    Faults,
    LockStep,
    in_lock_step,
    require_tools,
)

_NOISE = 1.0 / 400.0
_TOLD_S = 0.025
"""So long it takes until all servos have been told of where the path has come to."""


def _begun(controller: LockStep, plan: FloatArray, sent: int, every_s: float = PERIOD_S) -> Tally:
    """What is known of a run whose host is gone after so many set points."""
    driver = driver_on(controller, controller)
    driver.connect(plan[0])
    tally = driver.tally(every_s)
    for positions in plan[1:sent]:
        driver.send(positions, every_s)
    return tally


def _assert_told(controller: LockStep, plan: FloatArray, since_s: float, reached: int | None, lag: float) -> None:
    """No more than the pins have come to, and less by no more than `lag` set points."""
    _, along = progress(controller.emulator, plan, since_s)
    come_to = along[-1] * (len(plan) - 1)
    assert reached is not None
    assert reached - _NOISE * len(plan) <= come_to <= reached + lag + _NOISE * len(plan)


@pytest.mark.parametrize("later_s", [0.0, 0.3, 1.0, 8.0])
@pytest.mark.parametrize("faults", [Faults(), Faults(flip=0.01, drop=0.01)])
def test_what_was_executed_outlives_the_host(
    lock_step: Callable[[Faults], LockStep], later_s: float, faults: Faults
) -> None:
    """Asked while it plays what is queued it tells once it stands, be that in an under-run or given up."""
    controller, plan = lock_step(faults), line_of(4.0)
    since_s = controller.now_s()
    tally = _begun(controller, plan, 200)
    controller.sleep_until(controller.now_s() + later_s)
    again = driver_on(controller, controller)
    reached = again.recall(tally)
    _assert_told(controller, plan, since_s, reached, 1.0)
    assert again.recall(tally) == reached
    again.connect(plan[0])
    assert again.recall(tally) is None
    assert again.recall(again.tally(PERIOD_S)) == 0


@pytest.mark.parametrize("later_s", [0.0, 0.1, 0.217, 2.0])
def test_it_outlives_a_reset_but_not_the_power(controller: LockStep, later_s: float) -> None:
    """As opening the line of an Arduino does. Servos that a reset lets go of may not yet have been told of the last."""
    plan = line_of(4.0)
    since_s = controller.now_s()
    tally = _begun(controller, plan, 200)
    controller.sleep_until(controller.now_s() + later_s)
    controller.emulator.reset()
    again = driver_on(controller, controller)
    _assert_told(controller, plan, since_s, again.recall(tally), 1.0 + _TOLD_S / PERIOD_S)
    controller.emulator.lose_power()
    assert again.recall(tally) is None


def test_set_points_that_are_merged_are_counted_as_what_they_are(controller: LockStep) -> None:
    plan = line_of(4.0)
    fine: FloatArray = np.linspace(plan[0], plan[-1], 2001)
    since_s = controller.now_s()
    tally = _begun(controller, fine, 1200, 0.002)
    assert tally.each == 5
    _assert_told(controller, fine, since_s, driver_on(controller, controller).recall(tally), 5.0)


def test_a_run_that_began_after_moves_of_its_own_is_counted_from_its_first_set_point(controller: LockStep) -> None:
    """An arm that still holds is first taken to where the run sets out, in key frames of the same session."""
    plan = line_of(4.0)
    _begun(controller, plan, 100)
    controller.sleep_until(controller.now_s() + 2.0)
    tally = _begun(controller, plan, 150)
    assert tally.first > 50
    since_s = controller.now_s()
    _assert_told(controller, plan, since_s - 0.1, driver_on(controller, controller).recall(tally), 1.0)


_PINS = """
#include "pulses.h"
#include "protocol.h"
void pulses_divide(uint8_t channels) { (void)channels; }
uint16_t slot_ticks(uint8_t channels) { return (uint16_t)(PULSE_PERIOD_TICKS / channels); }
void pulses_set(uint8_t channel, uint16_t pulse) { (void)channel; (void)pulse; }
"""


@pytest.fixture(scope="module")
def machine(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """The firmware without its pins and its line, compiled for this computer: hours of it take seconds."""
    require_tools()
    folder = tmp_path_factory.mktemp("machine")
    (folder / "pins.c").write_text(_PINS)
    sources = [FIRMWARE / f"{name}.c" for name in ("machine", "playhead", "queue", "record", "frames")]
    subprocess.run(
        [
            "gcc",
            "-std=c11",
            "-O2",
            "-fshort-enums",
            "-shared",
            "-fPIC",
            f"-I{FIRMWARE}",
            "-o",
            folder / "machine.so",
            folder / "pins.c",
            *sources,
        ],
        check=True,
    )
    return ctypes.CDLL(str(folder / "machine.so"))


def test_more_key_frames_than_a_word_counts(machine: ctypes.CDLL) -> None:
    total, batch = 70_000, 50

    def give(kind: int, sequence: int, payload: bytes = b"") -> None:
        body = bytes([kind, sequence]) + payload
        machine.machine_receive(body, len(body))

    def status() -> Status:
        body = ctypes.create_string_buffer(64)
        while (length := machine.machine_answer(body)) and body.raw[0] != 0x82:
            pass
        (message,) = native.Reader().feed(native.frame(body.raw[0], body.raw[1], body.raw[2:length]))
        assert isinstance(message, Status)
        return message

    machine.machine_start()
    give(Order.HELLO, 1, struct.pack("<H", 77))
    give(Order.CONFIG, 2, struct.pack("<HHH", 16000, 32000, 24000))
    give(Order.ARM, 3)
    for _ in range(20):
        machine.machine_slot(0)
    for first in range(0, total, batch):
        for sequence in range(first, first + batch):
            give(0x10, (sequence + first // batch) % 256, struct.pack("<HH", 4, 24000 + sequence % 2))
        give(0x11, (first + batch + first // batch) % 256)
        give(Order.START, first // batch % 2 + 4)
        machine.machine_slot(0)
        machine.machine_slot(0)
    for _ in range(3):
        machine.machine_slot(0)
    assert (status().state, status().reached) == (State.READY, total)


class _Remembers:
    """A line to a controller that answers RECALL, and nothing else."""

    def __init__(self, reached: int) -> None:
        self._record = (77).to_bytes(2, "little") + reached.to_bytes(4, "little") + bytes([State.UNDERRUN])

    def write(self, message: bytes) -> None: ...

    def read(self, size: int, timeout_s: float) -> bytes:
        return native.frame(0x83, 0, self._record)

    def close(self) -> None: ...


@given(first=st.integers(0, native.COUNTED - 1), keys=st.integers(0, 1 << 20), each=st.integers(1, 9))
def test_the_count_wraps(first: int, keys: int, each: int) -> None:
    line = _Remembers((first + keys) % native.COUNTED)
    driver = driver_on(line, _StandingClock())
    assert driver.recall(Tally(77, first, each)) == keys * each
    assert driver.recall(Tally(78, first, each)) is None


class _StandingClock:
    def now_s(self) -> float:
        return 0.0

    def sleep_until(self, deadline_s: float) -> None: ...


def test_a_line_with_nobody_at_its_end_is_said(built: Build, tmp_path: Path) -> None:
    controller = in_lock_step(built, tmp_path)
    controller.read = lambda n, timeout: (controller.sleep_until(controller.now_s() + timeout), b"")[1]  # type: ignore[method-assign]
    driver: NativeDriver = driver_on(controller, controller)
    with pytest.raises(HardwareError, match="does not answer: is it powered"):
        driver.recall(Tally(1, 0, 1))
    controller.emulator.end()
