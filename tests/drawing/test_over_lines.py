"""Ends on both sides of a line are joined over it: no lift is added, nothing is lost, and little drawn beside it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.drawing.ink import Ink
from planner.drawing.join import is_closed
from planner.drawing.over_lines import Leaps, join_over_lines
from planner.polyline_length import polyline_length

LEAP_MM = 0.2
ANY = Leaps(LEAP_MM, LEAP_MM, LEAP_MM)
ALONG = Leaps(LEAP_MM, 0.05, 1e-3)
coordinates = st.tuples(st.integers(0, 24), st.integers(0, 24)).map(lambda place: (place[0] / 12, place[1] / 12))
lines = st.lists(coordinates, min_size=2, max_size=4, unique=True).map(lambda points: np.array(points, dtype=float))
taps = coordinates.map(lambda place: np.array([place], dtype=float))
many = st.lists(st.one_of(lines, lines, taps), max_size=12)


def ink(strokes: Sequence[FloatArray]) -> shapely.Geometry:
    return shapely.union_all([shapely.LineString(stroke) for stroke in strokes if len(stroke) > 1])


def over(strokes: list[FloatArray], leaps: Leaps) -> list[FloatArray]:
    return join_over_lines(strokes, Ink(strokes, 0.0), leaps)


def length(strokes: Sequence[FloatArray]) -> float:
    return sum(map(polyline_length, strokes))


def n_ends(strokes: Sequence[FloatArray]) -> int:
    return sum(2 for stroke in strokes if len(stroke) > 1 and not is_closed(stroke))


@given(many, st.sampled_from([ANY, ALONG]))
def test_no_line_is_lost_and_two_leaps_are_drawn_for_two_ends(strokes: list[FloatArray], leaps: Leaps) -> None:
    joined = over(strokes, leaps)
    n_joined = (n_ends(strokes) - n_ends(joined)) // 2
    assert len(joined) <= len(strokes)
    assert length(strokes) - 1e-9 <= length(joined) <= length(strokes) + 2 * LEAP_MM * n_joined + 1e-6
    assert sum(len(stroke) == 1 for stroke in joined) == sum(len(stroke) == 1 for stroke in strokes)
    if length(strokes):
        assert ink(strokes).difference(ink(joined).buffer(1e-6)).length == pytest.approx(0.0, abs=1e-9)
        off_mm = (LEAP_MM if leaps is ANY else ALONG.through_air) / 2
        assert ink(joined).difference(ink(strokes).buffer(off_mm + 1e-3)).length == pytest.approx(0.0, abs=1e-6)


@settings(deadline=None, max_examples=50)
@given(
    turn=st.floats(0.0, 2 * np.pi),
    heights=st.tuples(st.floats(0.0, 0.15), st.floats(-0.15, 0.15)),
    along=st.floats(0.0, 0.2),
    turned_round=st.tuples(st.booleans(), st.booleans()),
)
def test_two_ends_near_a_line_are_one_stroke_over_it_by_the_shortest_way(
    turn: float, heights: tuple[float, float], along: float, turned_round: tuple[bool, bool]
) -> None:
    ends = np.array([(10.0, heights[0]), (10.0 + along, heights[1])])
    far = [(x, y + (long if y >= 0.0 else -long)) for (x, y), long in zip(ends.tolist(), (5.0, 7.0), strict=True)]
    cosine, sine = np.cos(turn), np.sin(turn)
    strokes = [
        np.array(line) @ np.array([[cosine, sine], [-sine, cosine]])
        for line in (
            [(0.0, 0.0), (20.0, 0.0)],
            [far[0], ends[0]][:: 1 if turned_round[0] else -1],
            [far[1], ends[1]][:: 1 if turned_round[1] else -1],
        )
    ]
    joined = over(strokes, ANY)
    one, other = (stroke[-1] if turned else stroke[0] for stroke, turned in zip(strokes[1:], turned_round, strict=True))
    along_all = np.concatenate(
        [line[0] + np.linspace(0.0, 1.0, 20_001)[:, None] * (line[1] - line[0]) for line in strokes]
    )
    leaps = np.stack([np.hypot(*(along_all - end).T) for end in (one, other)])
    best = int(np.argmin(leaps.sum(axis=0)))
    if leaps[:, best].max() < LEAP_MM - 0.002:
        assert len(joined) == 2
        assert length(joined) == pytest.approx(length(strokes) + leaps[:, best].sum(), abs=2e-3)


def test_an_end_that_meets_a_line_alone_stays_as_it_is() -> None:
    strokes = [np.array([[0.0, 0.0], [20.0, 0.0]]), np.array([[10.0, 0.1], [10.0, 5.0]])]
    assert over(strokes, ANY) == strokes


def test_the_ends_of_one_stroke_are_joined_over_another_line_alone() -> None:
    horseshoe = np.array([[9.9, 0.1], [9.0, 4.0], [11.0, 4.0], [10.1, 0.1]])
    joined = over([np.array([[0.0, 0.0], [20.0, 0.0]]), horseshoe], ANY)
    assert [is_closed(stroke) for stroke in joined] == [False, True]
    (alone,) = over([horseshoe], ANY)
    np.testing.assert_array_equal(alone, horseshoe)


def test_unasked_only_ends_on_the_line_go_along_it() -> None:
    line, far = np.array([[0.0, 0.0], [20.0, 0.0]]), np.array([10.0, 5.0])
    for height, n_strokes in ((0.0, 2), (0.06, 3)):
        strokes = [line, np.array([(9.9, height), far]), np.array([(10.1, height), far + 5.0])]
        assert len(over(strokes, ALONG)) == n_strokes


def test_thousands_of_ends_about_a_place_are_no_quadratic_number_of_ways() -> None:
    angle = np.linspace(0.0, 2 * np.pi, 20_000, endpoint=False)
    spokes = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    strokes = [np.stack((0.1 * spoke, 30.0 * spoke)) for spoke in spokes]
    assert len(over(strokes, ANY)) <= 20_000


def test_no_way_leads_over_a_gap_that_is_drawn_across() -> None:
    lines = [np.array([[0.0, 0.0], [9.9, 0.0]]), np.array([[10.1, 0.0], [20.0, 0.0]])]
    both = [np.array([[10.0, 0.15], [10.0, 5.0]]), np.array([[10.0, -0.15], [10.0, -5.0]])]
    joined = [np.concatenate(lines), *both]
    assert len(join_over_lines(joined, Ink([*lines, *both], 0.05), Leaps(0.16, 0.16, 0.0))) == 3
    assert len(join_over_lines(joined, Ink(joined, 0.05), Leaps(0.16, 0.16, 0.0))) == 2
