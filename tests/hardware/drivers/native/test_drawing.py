"""A whole drawing by the shipped player and driver on the firmware: what its pins have drawn is the drawing."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from hardware.compensation.servo_values import pulse_calibration
from hardware.drivers.native.driver import NativeDriver
from hardware.motion.slow_transfer import come_from
from hardware.motion.tip import link_nodes_mm
from hardware.playback.player import play
from hardware.playback.preflight import set_points
from hardware.playback.program import make_program
from hardware.playback.request import Request
from hardware.playback.result import End
from hardware.simulation.ink import drawn_lines
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.checking.drawing_error import DrawingErrors, drawing_error
from planner.pipeline import plan
from planner.settings import PlanSettings
from planner.trajectory import Trajectory
from tests.drawn_shapes import lines_svg
from tests.hardware.emulator.emulator import Emulator, Faults, LockStep
from tests.hardware.observed import Observed

ARM = load_arm("drawing_arm")
_EVERY_S = 0.005


@pytest.fixture(scope="module")
def drawing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("drawing") / "drawing.svg"
    target.write_text(
        lines_svg(
            '<path d="M5 5 15 25 25 5"/><path d="M30 15h0"/><circle cx="45" cy="15" r="8"/>', 'viewBox="0 0 60 30"'
        )
    )
    return target


@pytest.fixture(scope="module")
def trajectory(drawing: Path) -> Trajectory:
    return plan(drawing, PlanSettings(), lambda stage, done, total: None).trajectory


def _on_pins(emulator: Emulator) -> FloatArray:
    """(n, n_joints) positions that the pulses ask for, each servo going straight from one pulse to the next."""
    calibration = pulse_calibration(ARM)
    pulses = [emulator.pulses(channel) for channel in calibration.addresses]
    times_s = np.arange(max(one.starts_s[0] for one in pulses), min(one.starts_s[-1] for one in pulses), _EVERY_S)
    return calibration.to_joints(np.column_stack([np.interp(times_s, one.starts_s, one.widths_us) for one in pulses]))


def _drawing_error(emulator: Emulator, trajectory: Trajectory) -> DrawingErrors:
    """Beside the planned path of the pen on the paper."""
    tip_mm = link_nodes_mm(ARM, ARM.from_file_units(trajectory.positions))[:, -1, :2]
    wanted = [tip_mm[trajectory.stroke == stroke] for stroke in range(3)]
    return drawing_error(drawn_lines(ARM, _on_pins(emulator)), wanted)


def _driver(controller: LockStep) -> NativeDriver:
    calibration = pulse_calibration(ARM)
    return NativeDriver(
        lambda: controller,
        calibration.to_servos,
        calibration.to_joints,
        partial(come_from, ARM),
        calibration.addresses,
        calibration.ranges,
        controller,
    )


@pytest.mark.parametrize("rests", [0, 70])
def test_what_the_pins_draw_is_the_drawing_paused_or_not(
    lock_step: Callable[[Faults], LockStep], drawing: Path, trajectory: Trajectory, rests: int
) -> None:
    controller = lock_step(Faults(flip=0.001, drop=0.001))
    driver = _driver(controller)
    program = make_program(ARM, set_points(trajectory, ARM, drawing), trajectory.stroke, trajectory.rate_hz)
    requests = iter([*[Request.GO] * 160, *[Request.PAUSE] * rests])

    observed = Observed()
    played = play(program, ARM, driver, controller, request=lambda: next(requests, Request.GO), observers=[observed])
    assert played.end is End.PLAYED
    assert observed.strokes_finished == [0, 1, 2]
    controller.sleep_until(controller.now_s() + 0.1)
    found = _drawing_error(controller.emulator, trajectory)
    assert found.most_mm < 0.1
    assert found.largest_mm < 0.2  # half-microseconds of five joints at once, and straight lines over 20 ms


@pytest.mark.parametrize("stroke", [0, 1])
@pytest.mark.parametrize("faults", [Faults(), Faults(flip=0.001, drop=0.001)])
def test_a_stop_brakes_at_once_and_not_where_the_queue_ends(
    lock_step: Callable[[Faults], LockStep], drawing: Path, trajectory: Trajectory, stroke: int, faults: Faults
) -> None:
    controller = lock_step(faults)
    driver = _driver(controller)
    program = make_program(ARM, set_points(trajectory, ARM, drawing), trajectory.stroke, trajectory.rate_hz)
    begins, ends = np.flatnonzero(program.stroke == stroke)[[0, -1]]
    asked_s, asked_at = list[float](), list[int]()
    left_at = list[float]()

    def wishes() -> Request:
        if driver.executed() < (begins + ends) // 2:
            return Request.GO
        asked_s.append(controller.now_s())
        asked_at.append(driver.executed())
        return Request.STOP

    class Left(Observed):
        def planned(self, first: int, samples: FloatArray) -> None:
            left_at.append(float(samples[0]))

    observed = Left()
    played = play(program, ARM, driver, controller, request=wishes, observers=[observed])
    controller.sleep_until(controller.now_s() + 0.1)
    assert (played.end, played.parked) == (End.STOPPED, True)
    assert observed.strokes_finished == list(range(stroke))
    tips_mm = link_nodes_mm(ARM, _on_pins(controller.emulator))[:, -1]
    assert np.linalg.norm(tips_mm[-1] - link_nodes_mm(ARM, program.park[None])[0, -1]) < 0.2
    # The time scale ramps down in 0.2 s: half of that is drawn, at most, beside what pulses take to be told of.
    last_ink = drawn_lines(ARM, _on_pins(controller.emulator))[-1][-1]
    sample = round(left_at[-1])
    drawn_s = (sample - program.sample[asked_at[0]]) / program.rate_hz
    assert 0.05 < drawn_s < 0.2
    left_mm = link_nodes_mm(ARM, ARM.from_file_units(trajectory.positions[sample : sample + 2]))[:, -1, :2]
    assert np.linalg.norm(last_ink - left_mm, axis=1).min() < 0.2 + np.linalg.norm(np.diff(left_mm, axis=0))
