"""Closed strokes are drawn on the way of strokes that touch them: nothing is lost, nothing twice, and no lift spent."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.drawing.ink import Ink
from planner.drawing.join import is_closed
from planner.drawing.loops import with_loops
from planner.polyline_length import polyline_length

NEAR_MM = 0.1
coordinates = st.tuples(st.integers(0, 12), st.integers(0, 12))


def circle(x: float, y: float, radius: float) -> FloatArray:
    angle = np.linspace(0.0, 2 * np.pi, 25)
    points = np.column_stack((x + radius * np.cos(angle), y + radius * np.sin(angle)))
    points[-1] = points[0]
    return points


circles = st.builds(circle, st.integers(0, 12), st.integers(0, 12), st.integers(1, 3))
lines = st.lists(coordinates, min_size=2, max_size=3, unique=True).map(lambda points: np.array(points, dtype=float))
many = st.lists(st.one_of(circles, lines, coordinates.map(lambda point: np.array([point], dtype=float))), max_size=9)


def ink(strokes: Sequence[FloatArray]) -> shapely.Geometry:
    return shapely.union_all([shapely.LineString(stroke) for stroke in strokes if len(stroke) > 1])


def led_of(strokes: list[FloatArray], near_mm: float) -> list[FloatArray]:
    return with_loops(strokes, Ink(strokes, 0.0), near_mm)


def length(strokes: Sequence[FloatArray]) -> float:
    return sum(map(polyline_length, strokes))


@given(many)
def test_the_ink_stays_the_same_and_is_drawn_once(strokes: list[FloatArray]) -> None:
    led = led_of(strokes, NEAR_MM)
    assert len(led) <= len(strokes)
    across_mm = 2.0 * NEAR_MM * (len(strokes) - len(led))  # to and fro
    assert length(strokes) - 1e-6 <= length(led) <= length(strokes) + across_mm + 1e-6
    if length(strokes):
        assert shapely.hausdorff_distance(ink(strokes), ink(led), densify=0.1) <= NEAR_MM / 2 + 1e-6


@given(many)
def test_no_closed_stroke_is_left_that_touches_another_line(strokes: list[FloatArray]) -> None:
    led = led_of(strokes, NEAR_MM)
    shapes = [shapely.LineString(stroke) for stroke in led if len(stroke) > 1]
    closed = [is_closed(stroke) for stroke in led if len(stroke) > 1]
    for one, (shape, is_loop) in enumerate(zip(shapes, closed, strict=True)):
        near = [shape.distance(other) <= NEAR_MM for index, other in enumerate(shapes) if index != one]
        assert not (is_loop and any(near))


@given(many)
def test_open_strokes_keep_their_ends_and_taps_stay(strokes: list[FloatArray]) -> None:
    def ends(some: Sequence[FloatArray]) -> list[list[list[float]]]:
        return sorted(stroke[[0, -1]].tolist() for stroke in some if not is_closed(stroke))

    assert ends(led_of(strokes, NEAR_MM)) == ends(strokes)


def test_a_chain_of_rings_and_a_line_is_one_stroke() -> None:
    strokes = [*(circle(2.0 * x, 0.0, 1.0) for x in range(40)), np.array([[-5.0, 0.0], [-1.05, 0.0]])]
    (led,) = led_of(strokes, NEAR_MM)
    assert polyline_length(led) == pytest.approx(length(strokes) + 0.1, abs=1e-6)


def test_a_way_round_is_taken_in_the_direction_that_turns_less() -> None:
    for ring in (circle(0.0, 1.0, 1.0), circle(0.0, 1.0, 1.0)[::-1]):
        (led,) = led_of([np.array([[-3.0, 0.0], [3.0, 0.0]]), ring], NEAR_MM)
        heading = np.diff(led, axis=0)
        turn = np.sum(heading[1:] * heading[:-1], axis=1) / (
            np.linalg.norm(heading[1:], axis=1) * np.linalg.norm(heading[:-1], axis=1)
        )
        assert turn.min() > 0.9


def test_a_ring_with_a_gap_is_one_where_its_ends_may_be_joined() -> None:
    ring, line = circle(0.0, 0.0, 2.0), np.array([[-4.0, 0.0], [4.0, 0.0]])
    ring[-1] += (0.0, -0.09)
    assert len(led_of([line, ring], NEAR_MM)) == 1
    assert len(led_of([line, ring], 0.05)) == 2


def test_a_gap_that_is_drawn_across_is_not_touched() -> None:
    lines = [np.array([[-4.0, 0.0], [-0.1, 0.0]]), np.array([[0.1, 0.0], [4.0, 0.0]])]
    ring, joined = circle(0.0, 1.05, 1.0), [np.concatenate(lines)]
    assert len(with_loops([*joined, ring], Ink([*lines, ring], 0.0), 0.06)) == 2
    assert len(with_loops([*joined, ring], Ink([*joined, ring], 0.0), 0.06)) == 1
    assert len(with_loops([*joined, ring], Ink([*lines, ring], 0.2), 0.06)) == 1  # that narrow gaps are none
