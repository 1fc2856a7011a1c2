"""Joint positions along smooth paths: quintic splines through exact configurations at every knot."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.lapack import dgbsv
from planner.ragged import starts_of, within
from planner.spline import weights
from planner.spline_paths import DEGREE, SplinePaths


class JointPaths(SplinePaths):
    """Joint paths before timing: positions are configurations (n_joints,) in rad or mm. Splines reproduce linear
    relations, so couplings hold between knots as they do at them."""

    __slots__ = ()


def interpolate(n_cells: IntArray, knots: FloatArray) -> JointPaths:
    """Splines through the knot positions, with first and second derivatives zero at both ends of each path.

    n_cells: (n_paths,), each at least 4; knots: (total cells + n_paths, n_joints), the positions at
    sigma = 0 .. n_cells of each path in turn. The ends are at rest because sigma passes them with
    the pen's arc length growing as its cube.
    """
    count = n_cells + DEGREE
    total = int(count.sum())
    position = within(count)
    last = np.repeat(count, count) - 1
    starts = starts_of(count)[:-1]
    value, slope, bend = (weights(DEGREE, np.zeros(1), derivative)[0, :5] for derivative in range(3))
    band = np.zeros((9, total))  # band[4 + row - column, column]

    def set_rows(rows: IntArray, first_column: IntArray, coefficients: FloatArray) -> None:
        for k, coefficient in enumerate(coefficients):
            band[4 + rows - (first_column + k), first_column + k] = coefficient

    inner = np.flatnonzero((position >= 2) & (position <= last - 2))
    set_rows(inner, inner - 2, value)
    ends = starts + count - 5
    set_rows(starts, starts, slope)
    set_rows(starts + 1, starts, bend)
    set_rows(starts + count - 2, ends, bend)
    set_rows(starts + count - 1, ends, slope)
    right = np.zeros((total, knots.shape[1]))
    right[inner] = knots
    _, _, controls, _ = dgbsv(4, 4, np.pad(band, ((4, 0), (0, 0))), right, overwrite_ab=True, overwrite_b=True)
    return JointPaths(n_cells, np.ascontiguousarray(controls))
