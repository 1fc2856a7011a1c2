"""Cutting strokes where the arm has to change to another branch, which it cannot with the pen down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.placement.clip import densified


def split_strokes(
    strokes: Sequence[FloatArray], branches: Sequence[Callable[[FloatArray], BoolArray]]
) -> tuple[list[FloatArray], int, int]:
    """Strokes (n, 2) in pieces that lie in one branch each, how many were cut, and how many pieces there are more.

    branches: each tells which of points (n, 2) it holds. Staying in a branch for as long as possible takes the fewest
    pieces (greedy cover of an interval by intervals); a closed stroke that begins amid a branch has its last piece run
    on into its first. Neighbouring pieces share the point of the cut. A stroke with a place in no branch stays whole:
    it is for the next station to say why it cannot be drawn. Strokes are probed every quarter of a millimetre."""
    pieces: list[FloatArray] = []
    n_split = 0
    for stroke in strokes:
        points = densified(stroke)
        held = np.array([branch(points) for branch in branches])
        parts = [stroke] if held.all(axis=1).any() else _parts(points, held) or [stroke]
        n_split += len(parts) > 1
        pieces += parts
    return pieces, n_split, len(pieces) - len(strokes)


def _parts(points: FloatArray, held: BoolArray) -> list[FloatArray]:
    """The fewest runs of points that lie in one branch each, none where some place lies in no branch."""
    last_point = len(points) - 1
    cuts = [0]
    branches: list[int] = []
    while cuts[-1] < last_point:
        lasts = [_last_in_run(one, cuts[-1]) for one in held]
        branches.append(int(np.argmax(lasts)))
        if lasts[branches[-1]] <= cuts[-1]:
            return []
        cuts.append(lasts[branches[-1]])
    parts = [points[first : last + 1] for first, last in pairwise(cuts)]
    is_closed = len(parts) > 2 and np.array_equal(points[0], points[-1])
    if is_closed and held[branches[0], cuts[-2] :].all():
        parts = [np.concatenate((parts[-1], parts[0][1:])), *parts[1:-1]]
    return parts


def _last_in_run(held: BoolArray, first: int) -> int:
    """The last point of the run of held ones that begins at `first`, or the one before where that is not held."""
    outside = np.flatnonzero(~held[first:])
    return first + int(outside[0]) - 1 if len(outside) else len(held) - 1
