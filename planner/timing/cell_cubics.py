"""b in one cell: the cubic that has given values and slopes at both ends of it."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.timing.timing_problem import FRACTIONS

HERMITE = np.array([[1.0, 0.0, -3.0, 2.0], [0.0, 1.0, -2.0, 1.0], [0.0, 0.0, 3.0, -2.0], [0.0, 0.0, -1.0, 1.0]])
"""Polynomials in the fraction, lowest power first, of the four unknowns of a cell: b and b' at its left and right."""

BOOLE = np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90
"""Weights of the points for an integral over the cell."""


def _powers(fractions: FloatArray, derivative: int) -> FloatArray:
    """(n, 4) a derivative of 1, f, f^2, f^3 at the fractions."""
    f, one, zero = fractions, np.ones_like(fractions), np.zeros_like(fractions)
    rows = ((one, f, f**2, f**3), (zero, one, 2 * f, 3 * f**2), (zero, zero, 2 * one, 6 * f))
    return np.stack(rows[derivative], axis=1)


VALUE_FORMS = _powers(FRACTIONS, 0) @ HERMITE.T
"""(5 points, 4 unknowns) b at the points of a cell."""


def linear_form(fraction: float, on_value: FloatArray, on_slope: FloatArray, on_bend: FloatArray | float) -> FloatArray:
    """(4, n_joints, cells) the form on_value b + on_slope b' + on_bend b'' at a fraction of each cell, in
    terms of the cell's unknowns."""
    value, slope, bend = (_powers(np.array([fraction]), derivative)[0] @ HERMITE.T for derivative in range(3))
    return np.stack([value[k] * on_value + slope[k] * on_slope + bend[k] * on_bend for k in range(4)])
