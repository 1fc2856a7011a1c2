from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.clock import InstantClock
from hardware.player import Played, play
from hardware.simulated_arm import Recording, SimulatedArm
from hardware.tip import tip_at
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.errors import HardwareError
from planner.trajectory import Trajectory

ARM = load_arm("drawing_arm")
REST = np.radians([0.0, 60.0, -60.0, -60.0, -30.0])


class SleepyClock:
    """Wakes up late by the next of `oversleep_s` at each sleep; time stands still otherwise."""

    def __init__(self, oversleep_s: list[float]) -> None:
        self._now_s = 1000.0
        self._oversleep_s = iter(oversleep_s)

    def now_s(self) -> float:
        return self._now_s

    def sleep_until(self, deadline_s: float) -> None:
        self._now_s = max(self._now_s, deadline_s + next(self._oversleep_s, 0.0))


class Breaks(SimulatedArm):
    """An arm whose line fails at the third set point."""

    def send(self, positions: FloatArray) -> None:
        if len(self.recording.times_s) == 2:
            raise HardwareError("the line is dead")
        super().send(positions)


@given(oversleep_s=st.lists(st.floats(0, 0.05), min_size=1, max_size=40), rate_hz=st.floats(20, 1000))
def test_sample_k_is_due_at_k_periods_whatever_went_before(oversleep_s: list[float], rate_hz: float) -> None:
    clock = SleepyClock(oversleep_s)
    simulated = SimulatedArm(ARM, clock)
    played = play(np.tile(REST, (len(oversleep_s) + 60, 1)), rate_hz, ARM, simulated, clock)
    k = np.arange(played.total)
    woken_s = k / rate_hz + np.concatenate((oversleep_s, np.zeros(60)))
    times_s = simulated.recording.times_s - 1000
    np.testing.assert_allclose(times_s, np.maximum.accumulate(woken_s), atol=1e-9)
    late_s = times_s - k / rate_hz
    assert played.worst_late_s == pytest.approx(late_s.max(), abs=1e-9)
    assert played.mean_late_s == pytest.approx(late_s.mean(), abs=1e-9)
    assert np.count_nonzero(late_s > 1 / rate_hz + 1e-9) <= played.late <= np.count_nonzero(
        late_s > 1 / rate_hz - 1e-9)


def test_a_stall_puts_the_rest_off_instead_of_leaping() -> None:
    clock = SleepyClock([0.0, 0.0, 0.0, 0.5])
    simulated = SimulatedArm(ARM, clock)
    played = play(np.tile(REST, (10, 1)), 100.0, ARM, simulated, clock)
    gaps = np.diff(simulated.recording.times_s)
    np.testing.assert_allclose(gaps, [0.01, 0.01, 0.51, *[0.01] * 6], atol=1e-9)
    assert played.stalls == 1
    assert "stalled" in played.lines()[-1]


def test_everything_is_sent_reported_and_closed(arm: Arm, arc: Callable[..., Trajectory]) -> None:
    path = arm.from_file_units(arc().positions)
    clock, reports = InstantClock(), list[tuple[int, int]]()
    simulated = SimulatedArm(arm, clock)
    played = play(path, 100.0, arm, simulated, clock, report=lambda sent, total: reports.append((sent, total)))
    np.testing.assert_array_equal(simulated.recording.set_points, path)
    assert reports == [(k, len(path)) for k in range(1, len(path) + 1)]
    assert (played.sent, played.total, played.stopped) == (61, 61, False)
    assert played.duration_s == pytest.approx(0.6)
    assert not simulated.connected


def _stopped(arm: Arm, path: FloatArray, rate_hz: float, after: int) -> tuple[Played, Recording]:
    clock = InstantClock()
    simulated = SimulatedArm(arm, clock)
    played = play(path, rate_hz, arm, simulated, clock,
                  stop_requested=lambda: len(simulated.recording.times_s) >= after)
    assert not simulated.connected
    return played, simulated.recording


@pytest.mark.parametrize("rate_hz", [10.0, 100.0])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_stop_stays_on_the_drawing_then_lifts_the_pen_straight_up(
        arm: Arm, arc: Callable[..., Trajectory], rate_hz: float, share: float) -> None:
    path = arm.from_file_units(arc(2.0, rate_hz).positions)
    after = max(int(share * len(path)), 2)
    played, recording = _stopped(arm, path, rate_hz, after)
    assert played.stopped
    assert played.sent == after
    assert played.pen_height_mm == pytest.approx(arm.pen.lift_mm, abs=1e-3)
    tips = np.array([tip_at(arm, posture).position_mm for posture in recording.set_points])
    drawing = tips[:, 2] < 1e-6
    np.testing.assert_allclose(np.hypot(*tips[drawing, :2].T), 100, atol=1e-6)
    np.testing.assert_allclose(tips[~drawing, :2], np.tile(tips[drawing][-1, :2], (np.count_nonzero(~drawing), 1)),
                               atol=1e-3)
    assert (np.diff(tips[:, 2]) >= -1e-6).all()
    # In time, and as fast as joints may turn: the simulated arm is never more than one set point behind.
    assert np.diff(recording.times_s).min() > 0
    np.testing.assert_allclose(recording.positions[1:], recording.set_points[:-1], atol=1e-6)


def test_a_stop_before_the_first_sample_moves_nothing(arm: Arm, arc: Callable[..., Trajectory]) -> None:
    played, recording = _stopped(arm, arm.from_file_units(arc().positions), 100.0, 0)
    assert played.stopped
    assert played.sent == len(recording.times_s) == 0


def test_a_failing_line_is_an_error_and_is_closed(arm: Arm, arc: Callable[..., Trajectory]) -> None:
    clock = InstantClock()
    broken = Breaks(arm, clock)
    with pytest.raises(HardwareError, match="dead"):
        play(arm.from_file_units(arc().positions), 100.0, arm, broken, clock)
    assert not broken.connected
