"""The order and direction of strokes that shortens the way of the lifted pen.

A greedy tour to the nearest stroke, then 2-opt and Or-opt over neighbour lists, where turning a piece of the tour
round also turns its strokes (Bentley, Fast algorithms for geometric traveling salesman problems, 1992). The amount of
work is bounded by counts, never by a clock, so that the same strokes always give the same order.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.drawing.join import is_closed
from planner.drawing.metric import STRAIGHT, Metric
from planner.drawing.nearest import NearestPoints
from planner.drawing.tour import improve

_FIRST_NEIGHBOURS = 8
_ROUNDS = 3
"""Searches for a tour, each with closed strokes begun anew where the one before passes them best: none makes the way
longer, and there is no end that has to be reached."""


def travel(strokes: Sequence[FloatArray], start_xy: FloatArray, metric: Metric = STRAIGHT) -> float:
    """The pen-up way from `start_xy` (2,) through all strokes (n, 2) in their order, in units of the metric."""
    if not strokes:
        return 0.0
    starts = metric.embed(np.array([stroke[0] for stroke in strokes]))
    ends = metric.embed(np.array([start_xy, *(stroke[-1] for stroke in strokes[:-1])]))
    return float(np.sum(metric.distance(starts, ends)))


def order_strokes(strokes: Sequence[FloatArray], start_xy: FloatArray, metric: Metric = STRAIGHT) -> list[FloatArray]:
    """Strokes as `ordered` has them."""
    return ordered(strokes, start_xy, metric)[0]


def ordered(
    strokes: Sequence[FloatArray], start_xy: FloatArray, metric: Metric = STRAIGHT
) -> tuple[list[FloatArray], bool]:
    """The same strokes, reordered, reversed, and closed ones begun at another of their points; and whether each search
    for a shorter way came to its end, rather than to the limit of its work.

    The travel from `start_xy` is never longer than in the order given.
    """
    if not strokes:
        return [], True
    candidates = _Candidates(strokes, metric)
    start = metric.embed(np.asarray(start_xy, dtype=np.float64).reshape(1, 2))[0]
    tour, entries, exits = _greedy(candidates, start)
    is_finished = True
    for _ in range(_ROUNDS):
        tour, is_reversed, to_the_end = improve(
            start, candidates.vectors[entries], candidates.vectors[exits], tour, metric
        )
        is_finished &= to_the_end
        entries[is_reversed], exits[is_reversed] = exits[is_reversed], entries[is_reversed]
        if not _rotate_closed(candidates, start, tour, entries, exits, metric):
            break
    found = [_begun_at(strokes[index], int(entries[index] - candidates.first[index])) for index in tour.tolist()]
    is_shorter = travel(found, start_xy, metric) < travel(strokes, start_xy, metric)
    return found if is_shorter else list(strokes), is_finished


class _Candidates:
    """The points where strokes may begin: both ends, or any point of a closed one.

    vectors: (n, k) embedded; owner: (n,) stroke; index: (n,) point in its stroke. The candidates of stroke s stand
    at first[s] to first[s + 1].
    """

    def __init__(self, strokes: Sequence[FloatArray], metric: Metric) -> None:
        self.is_closed = np.array([is_closed(stroke) for stroke in strokes], dtype=np.bool_)
        pieces = [
            stroke[:-1] if closed else stroke[[0, -1]]
            for stroke, closed in zip(strokes, self.is_closed.tolist(), strict=True)
        ]
        counts = np.array([len(piece) for piece in pieces])
        self.vectors = np.asarray(metric.embed(np.concatenate(pieces)), dtype=np.float64)
        self.owner: IntArray = np.repeat(np.arange(len(strokes)), counts)
        self.first: IntArray = np.concatenate([[0], np.cumsum(counts)])

    def exit_of(self, candidate: int) -> int:
        """Where the pen leaves a stroke that it entered at `candidate`."""
        owner = int(self.owner[candidate])
        return candidate if self.is_closed[owner] else 2 * int(self.first[owner]) + 1 - candidate


def _greedy(candidates: _Candidates, start: FloatArray) -> tuple[IntArray, IntArray, IntArray]:
    """Always on to the nearest stroke left: the order, and for each stroke its candidates of entry and exit."""
    n_strokes = len(candidates.is_closed)
    tour = np.empty(n_strokes, dtype=np.int64)
    entries = np.empty(n_strokes, dtype=np.int64)
    exits = np.empty(n_strokes, dtype=np.int64)
    is_left = np.ones(n_strokes, dtype=np.bool_)
    alive = np.arange(len(candidates.owner))
    tree = NearestPoints(candidates.vectors)
    place = start
    for position in range(n_strokes):
        nearest, k = -1, _FIRST_NEIGHBOURS
        while nearest < 0:
            k = min(k, len(alive))
            found = tree.query(place[None], k)[1][0]
            usable = found[is_left[candidates.owner[alive[found]]]]
            if len(usable):
                nearest = int(alive[usable[0]])
            elif k >= 8 * _FIRST_NEIGHBOURS:
                # Too many strokes about are done with: plant the tree anew without them.
                alive = alive[is_left[candidates.owner[alive]]]
                tree = NearestPoints(candidates.vectors[alive])
                k = 1
            else:
                k *= 4
        owner = int(candidates.owner[nearest])
        tour[position], entries[owner], exits[owner] = owner, nearest, candidates.exit_of(nearest)
        is_left[owner] = False
        place = candidates.vectors[exits[owner]]
    return tour, entries, exits


def _rotate_closed(
    candidates: _Candidates, start: FloatArray, tour: IntArray, entries: IntArray, exits: IntArray, metric: Metric
) -> bool:
    """Begin each closed stroke where the way in and out is shortest; whether that changed anything."""
    is_changed = False
    for position, index in enumerate(tour.tolist()):
        if not candidates.is_closed[index]:
            continue
        first, end = candidates.first[index], candidates.first[index + 1]
        points = candidates.vectors[first:end]
        before = candidates.vectors[exits[tour[position - 1]]] if position else start
        way = metric.distance(points, before)
        if position + 1 < len(tour):
            way = way + metric.distance(points, candidates.vectors[entries[tour[position + 1]]])
        best = int(np.argmin(way))
        if way[best] < way[entries[index] - first] - 1e-12:
            entries[index] = exits[index] = first + best
            is_changed = True
    return is_changed


def _begun_at(stroke: FloatArray, candidate: int) -> FloatArray:
    """The stroke entered at its `candidate`: an end of an open stroke, a point of a closed one."""
    if candidate == 0:
        return stroke
    if not is_closed(stroke):
        return stroke[::-1]
    begun: FloatArray = np.concatenate([stroke[candidate:-1], stroke[: candidate + 1]])
    return begun
