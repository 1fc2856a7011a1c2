"""What is done to lines before they are drawn: nothing is lost that is not doubled, and nothing goes astray."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, MultiLineString, unary_union

from planner.arrays import FloatArray
from planner.drawing.path_work import longer, repeated, simplified, without_doubles

place = st.tuples(st.integers(0, 12), st.integers(0, 12))
polylines = st.lists(
    st.lists(place, min_size=2, max_size=6, unique=True).map(lambda points: np.array(points, dtype=float) * 5.0),
    min_size=1,
    max_size=5,
)


def length(strokes: list[FloatArray]) -> float:
    return sum(float(np.hypot(*np.diff(stroke, axis=0).T).sum()) for stroke in strokes)


@settings(deadline=None, max_examples=60)
@given(polylines)
def test_of_doubled_lines_one_is_left_and_all_that_there_was_is_still_covered(strokes: list[FloatArray]) -> None:
    kept, dropped_mm = without_doubles([*strokes, *(stroke[::-1] for stroke in strokes)], 0.05)
    there = unary_union([LineString(stroke) for stroke in strokes])
    left = MultiLineString(kept)
    assert there.difference(left.buffer(0.2)).length == pytest.approx(0.0, abs=1e-9)
    assert left.difference(there.buffer(1e-6)).length == pytest.approx(0.0, abs=1e-6)
    assert length(kept) + dropped_mm == pytest.approx(2.0 * length(strokes))
    assert length(kept) <= length(strokes) + 1e-6
    assert length(kept) <= there.length * 1.02 + 1.0  # little is left of what a stroke has twice in itself, too


@settings(deadline=None, max_examples=40)
@given(polylines, st.floats(0.001, 3.0))
def test_points_are_dropped_within_what_was_asked(strokes: list[FloatArray], within_mm: float) -> None:
    for before, after in zip(strokes, simplified(strokes, within_mm), strict=True):
        assert len(after) <= len(before)
        np.testing.assert_array_equal(after[[0, -1]], before[[0, -1]])
        assert LineString(before).hausdorff_distance(LineString(after)) <= within_mm + 1e-9


@settings(deadline=None, max_examples=40)
@given(polylines, st.integers(1, 5))
def test_passes_go_over_the_same_line_without_a_lift(strokes: list[FloatArray], passes: int) -> None:
    closed = [np.concatenate((stroke, stroke[:1])) for stroke in strokes if len(stroke) > 2]
    for before, after in zip([*strokes, *closed], repeated([*strokes, *closed], passes), strict=True):
        assert length([after]) == pytest.approx(passes * length([before]))
        assert (np.abs(np.diff(after, axis=0)).sum(axis=1) > 0).all()
    tap = np.array([[1.0, 2.0]])
    np.testing.assert_array_equal(repeated([tap], passes)[0], tap)


def test_parallels_and_crossings_stay() -> None:
    lines = [np.array([[0.0, 0.2 * row], [30.0, 0.2 * row]]) for row in range(3)]
    crossing = [np.array([[15.0, -3.0], [15.0, 3.0]])]
    assert without_doubles([*lines, *crossing], 0.05)[1] == 0.0
    dot = np.array([[3.0, 3.0]])
    kept, _ = without_doubles([dot, dot + 0.01, dot + 1.0], 0.05)
    assert [one[0, 0] for one in kept] == [3.0, 4.0]


def test_short_strokes_are_told_from_taps() -> None:
    tap, short, line = np.zeros((1, 2)), np.array([[0.0, 0.0], [0.3, 0.4]]), np.array([[0.0, 0.0], [3.0, 4.0]])
    kept, lost = longer([tap, short, line], 0.6)
    assert [len(one) for one in kept] == [1, 2] and lost[0] is short


@given(
    shift=st.floats(0.0, 0.95),
    angle=st.floats(0.0, 2 * np.pi),
    length_mm=st.floats(5.0, 60.0),
    within_mm=st.sampled_from([0.05, 0.2]),
    late=st.floats(0.0, 2.0),
    backwards=st.booleans(),
)
def test_a_line_beside_another_within_what_was_asked_is_drawn_once(
    shift: float, angle: float, length_mm: float, within_mm: float, late: float, backwards: bool
) -> None:
    along = np.array([np.cos(angle), np.sin(angle)])
    line = np.array([[0.0], [1.0]]) * length_mm * along
    other = line + shift * within_mm * np.array([-along[1], along[0]])
    other[0] += late * within_mm * along  # its points lie between those of the first
    kept, dropped_mm = without_doubles([line, other[::-1] if backwards else other], within_mm)
    assert len(kept) == 1 and dropped_mm == pytest.approx(length([other]))
