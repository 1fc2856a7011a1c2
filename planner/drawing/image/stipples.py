"""Dots as dense as a density says, evenly spread: weighted Voronoi stippling.

Dots are first laid along a Hilbert curve, one for each unit of density passed, which puts the right number everywhere.
Lloyd's iteration then spreads them: each moves to the centre of mass of its Voronoi cell. Dots at rest are as dense as
the square root of the weight in two dimensions (Du, Faber, Gunzburger, Centroidal Voronoi tessellations, 1999), so the
weight is the square of the density, and what is right at first stays so (Secord, Weighted Voronoi stippling, 2002).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from planner.arrays import FloatArray, IntArray
from planner.errors import PlanError

MOST_DOTS = 200_000
_ROUNDS = 8


def stipples(density: NDArray[np.float32], low_mm: FloatArray, pitch_mm: float) -> FloatArray:
    """(n, 2), mm, in the order of a Hilbert curve. density: (n_x, n_y) dots to a square mm; low_mm: (2,) the middle of
    its first cell. Errors: PlanError for too many."""
    cells = np.argwhere(density > 0.0)
    if not len(cells):
        return np.empty((0, 2))
    cells = cells[np.argsort(_hilbert(cells, density.shape), kind="stable")]
    dense = density[cells[:, 0], cells[:, 1]].astype(np.float64)
    passed = np.cumsum(dense) * pitch_mm**2
    n_dots = int(np.floor(passed[-1] + 0.5))
    if n_dots > MOST_DOTS:
        raise PlanError(
            f"a picture would take {n_dots} dots, and {MOST_DOTS} are the most: choose a wider --image-line, or a"
            " lower --image-ink"
        )
    places = low_mm + pitch_mm * cells
    if not n_dots:
        return np.empty((0, 2))
    dots = places[np.minimum(np.searchsorted(passed, np.arange(n_dots) + 0.5), len(cells) - 1)]
    dots = dots + _apart(len(dots), pitch_mm)
    weight = dense**2
    for _ in range(_ROUNDS):
        _, nearest = cKDTree(dots, balanced_tree=False, compact_nodes=False).query(places)
        mass = np.bincount(nearest, weight, n_dots)
        centre = np.stack([np.bincount(nearest, weight * places[:, axis], n_dots) for axis in (0, 1)], axis=1)
        is_moved = mass > 0.0
        dots[is_moved] = centre[is_moved] / mass[is_moved, None]
    return dots


def _apart(n_dots: int, pitch_mm: float) -> FloatArray:
    """(n, 2) a little, different for each: two dots of one cell must not stay one."""
    number = np.arange(n_dots)
    plastic = np.array([0.7548776662466927, 0.5698402909980532])
    moves: FloatArray = pitch_mm * (np.mod(number[:, None] * plastic, 1.0) - 0.5)
    return moves


def _hilbert(cells: IntArray, shape: tuple[int, ...]) -> IntArray:
    """(n,) how far along a Hilbert curve each cell of a grid of that shape lies. The grid is stretched to the curve's
    square, which has a power of two for a side: a curve that left the grid would come back far away."""
    side = 1 << max(max(shape) - 1, 1).bit_length()
    x, y = (side * cells[:, axis] // shape[axis] for axis in (0, 1))
    along = np.zeros(len(cells), dtype=np.int64)
    half = side >> 1
    while half:
        right, up = (x & half) > 0, (y & half) > 0
        along += half * half * ((3 * right) ^ up)
        flip = ~up & right
        x, y = np.where(flip, side - 1 - x, x), np.where(flip, side - 1 - y, y)
        x, y = np.where(up, x, y), np.where(up, y, x)
        half >>= 1
    return along
