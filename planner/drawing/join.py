"""Strokes whose ends touch become one, so that the pen need not be lifted between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.drawing.nearest import NearestPoints

# Ends that share a cell of this share of the tolerance coincide but for rounding, and are joined first.
_EXACT_SHARE = 0.02
_ROUNDING_MM = 1e-9
"""Ends that are no further apart are in one place, whatever is asked for."""
_NEIGHBOURS = 8
LEAST_ROUND = 4.0
"""Length of a stroke whose own ends may be joined, in lengths that may be joined: a shorter one is no way round."""


def join_strokes(strokes: Sequence[FloatArray], tolerance_mm: float = 0.05) -> list[FloatArray]:
    """Chains of strokes (n, 2) whose ends lie within `tolerance_mm` of each other, either way round.

    Where several meet, the straightest continuation is taken. Closed strokes and taps stay as they are. A chain takes
    the place and direction of its first stroke; every point of every stroke is kept, exact repeats at a joint aside.
    """
    free = free_ends(strokes)
    partner = np.full(2 * len(strokes), -1, dtype=np.int64)
    if len(free) > 2:
        points = np.array([(stroke[0], stroke[-1]) for stroke in strokes]).reshape(-1, 2)
        outward = np.array([_outward(stroke) for stroke in strokes]).reshape(-1, 2)
        _match(partner, free, points, outward, tolerance_mm)
    return chained(strokes, partner, {})


def free_ends(strokes: Sequence[FloatArray]) -> IntArray:
    """The ends of open strokes: end 2 s is where stroke s begins, end 2 s + 1 where it ends."""
    is_open = np.array([len(stroke) > 1 and not is_closed(stroke) for stroke in strokes], dtype=np.bool_)
    return np.flatnonzero(np.repeat(is_open, 2))


def chained(strokes: Sequence[FloatArray], partner: IntArray, over: Mapping[int, FloatArray]) -> list[FloatArray]:
    """The strokes (n, 2) with each end joined to its partner, of those that `free_ends` numbers; -1 for none.

    over: the point (2,) that the way from an end to its partner goes over, for both of them, where it is not straight.
    """
    joined = []
    is_used = np.zeros(len(strokes), dtype=np.bool_)
    for index, stroke in enumerate(strokes):
        if is_used[index]:
            continue
        if (partner[2 * index : 2 * index + 2] < 0).all():
            joined.append(stroke)
            continue
        chain, is_loop = _chain(partner, index)
        is_used[[end // 2 for end in chain]] = True
        joined.append(_assembled(strokes, chain, is_loop, over))
    return joined


def is_closed(stroke: FloatArray) -> bool:
    """Whether a stroke ends exactly where it begins, having been somewhere else."""
    return len(stroke) > 2 and bool(np.all(stroke[0] == stroke[-1]))


def _outward(stroke: FloatArray) -> FloatArray:
    """Unit directions (2, 2) in which a stroke would go on beyond its start and its end."""
    if len(stroke) < 2:
        return np.zeros((2, 2))
    along = np.array([stroke[0] - stroke[1], stroke[-1] - stroke[-2]])
    lengths: FloatArray = np.linalg.norm(along, axis=1, keepdims=True)
    return along / np.where(lengths > 0.0, lengths, 1.0)


def _match(partner: IntArray, ends: IntArray, points: FloatArray, outward: FloatArray, tolerance_mm: float) -> None:
    """Pair free ends, the straightest first: those that coincide, then those within the tolerance.

    Each round proposes a fixed number of partners to each end, so that a point where thousands of strokes meet takes
    no quadratic number of pairs.
    """
    free = ends
    for propose in (_coincident, _near):
        while len(free) > 1:
            one, other = propose(free, points, outward, tolerance_mm)
            # The two ends of one stroke never pair: a stroke shorter than the tolerance would curl up.
            is_pair = one // 2 != other // 2
            one, other = np.minimum(one, other)[is_pair], np.maximum(one, other)[is_pair]
            if len(one) == 0:
                break
            turn = np.round(np.sum(outward[one] * outward[other], axis=1), 9)
            best = np.lexsort((other, one, turn))
            for a, b in zip(one[best].tolist(), other[best].tolist(), strict=True):
                if partner[a] < 0 and partner[b] < 0:
                    partner[a], partner[b] = b, a
            free = free[partner[free] < 0]


def _coincident(
    free: IntArray, points: FloatArray, outward: FloatArray, tolerance_mm: float
) -> tuple[IntArray, IntArray]:
    """Pairs of ends in one place, for each end those that lead most nearly straight on."""
    cells = np.round(points[free] / max(_EXACT_SHARE * tolerance_mm, _ROUNDING_MM))
    place = np.unique(cells, axis=0, return_inverse=True)[1].ravel()
    angle = np.arctan2(outward[free, 1], outward[free, 0]) % (2.0 * np.pi)
    by_angle = np.lexsort((angle, place))
    # One sorted row of all places, each taking up 8 of it and 2 pi for its angles.
    row = (8.0 * place + angle)[by_angle]
    sizes = np.bincount(place)
    first = (np.cumsum(sizes) - sizes)[place]
    opposite = np.searchsorted(row, 8.0 * place + (angle + np.pi) % (2.0 * np.pi)) - first
    offsets = np.arange(-_NEIGHBOURS // 2, _NEIGHBOURS // 2)[:, np.newaxis]
    partners = by_angle[first + (opposite + offsets) % sizes[place]]
    return np.tile(free, len(offsets)), free[partners.ravel()]


def _near(free: IntArray, points: FloatArray, _: FloatArray, tolerance_mm: float) -> tuple[IntArray, IntArray]:
    """Pairs of ends within the tolerance, for each end its nearest."""
    k = min(_NEIGHBOURS + 1, len(free))
    gaps, others = NearestPoints(points[free]).query(points[free], k)
    rows, columns = np.nonzero(gaps <= tolerance_mm * (1.0 + 1e-9))
    return free[rows], free[others[rows, columns]]


def _chain(partner: IntArray, index: int) -> tuple[list[int], bool]:
    """The ends by which the pen enters each stroke of the chain of `index`, and whether the chain is a loop."""
    entry = 2 * index
    while partner[entry] >= 0:
        entry = int(partner[entry]) ^ 1
        if entry == 2 * index:
            break
    is_loop = partner[entry] >= 0
    chain = [entry]
    while True:
        following = int(partner[chain[-1] ^ 1])
        if following < 0 or following == chain[0]:
            return chain, bool(is_loop)
        chain.append(following)


def _assembled(
    strokes: Sequence[FloatArray], chain: list[int], is_loop: bool, over: Mapping[int, FloatArray]
) -> FloatArray:
    pieces = []
    for entry in chain:
        pieces.append(strokes[entry // 2][::-1] if entry % 2 else strokes[entry // 2])
        if entry ^ 1 in over:
            pieces.append(over[entry ^ 1][np.newaxis])
    if is_loop:
        pieces.append(pieces[0][:1])
    points = np.concatenate(pieces)
    is_new = np.ones(len(points), dtype=np.bool_)
    is_new[1:] = np.any(points[1:] != points[:-1], axis=1)
    joined: FloatArray = points[is_new]
    return joined
