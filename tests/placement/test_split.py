"""Strokes are cut into the fewest pieces that lie in one sheet each, and nothing of them is lost."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import BoolArray, FloatArray
from planner.placement.split import split_strokes

STEP_MM = 0.25
place = st.tuples(st.floats(-30, 30), st.floats(-30, 30))
strokes_made = st.lists(place, min_size=2, max_size=5, unique=True).map(np.array)


def between(low: float, high: float) -> Callable[[FloatArray], BoolArray]:
    """A sheet that holds a strip across x."""

    def held(points: FloatArray) -> BoolArray:
        inside: BoolArray = (points[:, 0] >= low) & (points[:, 0] <= high)
        return inside

    return held


SHEETS = (between(-40, -5), between(-10, 15), between(5, 40))


def length(points: FloatArray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def fewest(points: FloatArray) -> int:
    """Pieces that a search over all cuts needs."""
    held = np.array([sheet(points) for sheet in SHEETS])
    needed = [0] + [len(points)] * (len(points) - 1)
    for last in range(1, len(points)):
        for one in held:
            first = last
            while first >= 0 and one[first]:
                needed[last] = min(needed[last], needed[first] + 1)
                first -= 1
    return needed[-1]


def dense(stroke: FloatArray) -> FloatArray:
    steps = [
        np.linspace(one, other, max(int(np.ceil(np.hypot(*(other - one)) / STEP_MM)), 1) + 1)[:-1]
        for one, other in pairwise(stroke)
    ]
    return np.concatenate([*steps, stroke[-1:]])


@settings(deadline=None, max_examples=60)
@given(strokes_made)
def test_an_open_stroke_has_the_fewest_pieces_and_loses_nothing(stroke: FloatArray) -> None:
    pieces, n_split, n_more = split_strokes([stroke], SHEETS)
    assert all(any(sheet(piece).all() for sheet in SHEETS) for piece in pieces)
    assert all(np.array_equal(one[-1], other[0]) for one, other in pairwise(pieces))
    np.testing.assert_array_equal(pieces[0][0], stroke[0])
    np.testing.assert_array_equal(pieces[-1][-1], stroke[-1])
    np.testing.assert_allclose(sum(map(length, pieces)), length(stroke), rtol=1e-9)
    assert len(pieces) == fewest(dense(stroke)) == n_more + 1
    assert n_split == (len(pieces) > 1)


def test_a_closed_stroke_begins_where_it_is_cut() -> None:
    ring = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 5.0], [0.0, 5.0], [0.0, 0.0]])
    pieces, n_split, n_more = split_strokes([ring], SHEETS)
    assert (len(pieces), n_split, n_more) == (2, 1, 1)
    np.testing.assert_array_equal(pieces[0][0], pieces[1][-1])
    np.testing.assert_array_equal(pieces[0][-1], pieces[1][0])
    np.testing.assert_allclose(sum(map(length, pieces)), length(ring))


def test_what_need_not_or_cannot_be_split_stays_as_it_is() -> None:
    inside, tap = np.array([[0.0, 0.0], [9.0, 0.0]]), np.array([[0.0, 0.0]])
    beyond = np.array([[0.0, 0.0], [50.0, 0.0]])
    pieces, n_split, n_more = split_strokes([inside, tap, beyond], SHEETS)
    assert pieces[0] is inside and pieces[1] is tap and pieces[2] is beyond
    assert (n_split, n_more) == (0, 0)
