"""The length of outlines."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.drawing import Outline

_CHORDS = 16


def length_mm(outlines: Iterable[Outline], affine: FloatArray) -> float:
    """Of all curves after `affine` (2, 3), by chords: to a thousandth for what is usually drawn."""
    share = np.linspace(0.0, 1.0, _CHORDS + 1)[:, None, None]
    total = 0.0
    for outline in outlines:
        p0, p1, p2, p3 = np.moveaxis(outline.beziers @ affine[:, :2].T, 1, 0)
        rest = 1.0 - share
        points = rest**3 * p0 + 3.0 * rest**2 * share * p1 + 3.0 * rest * share**2 * p2 + share**3 * p3
        total += float(np.hypot(*np.moveaxis(np.diff(points, axis=0), 2, 0)).sum())
    return total
