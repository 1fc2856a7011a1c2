"""Strokes by the work they are, and very long ones in pieces of bounded size, so that neither memory nor the wait for
one process grows with them.

Between two pieces the pen rests for an instant, still on the paper, at a vertex of the stroke: at the sharpest one near
the wanted cut, where it is slow anyway.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from planner.arrays import FloatArray
from planner.placement.pen_path import expected_cells

_CELLS = 3000
"""What pieces are near to. A stroke of up to half as much again stays whole."""
_WINDOW = 0.2
"""Share of a piece in which the sharpest vertex is sought, on either side of the wanted cut."""
_POINTS_AT_ONCE = 20_000


@dataclass(frozen=True, eq=False, slots=True)
class Piece:
    """A stroke or a part of one, (n, 2) in mm, and about how many cells its smooth path has."""

    points_mm: FloatArray
    n_cells: float


def in_pieces(strokes: Sequence[FloatArray], tolerance_mm: float, *, whole: bool = False) -> Iterator[list[Piece]]:
    """The pieces of each stroke (n, 2), by the stroke alone: each begins with the last point of the one before. One a
    stroke if they are wanted whole."""
    for batch in _batches(strokes):
        for stroke, cells in zip(batch, expected_cells(batch, tolerance_mm), strict=True):
            cuts = [0, *([] if whole else _cuts(stroke, cells)), len(stroke) - 1]
            yield [Piece(stroke[first:last + 1], float(cells[last] - cells[first]))
                   for first, last in pairwise(cuts)]


def _batches(strokes: Sequence[FloatArray]) -> Iterator[Sequence[FloatArray]]:
    first = points = 0
    for index, stroke in enumerate(strokes):
        points += len(stroke)
        if points >= _POINTS_AT_ONCE or index + 1 == len(strokes):
            yield strokes[first:index + 1]
            first, points = index + 1, 0


def _cuts(stroke: FloatArray, cells: FloatArray) -> list[int]:
    """Points at which a stroke is cut, increasing and none of them an end."""
    count = round(float(cells[-1]) / _CELLS)
    if count < 2:
        return []
    steps = np.diff(stroke, axis=0)
    steps /= np.hypot(*steps.T)[:, None]
    straightness = np.full(len(stroke), np.inf)  # the cosine of the turn
    straightness[1:-1] = (steps[:-1] * steps[1:]).sum(axis=1)
    piece = float(cells[-1]) / count
    cuts: list[int] = []
    for middle in piece * np.arange(1, count):
        low, high = np.searchsorted(cells, (middle - _WINDOW * piece, middle + _WINDOW * piece)).tolist()
        if low < high:  # else no vertex is near: one long straight goes by
            cuts.append(low + int(np.argmin(straightness[low:high])))
    return cuts
