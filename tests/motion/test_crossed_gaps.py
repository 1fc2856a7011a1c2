"""Gaps between strokes that are drawn across: only where nobody who holds the pen path against the drawing can tell."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.checking.check import check_trajectory
from planner.checking.coverage import distance_from_drawing
from planner.drawing.svg import read_drawing
from planner.head import PathWork
from planner.kinematics.projection import project
from planner.motion.crossed_gaps import Gaps, left_open
from planner.pipeline import Plan, plan
from planner.progress import unreported
from planner.settings import PlanSettings
from tests.arms.chains import kinematics_of, load_once, model_of
from tests.drawn_shapes import lines_svg

TOLERANCE_MM = 0.05


def chains(rng: np.random.Generator, count: int) -> str:
    """Three short lines in turn, each in a direction of its own, with gaps of any width that may be crossed."""
    paths = []
    for index in range(count):
        place = np.array([8.0 + 12.0 * (index % 4), 8.0 + 12.0 * (index // 4)])
        for _ in range(3):
            heading, across = rng.uniform(0.0, 2 * np.pi, 2)
            end = place + 3.0 * np.array([np.cos(heading), np.sin(heading)])
            paths.append(f'<path d="M {place[0]:.5f} {place[1]:.5f} L {end[0]:.5f} {end[1]:.5f}"/>')
            place = end + rng.uniform(0.02, 0.0995) * np.array([np.cos(across), np.sin(across)])
    return f'<g fill="none" stroke="#000">{"".join(paths)}</g>'


def drawn(folder: Path, body: str, **options: float) -> Plan:
    file = folder / "gaps.svg"
    file.write_text(lines_svg(body, 'width="60mm" height="60mm" viewBox="0 0 60 60"'), encoding="utf-8")
    made = plan(file, PlanSettings(scale=1.0, **options), unreported)  # type: ignore[arg-type]
    verdict = check_trajectory(made.trajectory, load_once("drawing_arm"), read_drawing(file))
    assert verdict.passed, str(verdict)
    return made


@settings(deadline=None, max_examples=4, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(0, 10**6), rate_hz=st.sampled_from([50.0, 100.0, 250.0]))
def test_what_is_joined_unasked_is_within_the_tolerance_of_the_drawing(
    tmp_path: Path, seed: int, rate_hz: float
) -> None:
    made = drawn(tmp_path, chains(np.random.default_rng(seed), 12), rate_hz=rate_hz)
    assert made.trajectory.path_work.join_mm is None  # the check knows of no joins
    assert made.summary.n_strokes < 1.5 * 12


@settings(deadline=None, max_examples=4, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(0, 10**6), passes=st.sampled_from([2, 3]), dedup_mm=st.sampled_from([0.0, 0.1]))
@example(seed=156, passes=2, dedup_mm=0.0)
def test_what_is_joined_and_drawn_again_is_within_the_tolerance_too(
    tmp_path: Path, seed: int, passes: int, dedup_mm: float
) -> None:
    drawn(tmp_path, chains(np.random.default_rng(seed), 12), rate_hz=100.0, passes=passes, dedup_mm=dedup_mm)


def test_lines_in_line_are_one_stroke_over_a_gap_of_nearly_twice_the_tolerance(tmp_path: Path) -> None:
    for gap, n_strokes in ((0.095, 1), (0.105, 2)):
        body = f'<path d="M 5 5 H 20 M {20 + gap} 5 H 40" fill="none" stroke="#000"/>'
        made = drawn(tmp_path, body)
        assert made.summary.n_strokes == n_strokes and not made.summary.warnings


def test_wider_gaps_are_crossed_on_request_and_that_is_said(tmp_path: Path) -> None:
    body = '<path d="M 5 5 H 20 M 20.2 5 H 40" fill="none" stroke="#000"/>'
    made = drawn(tmp_path, body, join_mm=0.25)
    assert made.summary.n_strokes == 1 and made.trajectory.path_work.join_mm == 0.25
    assert any("0.25 mm drawn across as asked, which saves 1 pen lift" in note for note in made.summary.warnings)


def test_a_stroke_is_cut_at_the_gap_that_its_motion_misses_and_nowhere_else() -> None:
    kinematics = kinematics_of(load_once("drawing_arm"))
    lines = [
        np.array([[70.0, 0.0], [80.0, 0.0]]),
        np.array([[80.09, 0.0], [80.09, 10.0]]),
        np.array([[80.09, 10.05], [90.0, 10.0]]),
    ]
    stroke = np.concatenate(lines)
    gaps = Gaps(lines)
    np.testing.assert_array_equal(gaps.crossed_by(stroke, 0.02, 0.1), [1, 3])
    np.testing.assert_array_equal(gaps.crossed_by(stroke[::-1], 0.06, 0.1), [3])

    def samples(aside_mm: float) -> FloatArray:
        places = np.concatenate([np.linspace(*ends, 40) for ends in pairwise(stroke)])
        near = np.hypot(*(places - (80.045, 0.0)).T) < 0.04
        tips = np.column_stack((places - near[:, None] * (0.0, aside_mm), np.zeros(len(places))))
        start = model_of(kinematics.arm).configuration_map().configurations_at(tips)[0]
        return kinematics.arm.complete(project(kinematics, start, tips)[0])

    assert len(left_open(kinematics, gaps, stroke, samples(0.0), TOLERANCE_MM)) == 1
    parts = left_open(kinematics, gaps, stroke, samples(0.04), TOLERANCE_MM)
    assert [part.tolist() for part in parts] == [lines[0].tolist(), np.concatenate(lines[1:]).tolist()]


def test_a_short_line_between_two_ends_is_no_gap() -> None:
    lines = [
        np.array([[0.0, 0.0], [1.0, 0.0]]),
        np.array([[1.0, 0.0], [1.08, 0.0]]),
        np.array([[1.08, 0.0], [2.0, 0.0]]),
    ]
    stroke = np.array([[0.0, 0.0], [1.0, 0.0], [1.08, 0.0], [2.0, 0.0]])
    assert len(Gaps(lines).crossed_by(stroke, 0.02, 0.1)) == 0


@pytest.mark.parametrize("tolerance_mm", [0.02, 0.2])
def test_the_gap_follows_the_tolerance(tmp_path: Path, tolerance_mm: float) -> None:
    body = f'<path d="M 5 5 H 20 M {20 + 1.9 * tolerance_mm} 5 H 40" fill="none" stroke="#000"/>'
    file = tmp_path / "gap.svg"
    file.write_text(lines_svg(body, 'width="60mm" height="60mm" viewBox="0 0 60 60"'), encoding="utf-8")
    assert plan(file, PlanSettings(scale=1.0, tolerance_mm=tolerance_mm), unreported).summary.n_strokes == 1


def test_sheets_know_the_gaps_of_the_whole() -> None:
    """What a sheet holds is moved there with its gaps, to the last bit."""
    lines = [np.array([[70.0, 0.1], [80.3, 0.2]]), np.array([[80.39, 0.2], [90.7, 10.1]])]
    stroke, moved = np.concatenate(lines), np.array([0.1, 1 / 3])
    there = Gaps([line + moved for line in Gaps(lines).strokes])
    assert there.crossed_by(stroke + moved, 0.02, 0.1).tolist() == [1]


TEES = (
    '<path d="M 5 10 H 40 M 15 9.85 V 5 M 15.1 10.15 V 20 M 30 9.82 L 28 5 L 32 5 L 30.15 9.85" '
    'fill="none" stroke="#000"/>'
)


def test_ends_on_both_sides_of_a_line_are_joined_over_it_on_request(tmp_path: Path) -> None:
    assert drawn(tmp_path, TEES).summary.n_strokes == 4
    made = drawn(tmp_path, TEES, join_mm=0.2)
    assert made.summary.n_strokes == 2  # the loop is drawn on the way
    assert any("which saves 2 pen lifts" in note for note in made.summary.warnings)
    untold = replace(made.trajectory, path_work=PathWork())
    verdict = check_trajectory(untold, load_once("drawing_arm"), read_drawing(tmp_path / "gaps.svg"))
    assert "nothing extra" in {fault.check for fault in verdict.faults}
    error_mm = distance_from_drawing(made.trajectory, read_drawing(tmp_path / "gaps.svg"), tips(made))
    assert error_mm.max() < TOLERANCE_MM + 0.01


@settings(deadline=None, max_examples=4, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(0, 10**6), join_mm=st.sampled_from([None, 0.1, 0.2, 0.3]))
def test_what_ends_about_lines_is_drawn_as_the_check_wants_it(tmp_path: Path, seed: int, join_mm: float | None) -> None:
    rng = np.random.default_rng(seed)
    paths = []
    for row in (10.0, 20.0, 20.2, 30.0):
        paths.append(f"M 5 {row} H 45")
        for place in rng.uniform(8.0, 42.0, 12):
            side = rng.choice([-1.0, 1.0])
            x, y = place + rng.uniform(-0.3, 0.3, 2)
            begin, end = (row + side * rng.choice([0.0, rng.uniform(0.0, 0.3)]) for _ in range(2))
            paths.append(f"M {x:.4f} {begin:.4f} L {x - 1:.4f} {begin + 4 * side:.4f} L {y:.4f} {end:.4f}")
    drawn(tmp_path, f'<path d="{" ".join(paths)}" fill="none" stroke="#000"/>', join_mm=join_mm)  # type: ignore[arg-type]


def test_ends_that_touch_a_line_are_joined_along_it_unasked(tmp_path: Path) -> None:
    body = '<path d="M 5 10 H 40 M 15 10 V 5 M 15.15 10 V 20" fill="none" stroke="#000"/>'
    assert drawn(tmp_path, body).summary.n_strokes == 2


@pytest.mark.parametrize(
    ("ink", "allowed"),
    [
        ("M 5 10 H 20 M 20.18 10 H 40", True),
        ("M 5 10 H 20 M 20.3 10 H 40", False),  # wider than told
        ("M 5 10 H 20 M 20.2 9.85 H 40 M 20 10 V 20", False),  # the pen goes round about
        ("M 5 10 H 39.85", False),  # the pen goes on where no line is
    ],
)
def test_the_check_knows_gaps_by_their_width_and_that_lines_are_on_both_sides(
    tmp_path: Path, ink: str, allowed: bool
) -> None:
    paths = {"M 5 10 H 20 M 20.2 9.85 H 40 M 20 10 V 20": "M 5 10 H 20 L 20.15 10.1 L 20.2 9.85 H 40 M 20 10 V 20"}
    made = drawn(tmp_path, f'<path d="{paths.get(ink, "M 5 10 H 40")}" fill="none" stroke="#000"/>')
    file = tmp_path / "ink.svg"
    file.write_text(
        lines_svg(f'<path d="{ink}" fill="none" stroke="#000"/>', 'width="60mm" height="60mm" viewBox="0 0 60 60"')
    )
    told = replace(made.trajectory, path_work=PathWork(join_mm=0.2))
    verdict = check_trajectory(told, load_once("drawing_arm"), read_drawing(file))
    assert ("nothing extra" not in {fault.check for fault in verdict.faults}) == allowed


def tips(made: Plan) -> FloatArray:
    kinematics = kinematics_of(load_once("drawing_arm"))
    joints = kinematics.arm.from_file_units(made.trajectory.positions)
    return kinematics.tip_mm(kinematics.independent_of(joints))
