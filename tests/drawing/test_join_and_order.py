"""Joining and ordering lose nothing, add nothing, and shorten the way of the lifted pen."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.drawing.join import is_closed, join_strokes
from planner.drawing.metric import Metric
from planner.drawing.order import order_strokes, travel

ORIGIN = np.zeros(2)
grid = st.tuples(st.integers(0, 6), st.integers(0, 6))
METRICS = [
    Metric(lambda points: points),
    Metric(lambda points: np.column_stack([points[:, 0], 3.0 * points[:, 1], points.sum(axis=1)])),
    Metric(lambda points: points, exponent=1 / 3),
]


def without_repeats(points: list[tuple[int, int]]) -> FloatArray:
    kept = [one for one, before in zip(points, [None, *points], strict=False) if one != before]
    return np.array(kept, dtype=np.float64)


many_strokes = st.lists(st.lists(grid, min_size=1, max_size=4).map(without_repeats), max_size=14)


def segments(strokes: Sequence[FloatArray]) -> Counter[tuple[tuple[float, ...], ...]]:
    """All undirected line segments, and the taps."""
    pieces = [stroke.tolist() * 2 if len(stroke) == 1 else stroke.tolist() for stroke in strokes]
    return Counter(tuple(sorted((tuple(a), tuple(b)))) for piece in pieces for a, b in itertools.pairwise(piece))


@given(many_strokes)
def test_joining_keeps_every_segment(strokes: list[FloatArray]) -> None:
    joined = join_strokes(strokes)
    assert segments(joined) == segments(strokes)
    assert len(joined) <= len(strokes)
    ends = [
        tuple(point)
        for stroke in joined
        if len(stroke) > 1 and not is_closed(stroke)
        for point in stroke[[0, -1]].tolist()
    ]
    owners = {}
    for index, end in enumerate(ends):
        # Two ends left in one place belong to one and the same stroke.
        assert owners.setdefault(end, index // 2) == index // 2


def test_ends_meet_either_way_round_within_the_tolerance() -> None:
    strokes = [
        np.array([[0, 0], [1, 0]]),
        np.array([[2, 0], [1.03, 0]]),
        np.array([[2, 0.04], [3, 0]]),
        np.array([[3.06, 0], [4, 0]]),
    ]
    joined = join_strokes(strokes, 0.05)
    assert [stroke.tolist() for stroke in joined] == [
        [[0, 0], [1, 0], [1.03, 0], [2, 0], [2, 0.04], [3, 0]],
        [[3.06, 0], [4, 0]],
    ]


def test_crossing_lines_go_straight_on() -> None:
    arms = [np.array([[0.0, 0.0], end]) for end in ([1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0])]
    assert [stroke.tolist() for stroke in join_strokes(arms)] == [[[-1, 0], [0, 0], [1, 0]], [[0, -1], [0, 0], [0, 1]]]


def test_a_loop_of_pieces_closes_and_closed_strokes_and_taps_stay() -> None:
    square = [np.array(piece, dtype=float) for piece in ([[0, 0], [1, 0]], [[1, 1], [1, 0]], [[1, 1], [0, 1], [0, 0]])]
    triangle = np.array([[0.0, 0], [2, 0], [0, 2], [0, 0]])
    tap = np.array([[0.0, 0.0]])
    loop, same_triangle, same_tap = join_strokes([*square, triangle, tap])
    assert loop.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]
    assert np.array_equal(same_triangle, triangle)
    assert np.array_equal(same_tap, tap)


def test_a_line_in_pieces_shorter_than_the_tolerance_becomes_one() -> None:
    x = np.arange(101) * 0.01
    pieces = [np.array([[a, 0.0], [b, 0.0]]) for a, b in itertools.pairwise(x)]
    (line,) = join_strokes(pieces, 0.05)
    assert np.array_equal(line[:, 0], x)


def test_thousands_of_ends_in_one_place() -> None:
    angles = np.linspace(0.0, 2.0 * np.pi, 4000, endpoint=False)
    star = [np.array([[0.0, 0.0], [np.cos(angle), np.sin(angle)]]) for angle in angles]
    assert len(join_strokes(star, 1e-6)) == 2000


@pytest.mark.parametrize("metric", METRICS, ids=["page", "chebyshev", "cube root"])
@given(strokes=many_strokes)
def test_ordering_keeps_every_segment_and_never_lengthens_the_way(metric: Metric, strokes: list[FloatArray]) -> None:
    ordered = order_strokes(strokes, ORIGIN, metric)
    assert len(ordered) == len(strokes)
    assert segments(ordered) == segments(strokes)
    assert travel(ordered, ORIGIN, metric) <= travel(strokes, ORIGIN, metric)
    assert all(np.array_equal(a, b) for a, b in zip(ordered, order_strokes(strokes, ORIGIN, metric), strict=True))


@pytest.mark.parametrize("seed", range(6))
def test_small_tours_are_close_to_the_best(seed: int) -> None:
    generator = np.random.default_rng(seed)
    strokes = [generator.uniform(0, 10, (2, 2)) for _ in range(5)]
    best = min(
        travel([stroke[::-1] if turned else stroke for stroke, turned in zip(row, turns, strict=True)], ORIGIN)
        for row in itertools.permutations(strokes)
        for turns in itertools.product((False, True), repeat=5)
    )
    assert travel(order_strokes(strokes, ORIGIN), ORIGIN) <= 1.15 * best + 1e-9


def test_a_shuffled_row_is_put_straight() -> None:
    generator = np.random.default_rng(4)
    row = [np.array([[x, 0.0], [x + 0.5, 0.0]]) for x in range(300)]
    shuffled = [row[index][::-1] if generator.random() < 0.5 else row[index] for index in generator.permutation(300)]
    assert travel(order_strokes(shuffled, ORIGIN), ORIGIN) == pytest.approx(299 * 0.5)


def test_closed_strokes_begin_where_it_is_nearest() -> None:
    square = np.array([[9.0, 9.0], [9.0, 1.0], [1.0, 1.0], [1.0, 9.0], [9.0, 9.0]])
    (begun,) = order_strokes([square], ORIGIN)
    assert begun.tolist() == [[1, 1], [1, 9], [9, 9], [9, 1], [1, 1]]


def test_random_strokes_come_near_the_known_bound() -> None:
    strokes = list(np.random.default_rng(1).uniform(0, 1, (600, 1, 2)))
    # A random tour of n points in the unit square takes about 0.7124 sqrt(n) at best.
    assert travel(order_strokes(strokes, ORIGIN), ORIGIN) < 0.7124 * np.sqrt(600) * 1.15


@given(st.integers(0, 2**32 - 1), st.integers(2, 40))
def test_a_cut_line_is_joined_again_whatever_the_order_and_direction_of_its_pieces(seed: int, count: int) -> None:
    """Cut ends that were moved by less than half of the tolerance each: none of them is left."""
    random = np.random.default_rng(seed)
    line = np.column_stack((np.arange(2.0 * count + 1), random.uniform(-1.0, 1.0, 2 * count + 1)))
    pieces = [line[2 * index : 2 * index + 3].copy() for index in range(count)]
    for piece in pieces:
        for end in (0, -1):
            turn = random.uniform(0.0, 2.0 * np.pi)
            piece[end] += 0.024 * random.uniform() * np.array([np.cos(turn), np.sin(turn)])
    mixed = [pieces[index][:: random.choice((-1, 1))] for index in random.permutation(count)]
    (joined,) = join_strokes(mixed, 0.05)
    if joined[0, 0] > joined[-1, 0]:
        joined = joined[::-1]
    assert np.array_equal(joined, np.concatenate(pieces))


@pytest.mark.parametrize(("gap", "count"), [(0.0499, 1), (0.0501, 2)])
def test_ends_are_joined_up_to_the_tolerance_and_no_further(gap: float, count: int) -> None:
    assert len(join_strokes([np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([[1.0 + gap, 0.0], [2.0, 0.0]])])) == count
