"""Dashes and gaps make the line, and have the lengths that were asked for."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.drawing.cut.arc_length import ArcLength
from planner.drawing.cut.dash import MOST_DASHES, dashed
from planner.drawing.subpath import Subpath, polyline
from tests.drawing.cut.made_subpaths import subpaths_of

LINE = polyline(np.array([[0.0, 0.0], [20.0, 0.0]]))
SQUARE = polyline(np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]), is_closed=True)
CUSP = Subpath(np.array([[[0.0, 0.0], [10.0, 10.0], [0.0, 10.0], [10.0, 0.0]]]), False, np.ones(1, dtype=np.bool_))

coordinate = st.floats(-50.0, 50.0).map(lambda value: round(value, 2))
point = st.tuples(coordinate, coordinate)


def dense_length(beziers: FloatArray) -> float:
    t = np.linspace(0.0, 1.0, 20_001)[:, np.newaxis, np.newaxis]
    b = np.moveaxis(beziers, 1, 0)
    points = (1 - t) ** 3 * b[0] + 3 * (1 - t) ** 2 * t * b[1] + 3 * (1 - t) * t**2 * b[2] + t**3 * b[3]
    return float(np.hypot(*np.moveaxis(np.diff(points, axis=0), 2, 0)).sum())


def test_a_curve_that_turns_back_is_as_long_as_both_ways() -> None:
    back = np.array([[[0.0, 0.0], [41.0, 0.0], [40.75, 0.0], [0.0, 0.0]]])
    t = np.roots(np.polyder([3 * (41.0 - 40.75), 3 * (40.75 - 2 * 41.0), 3 * 41.0, 0.0]))
    farthest = [3 * 41.0 * u * (1 - u) ** 2 + 3 * 40.75 * u * u * (1 - u) for u in t if 0.0 < u < 1.0]
    assert ArcLength.of(back).total == pytest.approx(2 * farthest[0], rel=1e-12)


def lengths_of(rows: list[FloatArray]) -> FloatArray:
    """Of rows of cubics, each its length, measured together."""
    if not rows:
        return np.zeros(0)
    length = ArcLength.of(np.concatenate(rows))
    row = np.repeat(np.arange(len(rows)), [len(beziers) for beziers in rows])
    return np.bincount(row[length.curve], np.diff(length.begins), len(rows))


def ends(dashes: list[Subpath]) -> list[tuple[float, float]]:
    return [(float(dash.beziers[0, 0, 0]), float(dash.beziers[-1, 3, 0])) for dash in dashes]


@settings(max_examples=60, deadline=None)
@given(subpaths_of(point))
def test_arc_lengths_are_those_of_many_chords(path: Subpath) -> None:
    assert ArcLength.of(path.beziers).total == pytest.approx(dense_length(path.beziers), rel=1e-6, abs=1e-9)


@settings(max_examples=50, deadline=None)
@given(subpaths_of(point), st.lists(st.floats(0.5, 30.0), min_size=1, max_size=4), st.floats(-40.0, 40.0))
def test_dashes_and_gaps_have_their_lengths(path: Subpath, array: list[float], offset: float) -> None:
    total = ArcLength.of(path.beziers).total
    pattern = array if len(array) % 2 == 0 else [*array, *array]
    # What is on by counting along the line in small steps.
    at = (np.arange(20_000) + 0.5) * total / 20_000
    which = np.searchsorted(np.cumsum(pattern), (at + offset) % sum(pattern), side="right")
    seen = float(np.mean(which % 2 == 0)) * total
    dashes = dashed([path], array, offset)
    lengths = lengths_of([dash.beziers for dash in dashes])
    assert lengths.sum() == pytest.approx(seen, rel=1e-6, abs=2e-3 * total)
    assert len(dashes) == 1 or (lengths <= 2 * max(pattern) + 1e-6 * total).all()
    for dash, following in zip(dashes, [*dashes[1:], *dashes[:1]], strict=True):
        assert np.array_equal(dash.beziers[1:, 0], dash.beziers[:-1, 3])
        if dash.gap is not None:
            np.testing.assert_allclose(dash.gap[0, 0], dash.beziers[-1, 3], atol=1e-7)
            np.testing.assert_allclose(dash.gap[-1, 3], following.beziers[0, 0], atol=1e-7)
    if path.is_closed and dashes:
        gaps = lengths_of([dash.gap for dash in dashes if dash.gap is not None])
        assert lengths.sum() + gaps.sum() == pytest.approx(total, rel=1e-6)


@pytest.mark.parametrize(
    ("array", "offset", "path_length", "wanted"),
    [
        ([5, 3], 0, None, [(0, 5), (8, 13), (16, 20)]),
        ([5], 0, None, [(0, 5), (10, 15)]),
        ([5, 3], 2, None, [(0, 3), (6, 11), (14, 19)]),
        ([5, 3], -2, None, [(2, 7), (10, 15), (18, 20)]),
        ([5, 3], 6, None, [(2, 7), (10, 15), (18, 20)]),
        ([5, 3], 800, None, [(0, 5), (8, 13), (16, 20)]),
        ([1, 1], 0, 4, [(0, 5), (10, 15)]),
        ([1, 1], 1, 4, [(5, 10), (15, 20)]),
        ([0, 8], 0, None, [(0, 0), (8, 8), (16, 16)]),
        ([2, 0, 3, 5], 0, None, [(0, 5), (10, 15)]),
        ([10, 10], 10, None, [(10, 20)]),
        ([30, 30], 30, None, []),
    ],
)
def test_a_straight_line(
    array: list[float], offset: float, path_length: float | None, wanted: list[tuple[float, float]]
) -> None:
    np.testing.assert_allclose(
        np.array(ends(dashed([LINE], array, offset, path_length))).reshape(-1, 2),
        np.array(wanted, dtype=float).reshape(-1, 2),
        atol=1e-9,
    )


@pytest.mark.parametrize("array", [[], [0.0], [0.0, 0.0], [3.0, -1.0], [5.0, 0.0], [30.0, 5.0], [np.nan], [np.inf, 1]])
def test_without_a_gap_a_line_stays_itself(array: list[float]) -> None:
    (whole,) = dashed([LINE], array, 0.0)
    assert whole is LINE


def test_too_many_dashes_are_a_solid_line() -> None:
    assert dashed([LINE], [10.0 / MOST_DASHES, 5.0 / MOST_DASHES], 0.0) == [LINE]
    assert dashed([LINE], [1e-300, 1e-300], 0.0) == [LINE]


def test_a_closed_path_has_its_last_dash_run_on_into_its_first() -> None:
    dashes = dashed([SQUARE], [6.0, 4.0], 3.0)
    assert len(dashes) == 4
    over_start = dashes[-1]
    np.testing.assert_allclose([*over_start.beziers[:, 0], over_start.beziers[-1, 3]], [[0, 3], [0, 0], [3, 0]])
    assert all(dash.gap is not None for dash in dashes)


def test_the_pattern_begins_anew_with_each_subpath_and_path_length_is_of_all() -> None:
    other = polyline(np.array([[0.0, 5.0], [20.0, 5.0]]))
    np.testing.assert_allclose(ends(dashed([LINE, other], [1, 1], 0.0, 4.0)), [(0.0, 10.0), (0.0, 10.0)], atol=1e-9)


def test_a_path_length_of_nothing_stretches_the_pattern_beyond_the_line() -> None:
    assert dashed([LINE], [1.0, 1.0], 0.0, 0.0) == [LINE]
    (dot,) = dashed([LINE], [0.0, 1.0], 0.0, 0.0)
    assert dot.is_dot


def test_lengths_near_a_cusp() -> None:
    dashes = dashed([CUSP], [1.0, 0.5], 0.0)
    for dash in dashes[:-1]:
        assert dense_length(dash.beziers) == pytest.approx(1.0, rel=1e-6)


def test_a_dot_stays_one() -> None:
    dot = polyline(np.array([[3.0, 4.0]]))
    assert dashed([dot], [1.0, 1.0], 0.5) == [dot]


@pytest.mark.parametrize("line", [LINE, polyline(np.array([[4.0, 84.0], [44.0, 84.0]]))])
def test_dots_at_both_ends_of_a_line_are_dots(line: Subpath) -> None:
    dots = dashed([line], [0.0, 3.0, 4.0, 3.0], 0.0)[::2]
    assert all(dot.is_dot for dot in dots)
    np.testing.assert_array_equal(dots[-1].beziers[0, 0], line.beziers[-1, 3])
