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
from planner.placement.rounded_path import expected_cells

_WORK = 1500
"""What pieces are near to, in cells of their smooth paths. A stroke of up to half as much again stays whole."""
_WORK_PER_POINT = 0.05
"""A point is less work than a cell, but where points are dense there are many more of them."""
_WINDOW = 0.2
"""Share of a piece in which the sharpest vertex is sought, on either side of the wanted cut."""
_POINTS_AT_ONCE = 20_000


@dataclass(frozen=True, eq=False, slots=True)
class Piece:
    """A stroke or a part of one, (n, 2) in mm, and about how much work it is."""

    points_mm: FloatArray
    work: float


def in_pieces(strokes: Sequence[FloatArray], tolerance_mm: float, *, whole: bool = False) -> Iterator[list[Piece]]:
    """The pieces of each stroke (n, 2), by the stroke alone: each begins with the last point of the one before. One a
    stroke if they are wanted whole."""
    for stroke, work in zip(strokes, _work_along(strokes, tolerance_mm), strict=True):
        cuts = [0, *([] if whole else _cuts(stroke, work)), len(stroke) - 1]
        yield [Piece(stroke[first : last + 1], float(work[last] - work[first])) for first, last in pairwise(cuts)]


def halves(pieces: Sequence[Piece]) -> list[Piece]:
    """The same stroke, with each piece that has a vertex in its middle half cut in two at the sharpest one there."""
    found: list[Piece] = []
    for piece in pieces:
        n = len(piece.points_mm)
        low, high = max(n // 4, 1), min(n - n // 4, n - 1)
        if low >= high:
            found.append(piece)
            continue
        cut = low + int(np.argmin(_straightness(piece.points_mm)[low:high]))
        share = cut / (n - 1)
        found.append(Piece(piece.points_mm[: cut + 1], share * piece.work))
        found.append(Piece(piece.points_mm[cut:], (1.0 - share) * piece.work))
    return found


def _work_along(strokes: Sequence[FloatArray], tolerance_mm: float) -> Iterator[FloatArray]:
    """(n,) for each stroke: the work that it is up to each of its points. Short strokes are looked at together, long
    ones part by part."""
    together: list[FloatArray] = []
    points = 0
    for stroke in strokes:
        if points + len(stroke) > _POINTS_AT_ONCE:
            yield from _work_of(together, tolerance_mm)
            together, points = [], 0
        if len(stroke) <= _POINTS_AT_ONCE:
            together.append(stroke)
            points += len(stroke)
            continue
        along = np.zeros(1)
        for first in range(0, len(stroke) - 1, _POINTS_AT_ONCE):
            (more,) = _work_of([stroke[first : first + _POINTS_AT_ONCE + 1]], tolerance_mm)
            along = np.concatenate((along, along[-1] + more[1:]))
        yield along
    yield from _work_of(together, tolerance_mm)


def _work_of(strokes: Sequence[FloatArray], tolerance_mm: float) -> list[FloatArray]:
    return [
        cells + _WORK_PER_POINT * np.arange(len(cells))
        for cells in (expected_cells(strokes, tolerance_mm) if strokes else ())
    ]


def _cuts(stroke: FloatArray, work: FloatArray) -> list[int]:
    """Points at which a stroke is cut, increasing and none of them an end."""
    count = round(float(work[-1]) / _WORK)
    if count < 2:
        return []
    straightness = _straightness(stroke)
    piece = float(work[-1]) / count
    cuts: list[int] = []
    for middle in piece * np.arange(1, count):
        low, high = np.searchsorted(work, (middle - _WINDOW * piece, middle + _WINDOW * piece)).tolist()
        if low < high:  # else no vertex is near: one long straight goes by
            cuts.append(low + int(np.argmin(straightness[low:high])))
    return cuts


def _straightness(stroke: FloatArray) -> FloatArray:
    """(n,) the cosine of the turn at each point; inf at the ends."""
    steps = np.diff(stroke, axis=0)
    steps /= np.hypot(*steps.T)[:, None]
    straightness = np.full(len(stroke), np.inf)
    straightness[1:-1] = (steps[:-1] * steps[1:]).sum(axis=1)
    return straightness
