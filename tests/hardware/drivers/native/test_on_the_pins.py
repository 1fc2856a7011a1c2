"""The shipped driver, the firmware in the emulator, and the pulses on its pins."""

from __future__ import annotations

import subprocess
from collections.abc import Callable

import numpy as np
import pytest

from hardware.codecs import native
from hardware.codecs.native import Order, Result, State
from hardware.drivers.native.driver import NativeDriver
from planner.arrays import FloatArray
from planner.errors import HardwareError
from tests.hardware.drivers.native.runs import (
    JOINTS,
    PERIOD_S,
    Console,
    against_plan,
    driver_on,
    line_of,
    progress,
    waves,
)
from tests.hardware.emulator.emulator import Faults, LockStep

_EXACT_US = 0.5
_NOISE = 1.0 / 400.0
"""What an error of a microsecond makes of the way along a line of 400 us."""


def _play(driver: NativeDriver, plan: FloatArray) -> None:
    for positions in plan:
        driver.send(positions, PERIOD_S)


def test_pulses_are_the_planned_angles(controller: LockStep) -> None:
    plan, driver = waves(20.0), driver_on(controller, controller)
    driver.connect(plan[0])
    since_s = controller.now_s()
    _play(driver, plan[1:])
    driver.flush()
    assert driver.executed() == len(plan) - 1
    found = against_plan(controller.emulator, plan, since_s)
    assert found.pulses > 4900 and found.rms_us <= 0.25 and found.worst_us <= _EXACT_US
    assert "under-runs: 0" in driver.statistics()


@pytest.mark.parametrize("rate", [0.001, 0.005, 0.02])
@pytest.mark.parametrize("kind", ["flip", "drop", "duplicate"])
def test_a_bad_line_changes_nothing_on_the_pins(
    lock_step: Callable[[Faults], LockStep], kind: str, rate: float
) -> None:
    controller = lock_step(Faults(**{kind: rate, "seed": 7}))
    plan, driver = waves(6.0), driver_on(controller, controller)
    driver.connect(plan[0])
    since_s = controller.now_s()
    _play(driver, plan[1:])
    driver.flush()
    found = against_plan(controller.emulator, plan, since_s)
    assert found.worst_us <= _EXACT_US
    assert driver.executed() == len(plan) - 1
    assert "under-runs: 0" in driver.statistics() and " 0 of them again" not in driver.statistics()[0]


def test_set_points_that_come_thick_and_fast_are_merged(controller: LockStep) -> None:
    plan = line_of(2.0)
    driver = driver_on(controller, controller)
    driver.connect(plan[0])
    since_s = controller.now_s()
    for positions in np.linspace(plan[0], plan[-1], 2001)[1:]:
        driver.send(positions, 0.001)
    driver.flush()
    assert driver.executed() == 2000
    assert against_plan(controller.emulator, plan, since_s).worst_us <= _EXACT_US
    assert 150 < int(driver.statistics()[0].split()[1]) <= 201


def test_a_host_paused_for_400_ms_is_not_noticed(controller: LockStep) -> None:
    plan, driver = waves(5.0), driver_on(controller, controller)
    driver.connect(plan[0])
    since_s = controller.now_s()
    _play(driver, plan[1:250])
    controller.sleep_until(controller.now_s() + 0.4)
    _play(driver, plan[250:])
    driver.flush()
    assert against_plan(controller.emulator, plan, since_s).worst_us <= _EXACT_US
    assert "under-runs: 0" in driver.statistics()


def test_a_host_paused_for_2_s_finds_the_arm_standing_on_the_path_and_goes_on(controller: LockStep) -> None:
    plan, driver = line_of(4.0), driver_on(controller, controller)
    driver.connect(plan[0])
    since_s = controller.now_s()
    _play(driver, plan[1:200])
    paused_s = controller.now_s()
    controller.sleep_until(paused_s + 2.0)
    _play(driver, plan[200:])
    driver.flush()
    assert "under-runs: 1" in driver.statistics() and driver.executed() == len(plan) - 1
    times_s, along = progress(controller.emulator, plan, since_s)
    assert (np.diff(along) > -2 * _NOISE).all() and along[-1] == pytest.approx(1.0, abs=_NOISE)
    fastest = np.diff(along) - np.diff(times_s) / 4.0
    assert fastest.max() < 2 * _NOISE  # neither a jump nor hurrying to catch up
    standing = (times_s > paused_s + 0.9) & (times_s < paused_s + 2.0)
    assert np.ptp(along[standing]) < 2 * _NOISE and along[standing][0] < 0.9


