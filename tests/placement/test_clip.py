"""Clipping keeps what is reachable, to within its step, and counts what it leaves out."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import BoolArray, FloatArray
from planner.placement.clip import clip_strokes

STEP_MM = 0.25
INNER_MM, OUTER_MM = 33.0, 140.0

place = st.tuples(st.floats(-200, 200), st.floats(-200, 200))
strokes_made = st.lists(st.lists(place, min_size=1, max_size=6, unique=True).map(np.array), min_size=1, max_size=4)


def in_ring(points_mm: FloatArray) -> BoolArray:
    radius = np.hypot(*points_mm.T)
    inside: BoolArray = (radius >= INNER_MM) & (radius <= OUTER_MM)
    return inside


def points_of(lines: list[shapely.LineString]) -> FloatArray:
    points: FloatArray = shapely.get_coordinates(shapely.segmentize(lines, 0.5))
    return points


def furthest_mm(points: FloatArray, lines: list[shapely.LineString]) -> float:
    shape = shapely.MultiLineString(lines)
    shapely.prepare(shape)
    with np.errstate(all="ignore"):  # segments next to nothing
        return float(shapely.distance(shape, shapely.points(points)).max())


@settings(deadline=None, max_examples=30)
@given(strokes_made)
def test_what_is_kept_is_the_part_within_reach(strokes: list[FloatArray]) -> None:
    kept, lost_mm, lost_whole = clip_strokes(strokes, in_ring, OUTER_MM)
    lines = [shapely.LineString(stroke) for stroke in strokes if len(stroke) > 1]
    kept_lines = [shapely.LineString(stroke) for stroke in kept if len(stroke) > 1]
    before, after = points_of(lines), points_of(kept_lines)
    assert all(in_ring(stroke).all() for stroke in kept)
    if kept_lines:
        assert furthest_mm(after, lines) < 1e-9  # nothing new
        radius = np.hypot(*after.T)
        assert radius.min() > INNER_MM - STEP_MM and radius.max() < OUTER_MM + STEP_MM  # nothing out of reach
    if lines:
        radius = np.hypot(*before.T)
        well_within = before[(radius > INNER_MM + STEP_MM) & (radius < OUTER_MM - STEP_MM)]
        if len(well_within):
            assert furthest_mm(well_within, kept_lines) < 1.5 * STEP_MM  # nothing left out that is in reach
    total_mm = sum(line.length for line in lines)
    np.testing.assert_allclose(lost_mm + sum(line.length for line in kept_lines), total_mm, atol=1e-8)
    assert lost_whole <= len(strokes) <= len(kept) + lost_whole


def test_a_step_next_to_nothing_is_no_cause_for_warnings() -> None:
    stroke = np.array([[50.0, 0.0], [50.0, 1e-310], [60.0, 10.0]])
    kept, lost_mm, _ = clip_strokes([stroke, stroke + 2 * OUTER_MM], in_ring, OUTER_MM)
    assert len(kept) == 1 and lost_mm > 0


def test_a_stroke_within_reach_is_left_as_it_is() -> None:
    stroke = np.array([[50.0, 0.0], [60.0, 10.0]])
    kept, lost_mm, lost_whole = clip_strokes([stroke], in_ring, OUTER_MM)
    assert kept[0] is stroke and (lost_mm, lost_whole) == (0.0, 0)


def test_a_stroke_across_the_hole_becomes_two() -> None:
    kept, lost_mm, lost_whole = clip_strokes([np.array([[-60.0, 0.0], [60.0, 0.0]])], in_ring, OUTER_MM)
    assert lost_whole == 0 and [len(run) > 1 for run in kept] == [True, True]
    np.testing.assert_allclose(
        np.abs([kept[0][[0, -1], 0], kept[1][::-1][[0, -1], 0]]), [[60.0, 33.0]] * 2, atol=STEP_MM
    )
    assert abs(lost_mm - 66.0) < 2 * STEP_MM


def test_taps_are_kept_or_lost_whole() -> None:
    near, far = np.array([[50.0, 0.0]]), np.array([[500.0, 0.0]])
    kept, lost_mm, lost_whole = clip_strokes([near, far], in_ring, OUTER_MM)
    assert kept == [near] and (lost_mm, lost_whole) == (0.0, 1)


@pytest.mark.parametrize("far_mm", [1e3, 1e6, 1e9])
def test_a_line_from_miles_away_is_probed_near_the_arm_alone(far_mm: float) -> None:
    line = np.array([[-far_mm, 50.0], [far_mm, 50.0 + 1e-3 * far_mm]])
    probed = 0

    def counting(points_mm: FloatArray) -> BoolArray:
        nonlocal probed
        probed += len(points_mm)
        return in_ring(points_mm)

    kept, _, _ = clip_strokes([line, line[::-1] + 1e8], counting, OUTER_MM)
    assert probed < 4 * OUTER_MM / STEP_MM
    assert bool(kept) is (far_mm < 1e6)  # else it passes by
