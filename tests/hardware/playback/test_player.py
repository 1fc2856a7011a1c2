from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.clock import InstantClock
from hardware.motion.stopping import interpolate, slow_down
from hardware.motion.tip import link_nodes_mm
from hardware.playback.observer import Observer
from hardware.playback.player import play
from hardware.playback.program import Program, make_program
from hardware.playback.request import Request
from hardware.playback.result import End, PlaybackResult
from hardware.playback.sample_map import piece, sample_after
from hardware.simulation.simulated_arm import Recording, SimulatedArm
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.errors import HardwareError, OutputError
from planner.trajectory import TRAVELLING, Trajectory
from tests.hardware.observed import Observed

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
    """An arm whose line fails at a certain set point."""

    def __init__(self, arm: Arm, clock: InstantClock, after: int) -> None:
        super().__init__(arm, clock)
        self._after = after

    def send(self, positions: FloatArray, duration_s: float) -> None:
        if len(self.recording.times_s) == self._after:
            raise HardwareError("the line is dead")
        super().send(positions, duration_s)


class Queueing(SimulatedArm):
    """An arm whose controller has a queue: it is some set points behind, and time passes while it takes one."""

    ahead_s = 0.2
    behind = 20

    def __init__(self, arm: Arm, clock: InstantClock) -> None:
        super().__init__(arm, clock)
        self._passing = clock
        self._awaited = False

    def send(self, positions: FloatArray, duration_s: float) -> None:
        self._passing.sleep_until(self._passing.now_s() + duration_s)
        super().send(positions, duration_s)

    def executed(self) -> int:
        return super().executed() if self._awaited else max(super().executed() - self.behind, 0)

    def flush(self) -> None:
        super().flush()
        self._awaited = True


def _resting(n: int, rate_hz: float) -> Program:
    return Program(np.tile(REST, (n, 1)), np.full(n, TRAVELLING), np.zeros(n), rate_hz, 0, 0)


@pytest.fixture(scope="session")
def program(arm: Arm, sketch: Trajectory) -> Program:
    return make_program(arm, arm.from_file_units(sketch.positions), sketch.stroke, sketch.rate_hz)


@settings(deadline=None)
@given(oversleep_s=st.lists(st.floats(0, 0.05), min_size=1, max_size=40), rate_hz=st.floats(50, 1000))
def test_set_point_k_is_due_at_k_periods_whatever_went_before(oversleep_s: list[float], rate_hz: float) -> None:
    clock = SleepyClock(oversleep_s)
    simulated = SimulatedArm(ARM, clock)
    played = play(_resting(len(oversleep_s) + 60, rate_hz), ARM, simulated, clock)
    k = np.arange(played.total)
    woken_s = k / rate_hz + np.concatenate((oversleep_s, np.zeros(60)))
    times_s = simulated.recording.times_s[:-1] - 1000
    np.testing.assert_allclose(times_s, np.maximum.accumulate(woken_s), atol=1e-9)
    np.testing.assert_allclose(played.late_s, np.percentile(times_s - k / rate_hz, (50, 99, 100)), atol=1e-9)


def test_a_stall_puts_the_rest_off_instead_of_jumping() -> None:
    clock = SleepyClock([0.0, 0.0, 0.0, 0.5])
    simulated = SimulatedArm(ARM, clock)
    played = play(_resting(10, 100.0), ARM, simulated, clock)
    gaps = np.diff(simulated.recording.times_s[:-1])
    np.testing.assert_allclose(gaps, [0.01, 0.01, 0.51, *[0.01] * 6], atol=1e-9)
    assert played.stalls == 1
    assert "stalled" in played.lines()[-1]


def test_everything_is_sent_reported_and_closed(arm: Arm, program: Program) -> None:
    clock, observed = InstantClock(), Observed()
    simulated = SimulatedArm(arm, clock)
    played = play(program, arm, simulated, clock, observers=[observed])
    total = len(program.positions)
    np.testing.assert_array_equal(simulated.recording.set_points[:-1], program.positions)
    np.testing.assert_allclose(simulated.recording.positions[1:], program.positions, atol=1e-9)
    assert [now.reached for now in observed.progress] == list(range(1, total + 1))
    assert [now.stroke for now in observed.progress] == program.stroke.tolist()
    assert observed.progress[0].left_s == pytest.approx(program.duration_s)
    assert observed.progress[-1].left_s == 0
    assert observed.strokes_finished == [0, 1, 2]
    assert (played.end, played.sent, played.total, played.parked) == (End.PLAYED, total, total, True)
    assert played.duration_s == pytest.approx(program.duration_s)
    assert not simulated.connected