def test_a_host_that_died_leaves_a_standing_arm_for_the_next_one(controller: LockStep) -> None:
    plan, driver = line_of(4.0), driver_on(controller, controller)
    driver.connect(plan[0])
    since_s = controller.now_s()
    _play(driver, plan[1:200])
    died_s = controller.now_s()
    controller.sleep_until(died_s + 8.0)
    times_s, along = progress(controller.emulator, plan, since_s)
    assert np.ptp(along[times_s > died_s + 0.9]) < 2 * _NOISE and along[-1] < 0.9
    with pytest.raises(HardwareError, match="heard nothing"):
        _play(driver, plan[200:300])
    driver.close()

    again = driver_on(controller, controller)
    again.connect(plan[0])
    times_s, along = progress(controller.emulator, plan, died_s + 8.0)
    assert np.abs(np.diff(along)).max() < 3 * _NOISE and along[-1] == pytest.approx(0.0, abs=_NOISE)
    _play(again, plan[1:])
    again.flush()
    assert again.executed() == len(plan) - 1


def test_servos_are_attached_one_after_another(controller: LockStep) -> None:
    driver_on(controller, controller).connect(np.zeros(JOINTS))
    first_s = [controller.emulator.pulses(channel).starts_s[0] for channel in range(JOINTS)]
    assert (np.diff(first_s) > 0.14).all() and (np.diff(first_s) < 0.18).all()


@pytest.mark.parametrize("after_s", [1.0, 1.013, 1.0071])
def test_an_emergency_stop_changes_no_pulse_after_20_ms(controller: LockStep, after_s: float) -> None:
    plan, driver = line_of(4.0), driver_on(controller, controller)
    driver.connect(plan[0])
    _play(driver, plan[1:150])
    controller.sleep_until(controller.now_s() + after_s - 1.0)
    stopped_s = controller.now_s()
    driver.emergency_stop()
    controller.sleep_until(stopped_s + 1.0)
    for channel in range(JOINTS):
        pulses = controller.emulator.pulses(channel)
        changed_s = pulses.starts_s[1:][np.abs(np.diff(pulses.widths_us)) > 0.5] - stopped_s
        assert -0.05 < changed_s[-1] < 0.02
    driver.emergency_stop()
    driver.close()


def test_a_hold_brakes_along_the_path_and_a_start_goes_on(controller: LockStep) -> None:
    console = Console(controller)
    assert console.arm().state is State.READY
    since_s = controller.now_s()
    for sequence in range(40):
        controller.write(native.sequenced(native.Key(500, (24000 + 100 * (sequence + 1),) * JOINTS), sequence))
    controller.write(native.sequenced(native.End(), 40))
    assert console.give(Order.START).state is State.RUN
    controller.sleep_until(controller.now_s() + 0.8)
    assert console.give(Order.HOLD).state is State.HOLD
    held_s = controller.now_s()
    controller.sleep_until(held_s + 1.0)
    assert console.give(Order.START).state is State.RUN
    controller.sleep_until(controller.now_s() + 2.0)
    status = console.give(Order.PING)
    assert (status.state, status.reached) == (State.READY, 40)
    for channel in range(JOINTS):
        pulses = controller.emulator.pulses(channel)
        steps = np.diff(pulses.widths_us)[pulses.starts_s[1:] > since_s]
        assert steps.min() > -0.6 and steps.max() < 100 / 16 * 20 / 50 + 0.8
        ramps = (pulses.starts_s > held_s - 0.1) & (pulses.starts_s < held_s + 1.8)
        assert np.abs(np.diff(pulses.widths_us[ramps], 2)).max() < 1.2  # where full speed is 2.5 us a pulse
        held = pulses.widths_us[(pulses.starts_s > held_s + 0.25) & (pulses.starts_s < held_s + 1.0)]
        assert np.ptp(held) <= 0.5 and held[0] < 1700


