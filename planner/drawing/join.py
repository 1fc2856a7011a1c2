"""Strokes whose ends touch become one, so that the pen need not be lifted between them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from planner.arrays import FloatArray, IntArray

# Ends that meet within this share of the tolerance are taken to meet exactly, and are joined first.
_EXACT_SHARE = 0.02
_NEIGHBOURS = 8


def join_strokes(strokes: Sequence[FloatArray], tolerance_mm: float = 0.05) -> list[FloatArray]:
    """Chains of strokes (n, 2) whose ends lie within `tolerance_mm` of each other, either way round.

    Where several meet, the straightest continuation is taken. Closed strokes and taps stay as they are. A chain takes
    the place and direction of its first stroke; every point of every stroke is kept, exact repeats at a joint aside.
    """
    is_open = np.array([len(stroke) > 1 and not is_closed(stroke) for stroke in strokes], dtype=np.bool_)
    open_strokes = np.flatnonzero(is_open)
    # End 2 s is where stroke s begins, end 2 s + 1 where it ends; all that follows speaks of ends.
    partner = np.full(2 * len(strokes), -1, dtype=np.int64)
    if len(open_strokes) > 1:
        points = np.array([(stroke[0], stroke[-1]) for stroke in strokes]).reshape(-1, 2)
        outward = np.array([_outward(stroke) for stroke in strokes]).reshape(-1, 2)
        _match(partner, np.stack([2 * open_strokes, 2 * open_strokes + 1], axis=1).ravel(),
               points, outward, tolerance_mm)
    joined = []
    is_used = np.zeros(len(strokes), dtype=np.bool_)
    for index, stroke in enumerate(strokes):
        if is_used[index]:
            continue
        if not is_open[index]:
            joined.append(stroke)
            continue
        chain, is_loop = _chain(partner, index)
        is_used[[end // 2 for end in chain]] = True
        joined.append(_assembled(strokes, chain, is_loop))
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
    """Pair free ends, best pairs first, until none are left within the tolerance.

    Each round looks at a fixed number of neighbours of each end: a point where thousands of strokes meet takes
    more rounds and not a quadratic number of pairs.
    """
    free = ends
    while len(free) > 1:
        k = min(_NEIGHBOURS + 1, len(free))
        gaps, others = cKDTree(points[free]).query(points[free], k=k, distance_upper_bound=tolerance_mm * (1 + 1e-9))
        rows, columns = np.nonzero(np.isfinite(gaps))
        near, far, gap = free[rows], free[others[rows, columns]], gaps[rows, columns]
        one, other = np.minimum(near, far), np.maximum(near, far)
        # The two ends of one stroke never pair: a stroke shorter than the tolerance would curl up.
        is_pair = one // 2 != other // 2
        one, other, gap = one[is_pair], other[is_pair], gap[is_pair]
        if len(one) == 0:
            break
        turn = np.round(np.sum(outward[one] * outward[other], axis=1), 9)
        best = np.lexsort((other, one, np.round(gap, 9), turn, gap > _EXACT_SHARE * tolerance_mm))
        for a, b in zip(one[best].tolist(), other[best].tolist(), strict=True):
            if partner[a] < 0 and partner[b] < 0:
                partner[a], partner[b] = b, a
        free = free[partner[free] < 0]


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


def _assembled(strokes: Sequence[FloatArray], chain: list[int], is_loop: bool) -> FloatArray:
    pieces = [strokes[entry // 2][::-1] if entry % 2 else strokes[entry // 2] for entry in chain]
    if len(pieces) == 1 and not is_loop:
        return pieces[0]
    if is_loop:
        pieces.append(pieces[0][:1])
    points = np.concatenate(pieces)
    is_new = np.ones(len(points), dtype=np.bool_)
    is_new[1:] = np.any(points[1:] != points[:-1], axis=1)
    joined: FloatArray = points[is_new]
    return joined
