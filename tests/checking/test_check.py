"""A sound trajectory passes, and each way of breaking one is found by the check that is there for it."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.checking.check import check_trajectory
from planner.checking.check_result import CheckResult, Finding, Place
from planner.trajectory import TRAVELLING, Trajectory
from tests.checking.rig import (
    AFFINE,
    CORNERED,
    DOT,
    LIFT_MM,
    RATE_HZ,
    SHORT,
    Hand,
    drawing_of,
    gantry,
    hand,
    with_limit,
)

DRAWING = drawing_of(CORNERED, SHORT, DOT)


def faults(trajectory: Trajectory, arm: Arm | None = None) -> dict[str, Finding]:
    check_result = check_trajectory(trajectory, arm or gantry(), DRAWING)
    assert check_result.passed == (not check_result.faults)
    return {finding.check: finding for finding in check_result.faults}


def test_a_share_of_a_limit_counts_from_the_middle_of_what_is_allowed() -> None:
    """Between 5 and 95, 20 is two thirds of the way out, and not four times the limit."""
    assert Finding("position", True, 20.0, 5.0, middle=50.0).share == pytest.approx(2 / 3)
    assert Finding("velocity", True, 20.0, 40.0).share == 0.5


def test_a_sound_trajectory_passes() -> None:
    check_result = check_trajectory(hand().trajectory(), gantry(), DRAWING)
    assert check_result.passed, check_result.text()
    assert {finding.check for finding in check_result.findings} >= {
        "columns",
        "starts at rest",
        "ends at rest",
        "position",
        "velocity",
        "acceleration",
        "jerk",
        "strokes in order",
        "pen down within strokes",
        "tip on the paper while the pen is down",
        "pen upright on the paper",
        "tip below the paper while the pen is up",
        "links below the paper",
        "straight up and down below clearance",
        "nothing extra",
        "nothing missing",
        "nothing twice",
    }


def test_figures_are_those_of_the_motion() -> None:
    trajectory = hand().trajectory()
    check_result = check_trajectory(trajectory, gantry(), DRAWING)
    velocity = {
        finding.place.joint: finding
        for finding in check_result.findings
        if finding.check == "velocity" and finding.place
    }
    expected = np.abs(np.diff(trajectory.positions[:, 2])) * RATE_HZ
    assert velocity["u"].worst == pytest.approx(expected.max())
    assert velocity["u"].place is not None
    assert velocity["u"].place.sample == np.argmax(expected) + 1
    assert velocity["u"].place.line == 9 + velocity["u"].place.sample
    (highest,) = [finding for finding in check_result.findings if finding.check == "highest tip"]
    assert highest.worst == pytest.approx(LIFT_MM)
    (extra,) = [finding for finding in check_result.findings if finding.check == "nothing extra"]
    assert extra.worst is not None
    assert extra.worst < 1e-4  # the cubic at the corner


def changed(**values: object) -> Trajectory:
    return replace(hand().trajectory(), **values)  # type: ignore[arg-type]


def bumped(column: int, first: int, height: float, n: int = 40) -> Trajectory:
    """A smooth bump in one column over n samples."""
    trajectory = hand().trajectory()
    positions = trajectory.positions.copy()
    t = np.arange(n) / (n - 1)
    positions[first : first + n, column] += height * (64 * (t * (1 - t)) ** 3) ** 2
    return replace(trajectory, positions=positions)


def samples_of(stroke: int) -> np.ndarray:
    return np.flatnonzero(hand().trajectory().stroke == stroke)


def stroke_again() -> Trajectory:
    return hand().draw(SHORT, 3).trajectory()


def low_travel() -> Trajectory:
    """From one stroke to the next at half the clearance."""
    moving = Hand(60, 0).draw(CORNERED, 0)
    moving.move(*CORNERED[-1], 0.5).move(*SHORT[0], 0.5).move(*SHORT[0], LIFT_MM)
    return moving.draw(SHORT, 1).draw(DOT, 2).trajectory()


def with_stroke(samples: np.ndarray | slice, stroke: int) -> Trajectory:
    strokes = hand().trajectory().stroke.copy()
    strokes[samples] = stroke
    return changed(stroke=strokes)


def pen_at(sample: int) -> Trajectory:
    pen, stroke = hand().trajectory().pen.copy(), hand().trajectory().stroke.copy()
    pen[sample] = True
    stroke[sample] = 0 if sample == 0 else 3
    return changed(pen=pen, stroke=stroke)


def part(selection: slice) -> Trajectory:
    whole = hand().trajectory()
    return replace(
        whole, positions=whole.positions[selection], pen=whole.pen[selection], stroke=whole.stroke[selection]
    )


FIRST = int(samples_of(0)[0])
BROKEN: dict[str, tuple[Callable[[], Trajectory], set[str]]] = {
    "starts while moving": (lambda: part(slice(8, None)), {"starts at rest"}),
    "ends while moving": (lambda: part(slice(None, -5)), {"ends at rest"}),
    "lifted in a stroke": (lambda: bumped(0, FIRST + 10, 0.2), {"tip on the paper while the pen is down"}),
    "pressed in a stroke": (lambda: bumped(0, FIRST + 10, -0.2), {"tip on the paper while the pen is down"}),
    "off the line": (lambda: bumped(1, FIRST + 10, 0.2), {"nothing extra", "nothing missing"}),
    "sideways while lowered": (lambda: bumped(1, FIRST - 25, 0.8, 24), {"straight up and down below clearance"}),
    "below the paper while lifted": (
        lambda: (
            Hand(60, 0)
            .draw(CORNERED, 0)
            .move(*SHORT[0], LIFT_MM)
            .move(*SHORT[0], -0.2)
            .move(*SHORT[0], 0.0)
            .draw(SHORT, 1)
            .draw(DOT, 2)
            .trajectory()
        ),
        {"tip below the paper while the pen is up"},
    ),
    "low travel": (low_travel, {"straight up and down below clearance"}),
    "a stroke left out": (lambda: Hand(60, 0).draw(CORNERED, 0).draw(DOT, 1).trajectory(), {"nothing missing"}),
    "a tap left out": (lambda: Hand(60, 0).draw(CORNERED, 0).draw(SHORT, 1).trajectory(), {"nothing missing"}),
    "half a stroke left out": (
        lambda: Hand(60, 0).draw(CORNERED[:2], 0).draw(SHORT, 1).draw(DOT, 2).trajectory(),
        {"nothing missing"},
    ),
    "a line too much": (lambda: hand().draw(((90, 20), (90, 30)), 3).trajectory(), {"nothing extra"}),
    "a tap too much": (lambda: hand().draw(((90, 20),), 3).trajectory(), {"nothing extra"}),
    "a stroke twice": (stroke_again, {"nothing twice"}),
    "nothing drawn": (lambda: Hand(60, 0).move(80, 0, 5).trajectory(), {"nothing missing"}),
    "an index twice": (lambda: with_stroke(samples_of(2), 1), {"strokes in order"}),
    "an index left out": (lambda: with_stroke(samples_of(2), 3), {"strokes in order"}),
    "not from 0": (
        lambda: changed(stroke=np.where(hand().trajectory().pen, hand().trajectory().stroke + 1, TRAVELLING)),
        {"strokes in order"},
    ),
    "pen up within a stroke": (
        lambda: changed(pen=hand().trajectory().pen & (np.arange(hand().trajectory().n_samples) != FIRST + 20)),
        {"pen down within strokes", "pen as the tip", "straight up and down below clearance", "nothing missing"},
    ),
    "another map": (lambda: changed(svg_to_arm_mm=(*AFFINE[:4], 100.2, 50.0)), {"nothing extra", "nothing missing"}),
    "mirrored map": (
        lambda: changed(svg_to_arm_mm=(0, 0.5, -0.5, 0, 100, 50)),
        {"svg_to_arm_mm", "nothing extra", "nothing missing"},
    ),
    "flat map": (lambda: changed(svg_to_arm_mm=(1, 1, 1, 1, 0, 0)), {"svg_to_arm_mm"}),
    "huge map": (lambda: changed(svg_to_arm_mm=(0, 1e6, 1e6, 0, 0, 0)), {"svg_to_arm_mm"}),
    "zero map": (lambda: changed(svg_to_arm_mm=(0, 0, 0, 0, 0, 0)), {"svg_to_arm_mm"}),
    "other joints": (lambda: changed(columns=("h_mm", "v_mm", "w_mm")), {"columns"}),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_what_is_broken_is_found(kind: str) -> None:
    broken, checks = BROKEN[kind]
    assert set(faults(broken())) == checks


def test_pen_down_at_an_end_is_found() -> None:
    assert "pen up at the first sample" in faults(pen_at(0))
    assert "pen up at the last sample" in faults(pen_at(-1))


def test_skipping_the_lift_draws_what_is_not_there() -> None:
    moving = Hand(60, 0).draw(CORNERED, 0)
    moving.tips.pop(), moving.pens.pop(), moving.strokes.pop()
    moving.move(*SHORT[0], 0.0, 1).move(*SHORT[1], 0.0, 1).move(*SHORT[1], LIFT_MM)
    assert "nothing extra" in faults(moving.draw(DOT, 2).trajectory())


@pytest.mark.parametrize(
    ("check", "limit"),
    [
        ("velocity", "max_velocity"),
        ("acceleration", "max_acceleration"),
        ("jerk", "max_jerk"),
        ("position", "maximum"),
        ("position", "minimum"),
    ],
)
@pytest.mark.parametrize("name", ["h", "v", "u"])
def test_a_limit_a_little_tighter_than_the_motion_is_broken(check: str, limit: str, name: str) -> None:
    trajectory = hand().trajectory()
    column = trajectory.positions[:, "hvu".index(name)]
    order = {"velocity": 1, "acceleration": 2, "jerk": 3}.get(check)
    reached = (
        column.min()
        if limit == "minimum"
        else column.max()
        if order is None
        else (np.abs(np.diff(column, n=order)).max() * RATE_HZ**order)
    )
    slack = 1e-3 * abs(reached) + 4e-3  # above what is allowed for rounding
    sign = -1 if limit == "minimum" else 1
    assert not faults(trajectory, with_limit(gantry(), name, **{limit: reached + sign * slack}))
    slack = max(slack, 4e-6 * RATE_HZ**3) if check == "jerk" else slack
    found = faults(trajectory, with_limit(gantry(), name, **{limit: reached - sign * slack}))
    assert check in found
    # A tighter jerk also tightens what rest is, and what is beyond at a sample is so beside it: no more.
    assert set(found) <= {
        check,
        *{"jerk": ["starts at rest", "ends at rest"], "position": ["position between samples"]}.get(check, []),
    }
    place = found[check].place
    assert place is not None
    assert place.joint == name


def test_a_turn_between_samples_is_seen() -> None:
    t = (np.arange(30) - 14.5) / RATE_HZ
    turn = 60 - 0.5 * 1250 * t**2  # a parabola that is highest midway between two samples
    positions = np.column_stack((np.full(30, 25.0), np.zeros(30), turn))
    trajectory = Trajectory(
        "rig",
        "",
        "",
        RATE_HZ,
        gantry().column_names,
        positions,
        np.zeros(30, dtype=bool),
        np.full(30, TRAVELLING),
        AFFINE,
    )
    top = float(turn.max())
    check_result = check_trajectory(trajectory, with_limit(gantry(), "u", maximum=top))
    (found,) = [finding for finding in check_result.faults if finding.check == "position between samples"]
    assert found.worst == pytest.approx(top + 1250 / RATE_HZ**2 / 8)
    assert found.limit == pytest.approx(top)
    assert found.place is not None
    assert found.place.sample == 14


def test_places_say_where_to_look() -> None:
    found = faults(bumped(1, FIRST + 10, 0.2))
    extra, missing = found["nothing extra"], found["nothing missing"]
    assert extra.place is not None
    assert missing.place is not None
    assert extra.worst == pytest.approx(0.2, abs=0.01)
    assert extra.place.stroke == 0
    assert extra.place.sample == pytest.approx(FIRST + 29, abs=2)
    assert extra.place.line == 9 + extra.place.sample
    assert extra.place.tip_mm is not None
    x, y, _ = extra.place.tip_mm
    assert extra.place.svg_user == pytest.approx(((50 - y) * 2, (100 - x) * 2), abs=1e-6)
    assert missing.place.tip_mm == pytest.approx((x, y + 0.2), abs=0.1)


def test_the_length_that_is_missing_is_told() -> None:
    found = faults(Hand(60, 0).draw(CORNERED[:2], 0).draw(SHORT, 1).trajectory())["nothing missing"]
    assert "19.95 mm of line are missing and 1 tap" in found.remark
    assert found.worst == pytest.approx(np.hypot(10, 20))  # the dot to the end of the second line


def test_without_a_drawing_the_rest_is_checked() -> None:
    check_result = check_trajectory(Hand(60, 0).draw(CORNERED[:2], 0).trajectory(), gantry())
    assert check_result.passed
    assert not any(finding.check.startswith("nothing") for finding in check_result.findings)


def test_a_single_sample_is_a_trajectory() -> None:
    assert check_trajectory(part(slice(0, 1)), gantry()).passed
    for n in (2, 3, 4):
        assert "position" in {finding.check for finding in check_trajectory(part(slice(0, n)), gantry()).findings}


def test_a_wider_tolerance_lets_more_pass() -> None:
    assert check_trajectory(bumped(1, FIRST + 10, 0.2), gantry(), DRAWING, tolerance_mm=0.25).passed


def test_text_and_json_say_the_same() -> None:
    check_result = check_trajectory(bumped(0, FIRST + 10, 0.2), gantry(), DRAWING)
    lines = check_result.text().splitlines()
    assert len(lines) == len(check_result.findings) + 1
    assert lines[0].startswith("FAILED: 1 of ") and "laws broken" in lines[0]
    (line,) = [line for line in lines if line.startswith("FAULT")]
    assert "tip on the paper while the pen is down: 0.19999 of 0.05 mm" in line
    assert "stroke 0" in line
    values = json.loads(json.dumps(check_result.as_dict(), allow_nan=False))
    assert values["passed"] is False
    assert [one["check"] for one in values["findings"] if not one["passed"]] == [
        "tip on the paper while the pen is down"
    ]
    assert CheckResult(()).text() == "passed: 0 laws"


def test_lines_read_well() -> None:
    place = Place(1.25, 125, 134, "q2", 3, (10.0, 20.0, 0.0), (4.0, 5.0))
    assert str(Finding("velocity", False, 401.0, 400.0, "deg/s", place)) == (
        "FAULT velocity of q2: 401 of 400 deg/s (stroke 3, 1.250 s, line 134, tip at (10.00, 20.00, 0.00) mm, "
        "in the drawing (4.00, 5.00))"
    )
    assert str(Finding("pen up at the first sample", True)) == "ok    pen up at the first sample"
    assert str(Finding("highest tip", True, 5.0, unit="mm", is_note=True)) == "note  highest tip: 5 mm"