@pytest.mark.parametrize("make", [SimulatedArm, Queueing])
def test_a_stroke_is_finished_once_the_controller_says_so(
    arm: Arm, program: Program, make: Callable[[Arm, InstantClock], SimulatedArm]
) -> None:
    clock = InstantClock()
    driver, finished = make(arm, clock), list[tuple[int, int]]()

    class Executed(Observer):
        def finished(self, stroke: int) -> None:
            finished.append((stroke, driver.executed()))

    play(program, arm, driver, clock, observers=[Executed()])
    ends = [int(np.flatnonzero(program.stroke == stroke)[-1]) for stroke in range(3)]
    assert finished == [(stroke, end + 1) for stroke, end in enumerate(ends)]


def test_a_queue_sets_the_pace(arm: Arm, program: Program) -> None:
    clock = InstantClock()
    played = play(program, arm, Queueing(arm, clock), clock)
    assert played.late_s == (0, 0, 0)
    assert not any("late" in line for line in played.lines())
    assert played.duration_s == pytest.approx(program.duration_s, abs=0.05)


def _asked(arm: Arm, program: Program, wishes: Callable[[int], Request]) -> tuple[PlaybackResult, Recording, list[int]]:
    """Play with the request that holds after so many set points."""
    clock, observed = InstantClock(), Observed()
    simulated = SimulatedArm(arm, clock)
    played = play(program, arm, simulated, clock, request=lambda: wishes(simulated.executed()), observers=[observed])
    assert not simulated.connected
    return played, simulated.recording, observed.strokes_finished


def _in_order(arm: Arm, recording: Recording, rate_hz: float) -> FloatArray:
    """The tips (n, 3) of what was sent, which is in time and within limits, and drew no line but the arc's."""
    sent = recording.set_points
    assert slow_down(arm, np.concatenate((np.tile(sent[0], (3, 1)), sent)), 1 / rate_hz) <= 1.05
    assert np.diff(recording.times_s[:-1]).min(initial=1.0) > 0.5 / rate_hz
    tips = link_nodes_mm(arm, sent)[:, -1]
    low = tips[:, 2] < arm.pen.clearance_mm - 0.01
    np.testing.assert_allclose(np.hypot(*tips[low, :2].T), 100, atol=1e-3)
    assert tips[:, 2].min() > -5e-3
    # Between paper and clearance the tip goes straight up or down; on the paper it draws.
    rising = low[1:] & low[:-1] & (np.maximum(tips[1:, 2], tips[:-1, 2]) > 1e-3)
    assert np.hypot(*np.diff(tips[:, :2], axis=0)[rising].T).max(initial=0) < 2e-3
    return tips


@settings(max_examples=25, deadline=None)
@given(share=st.floats(0, 1))
def test_a_stop_brakes_along_the_drawing_lifts_and_parks(share: float, arm: Arm, program: Program) -> None:
    after = int(share * (len(program.positions) - 1))
    played, recording, finished = _asked(arm, program, lambda sent: Request.STOP if sent >= after else Request.GO)
    assert (played.end, played.parked) == (End.STOPPED, True)
    assert played.pen_height_mm == pytest.approx(arm.pen.lift_mm, abs=0.1)
    np.testing.assert_array_equal(recording.set_points[:after], program.positions[:after])
    np.testing.assert_allclose(recording.positions[-1], program.park, atol=1e-6)
    _in_order(arm, recording, program.rate_hz)
    drawn = [stroke for stroke in range(3) if np.flatnonzero(program.stroke == stroke)[-1] < played.sent]
    assert finished == drawn


@settings(max_examples=25, deadline=None)
@given(share=st.floats(0, 1), rests=st.integers(1, 30))
def test_after_a_pause_it_goes_on_from_the_very_sample(share: float, rests: int, arm: Arm, program: Program) -> None:
    after = int(share * (len(program.positions) - 1))
    paused_at: list[int] = []

    def wishes(sent: int) -> Request:
        if sent < after:
            return Request.GO
        paused_at.append(sent)
        return Request.PAUSE if len(set(paused_at)) < 120 + rests else Request.GO

    played, recording, finished = _asked(arm, program, wishes)
    assert (played.end, played.sent, played.parked) == (End.PLAYED, len(program.positions), True)
    assert finished == [0, 1, 2]
    tips = _in_order(arm, recording, program.rate_hz)
    sent, own = recording.set_points[:-1], program.positions
    resting = tips[1:-1][(np.diff(sent, axis=0) == 0).all(axis=1)]
    assert len(resting) >= rests
    assert resting[:, 2].min() >= arm.pen.clearance_mm - 0.02
    # Before the pause and after it every set point is the program's own.
    np.testing.assert_array_equal(sent[:after], own[:after])
    rest = len(own) - after - 50  # braking and setting off take half a second at the most
    np.testing.assert_array_equal(sent[len(sent) - max(rest, 0) :], own[len(own) - max(rest, 0) :])
    # Every sample of the arcs has had the pen over it.
    wanted = link_nodes_mm(arm, own[program.stroke >= 0])[:, -1, :2]
    drawn = tips[tips[:, 2] < 1e-3, :2]
    gaps = np.linalg.norm(wanted[:, None] - drawn[None], axis=2).min(axis=1)
    assert gaps.max() < 2.0