@pytest.mark.parametrize("what", ["reset", "stop_timer"])
def test_a_controller_that_starts_anew_is_noticed(controller: LockStep, what: str) -> None:
    """The watchdog is what resets it where its timer stopped."""
    plan, driver = line_of(4.0), driver_on(controller, controller)
    driver.connect(plan[0])
    _play(driver, plan[1:150])
    getattr(controller.emulator, what)()
    with pytest.raises(HardwareError, match="was reset"):
        _play(driver, plan[150:])
    driver.close()
    again = driver_on(controller, controller)
    again.connect(plan[0])
    _play(again, plan[1:])
    again.flush()
    assert again.executed() == len(plan) - 1


def test_ranges_hold_on_the_controller(controller: LockStep) -> None:
    console = Console(controller)
    console.arm()
    controller.write(native.sequenced(native.Key(100, (2301 * 16,) * JOINTS), 0))
    status = console.give(Order.PING)
    assert (status.state, status.fault) == (State.FAULT, native.Fault.BAD_KEY)
    assert console.give(Order.CLEAR).state is State.READY
    for channel in (
        native.Channel(399 * 16, 24000, 24000),
        native.Channel(24000, 2601 * 16, 24000),
        native.Channel(24000, 25000, 23999),
    ):
        assert console.give(Order.CONFIG, native.config(console.next(), [channel])).result is Result.REFUSED_RANGE
    eight = [native.Channel(400 * 16, 2401 * 16, 24000)] * 8  # too long for eight slots in 20 ms
    assert console.give(Order.CONFIG, native.config(console.next(), eight)).result is Result.REFUSED_RANGE
    other = [native.Channel(400 * 16, 2400 * 16, 24000)] * 8
    assert console.give(Order.CONFIG, native.config(console.next(), other)).result is Result.REFUSED_STATE
    assert console.give(Order.OFF).state is State.OFF
    assert console.give(Order.CONFIG, native.config(console.next(), other)).result is Result.DONE


@pytest.mark.parametrize("joints", [1, 2, 3, 6, 7, 8])
def test_any_number_of_joints(controller: LockStep, joints: int) -> None:
    driver = NativeDriver(
        lambda: controller,
        lambda positions: 1000.0 + positions,
        lambda pulses_us: pulses_us - 1000.0,
        lambda held, pose, _: pose[None],
        range(joints),
        np.tile((600.0, 2400.0), (joints, 1)),
        controller,
    )
    driver.connect(np.zeros(joints))
    since_s = controller.now_s()
    for along in np.linspace(0.0, 1.0, 101)[1:]:
        driver.send(np.linspace(100.0, 900.0, joints) * along, 0.02)
    driver.flush()
    controller.sleep_until(controller.now_s() + 0.05)
    assert driver.executed() == 100
    for channel in range(8):
        pulses = controller.emulator.pulses(channel)
        if channel >= joints:
            assert not len(pulses.starts_s)
            continue
        assert pulses.widths_us[-1] == pytest.approx(1000.0 + np.linspace(100.0, 900.0, joints)[channel], abs=_EXACT_US)
        assert np.diff(pulses.starts_s[pulses.starts_s > since_s]) == pytest.approx(0.02, abs=5e-6)


def test_memory(controller: LockStep) -> None:
    """Flash under 16 kB; static data and the deepest stack of a run under 1.5 kB."""
    plan, driver = waves(1.0), driver_on(controller, controller)
    driver.connect(plan[0])
    _play(driver, plan[1:])
    driver.flush()
    firmware = str(controller.emulator.process.args[1])  # type: ignore[index]
    sizes = subprocess.run(["avr-size", firmware], check=True, capture_output=True, text=True).stdout
    text, data, bss = (int(word) for word in sizes.splitlines()[1].split()[:3])
    controller.emulator.end()
    stack = 0x8FF - int(controller.emulator.stack_report.split("lowest stack address ")[1].split()[0], 16)
    assert text + data < 16_000
    assert stack > 0
    assert data + bss + stack < 1_500
