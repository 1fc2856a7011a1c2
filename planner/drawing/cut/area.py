"""Whether a fill has anything to fill."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.drawing.subpath import Subpath

_NOTHING = 1e-9
"""Against the square of the extent."""
_CROSS_PRODUCTS = np.array([[0, 6, 3, 1], [0, 0, 3, 3], [0, 0, 0, 6], [0, 0, 0, 0]]) / 20.0


def signed_areas(paths: Sequence[Subpath]) -> FloatArray:
    """(n,) what each subpath, closed, goes round one way less what it goes round the other: Green's theorem, of which a
    cubic's part is a sum of cross products of its control points."""
    if not paths:
        return np.zeros(0)
    first = np.cumsum([0, *(len(path.beziers) for path in paths[:-1])])
    x, y = np.moveaxis(np.concatenate([path.beziers - path.beziers[0, 0] for path in paths]), 2, 0)
    of_curves = np.sum((x @ _CROSS_PRODUCTS) * y - (y @ _CROSS_PRODUCTS) * x, axis=1)
    areas: FloatArray = np.add.reduceat(of_curves, first)
    return areas


def go_round(paths: Sequence[Subpath]) -> BoolArray:
    """(n,) whether each subpath goes round anything more one way than the other: then a fill of it has an area."""
    does: BoolArray = np.abs(signed_areas(paths)) > _NOTHING * _extents(paths) ** 2
    return does


def _extents(paths: Sequence[Subpath]) -> FloatArray:
    return np.array([float(np.ptp(path.beziers.reshape(-1, 2), axis=0).max()) for path in paths])


def have_area(paths: Sequence[Subpath]) -> BoolArray:
    """(n,) whether a fill of each subpath by itself covers anything: a line there and back does not, an eight does."""
    extents = _extents(paths)
    has_area = go_round(paths)
    for index in np.flatnonzero(~has_area).tolist():
        from planner.drawing.cut.region import region

        has_area[index] = region([paths[index]], is_even_odd=False).area > _NOTHING * extents[index] ** 2
    return has_area
