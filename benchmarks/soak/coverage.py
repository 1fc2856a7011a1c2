"""How often each tenth of a millimetre of wanted lines was drawn, and how far off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.spatial import KDTree

from planner.arrays import BoolArray, FloatArray

_CELL_MM = 0.1
_FINE_MM = 0.01
_SKIPPED_MM = 2.0
"""Ink that goes round a corner is not nearest to the corner itself."""
_ENDS_MM = 0.15
"""Ends of lines may be so much short: a pen comes down on a spot, and pulses are half microseconds."""


@dataclass(frozen=True)
class Coverage:
    """off_mm: how far from all wanted lines ink lies, each tenth of a millimetre of it. missing_mm: length that was not
    drawn. again_mm: length that each drawn line laid on what lines before it had drawn."""

    off_mm: FloatArray
    missing_mm: float
    again_mm: list[float]


def coverage(drawn: Sequence[FloatArray], wanted: Sequence[FloatArray]) -> Coverage:
    """Lines (n, 2) in mm. Wanted lines keep their distance from each other and from themselves."""
    dense = [_dense(line) for line in wanted]
    owner = np.repeat(np.arange(len(dense)), [len(line) for line in dense])
    starts = np.cumsum([0, *(len(line) for line in dense)])
    tree, fine = KDTree(np.concatenate(dense)), KDTree(np.concatenate([_dense(line, _FINE_MM) for line in wanted]))
    there: BoolArray = np.zeros(len(owner), dtype=np.bool_)
    off_mm, again_mm = [], []
    for line in drawn:
        points_mm = _dense(line)
        off_mm.append(fine.query(points_mm)[0])
        nearest = tree.query(points_mm)[1]
        touched = np.zeros_like(there)
        for one in np.unique(owner[nearest]):
            cells = nearest[owner[nearest] == one]
            touched[cells] = True
            for low, high in np.sort(np.column_stack((cells[:-1], cells[1:])), axis=1):
                if high - low <= _SKIPPED_MM / _CELL_MM:  # else from the end of a closed line to its beginning
                    touched[low:high] = True
        again_mm.append(_CELL_MM * float((touched & there).sum()))
        there |= touched
    missing = ~there
    for begin, end in pairwise(starts.tolist()):
        ends = min(round(_ENDS_MM / _CELL_MM), (end - begin - 1) // 2)
        missing[begin : begin + ends] = missing[end - ends : end] = False
    return Coverage(np.concatenate(off_mm), _CELL_MM * float(missing.sum()), again_mm)


def _dense(line: FloatArray, spacing_mm: float = _CELL_MM) -> FloatArray:
    along = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))))
    at = np.linspace(0.0, along[-1], max(round(along[-1] / spacing_mm) + 1, 1))
    return np.column_stack([np.interp(at, along, line[:, axis]) for axis in (0, 1)])