def test_a_stop_while_paused_parks_from_where_it_rests(arm: Arm, program: Program) -> None:
    after = int(np.flatnonzero(program.stroke == 1)[20])
    played, recording, finished = _asked(
        arm, program, lambda sent: Request.GO if sent < after else Request.PAUSE if sent < after + 150 else Request.STOP
    )
    assert (played.end, played.parked, finished) == (End.STOPPED, True, [0])
    _in_order(arm, recording, program.rate_hz)


@pytest.mark.parametrize("later", [0, 5, 25, 45])
def test_an_emergency_stop_sends_nothing_more_and_holds(arm: Arm, program: Program, later: int) -> None:
    """Whether it is playing, braking, paused or on its way to be parked."""
    after = int(np.flatnonzero(program.stroke == 1)[20])
    for first in (Request.PAUSE, Request.STOP):
        played, recording, finished = _asked(
            arm,
            program,
            lambda sent, first=first: (  # type: ignore[misc]
                Request.GO if sent < after else first if sent < after + later else Request.EMERGENCY_STOP
            ),
        )
        assert (played.end, played.parked, finished) == (End.EMERGENCY_STOPPED, False, [0])
        assert len(recording.times_s) == after + later
        assert "holds where it is" in played.lines()[0]


def test_a_stop_before_the_first_set_point_moves_nothing(arm: Arm, program: Program) -> None:
    played, recording, _ = _asked(arm, program, lambda sent: Request.STOP)
    assert (played.end, played.sent) == (End.STOPPED, 0)
    np.testing.assert_array_equal(recording.set_points, program.park[None])


def test_a_failing_line_is_an_error_and_what_was_drawn_is_known(arm: Arm, program: Program) -> None:
    clock, observed = InstantClock(), Observed()
    broken = Breaks(arm, clock, int(np.flatnonzero(program.stroke == 1)[5]))
    with pytest.raises(HardwareError, match="dead"):
        play(program, arm, broken, clock, observers=[observed])
    assert observed.strokes_finished == [0]
    assert not broken.connected


def test_whatever_else_fails_the_pen_goes_up_and_the_arm_parks_first(arm: Arm, program: Program) -> None:
    clock = InstantClock()
    simulated = SimulatedArm(arm, clock)

    class Full(Observer):
        def finished(self, stroke: int) -> None:
            raise OutputError("traj.csv.journal", "No space left on device")

    with pytest.raises(OutputError, match="No space"):
        play(program, arm, simulated, clock, observers=[Full()])
    assert not simulated.connected
    np.testing.assert_allclose(simulated.recording.positions[-1], program.park)
    assert len(simulated.recording.times_s) < len(program.positions)
    _in_order(arm, simulated.recording, program.rate_hz)


@settings(max_examples=25, deadline=None)
@given(pauses=st.lists(st.tuples(st.integers(0, 400), st.integers(1, 40)), max_size=3))
def test_where_every_set_point_is_in_the_trajectory_is_said_before_it_is_sent(
    arm: Arm, sketch: Trajectory, program: Program, pauses: list[tuple[int, int]]
) -> None:
    """Paused or not, the tip is above or at that sample; lifting and resting, above where it stopped."""
    clock = InstantClock()
    simulated = SimulatedArm(arm, clock)
    pieces = list[list[tuple[int, float]]]()
    paused = np.zeros(2000, dtype=bool)
    for begin, length in pauses:
        paused[begin : begin + length] = True
    asked = iter(paused)

    class Pieces(Observer):
        def planned(self, first: int, samples: FloatArray) -> None:
            assert first == simulated.executed() + 1
            pieces.append(piece(first, samples))

    play(
        program,
        arm,
        simulated,
        clock,
        request=lambda: Request.PAUSE if next(asked, False) else Request.GO,
        observers=[Pieces()],
    )
    points = simulated.recording.set_points[:-1]
    at = np.array([sample_after(pieces, count) for count in range(1, len(points) + 1)], dtype=float)
    tips, planned = (
        link_nodes_mm(arm, positions)[:, -1, :2]
        for positions in (points, interpolate(arm.from_file_units(sketch.positions), at))
    )
    drawing = slice(program.approach, len(points) - program.retreat)
    assert np.linalg.norm(tips - planned, axis=1)[drawing].max() < 0.1
    assert (np.diff(at) >= -1e-3).all()
