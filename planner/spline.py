"""Uniform B-splines over integer knots, many at once.

Cell k of a curve of degree p spans sigma in [k, k + 1] and is made of the control points k .. k + p. A
curve of n cells has n + p control points.
"""

from __future__ import annotations

from functools import lru_cache
from math import comb, factorial

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.ragged import starts_of, within


@lru_cache(maxsize=8)
def cell_polynomials(degree: int) -> FloatArray:
    """(degree + 1, degree + 1): row i holds the coefficients, lowest power first, of the weight of control
    point k + i within cell k, as a polynomial of the fraction in [0, 1] (de Boor, A Practical Guide to
    Splines, chapter IX, for uniform knots)."""
    matrix = np.zeros((degree + 1, degree + 1))
    for i in range(degree + 1):
        for power in range(degree + 1):
            total = 0.0
            for j in range(i, degree + 1):
                total += (-1) ** (j - i) * comb(degree + 1, j - i) * (degree - j) ** (degree - power)
            matrix[i, power] = comb(degree, power) * total / factorial(degree)
    return matrix


def weights(degree: int, fractions: FloatArray, derivative: int = 0) -> FloatArray:
    """(n_fractions, degree + 1) weights of the control points of a cell for the value or a derivative."""
    polynomials = cell_polynomials(degree)
    result = np.zeros((len(fractions), degree + 1))
    for power in range(derivative, degree + 1):
        factor = factorial(power) / factorial(power - derivative)
        result += factor * polynomials[:, power] * np.asarray(fractions)[:, None] ** (power - derivative)
    return result


def first_controls(n_cells: IntArray, degree: int) -> IntArray:
    """(total cells,) index of the first control point of each cell, for curves laid end to end."""
    starts = starts_of(n_cells + degree)[:-1]
    indices: IntArray = np.repeat(starts, n_cells) + within(n_cells)
    return indices


def evaluate(
    controls: FloatArray, cell_controls: IntArray, fractions: FloatArray, degree: int, derivative: int = 0
) -> FloatArray:
    """Values (n_cells, n_fractions, d) at the same fractions of every cell.

    controls: (n_controls, d); cell_controls: (n_cells,) from `first_controls`.
    """
    table = weights(degree, fractions, derivative)
    values = np.zeros((len(cell_controls), len(fractions), controls.shape[1]))
    for i in range(degree + 1):
        values += controls[cell_controls + i][:, None, :] * table[None, :, i, None]
    return values


def evaluate_at(
    controls: FloatArray, cell_controls: IntArray, fractions: FloatArray, degree: int, derivative: int = 0
) -> FloatArray:
    """Values (n, d) at one fraction per row: fractions (n,), cell_controls (n,)."""
    table = weights(degree, fractions, derivative)
    values = np.zeros((len(cell_controls), controls.shape[1]))
    for i in range(degree + 1):
        values += controls[cell_controls + i] * table[:, i, None]
    return values


def subdivided(controls: FloatArray, n_cells: IntArray, degree: int) -> FloatArray:
    """Control points (2 total cells + degree n_curves, d) of the same curves with every cell cut in two.

    controls: (total cells + degree n_curves, d) of curves laid end to end (Lane and Riesenfeld 1980: each new
    control point is a mean of old ones with binomial weights).
    """
    mask = [comb(degree + 1, k) / 2**degree for k in range(degree + 2)]
    new_count = 2 * n_cells + degree
    index = within(new_count)
    first = np.repeat(starts_of(n_cells + degree)[:-1], new_count)
    last = np.repeat(n_cells + degree - 1, new_count)
    cut = np.zeros((len(index), controls.shape[1]))
    for step in range(degree // 2 + 2):
        old = (index - 1) // 2 + step  # the first old control point that reaches new point j is (j - 1) / 2
        weight_index = index - 2 * old + degree
        used = (weight_index >= 0) & (weight_index <= degree + 1) & (old >= 0) & (old <= last)
        weight = np.where(used, np.take(mask, np.clip(weight_index, 0, degree + 1)), 0.0)
        cut += weight[:, None] * controls[first + np.clip(old, 0, last)]
    return cut


def interpolating(values: FloatArray, degree: int = 5) -> FloatArray:
    """(n + degree, d) control points of the one curve of n cells through values (n + 1, d) at its knots whose highest
    derivative does not change at the knots next to the ends ("not a knot"; de Boor, chapter XIII). degree: odd."""
    n_cells = len(values) - 1
    count = n_cells + degree
    rows = np.zeros((count, count))
    right = np.zeros((count, values.shape[1]))
    at_knot = weights(degree, np.zeros(1))[0, :degree]
    for knot in range(n_cells + 1):
        rows[knot, knot : knot + degree] = at_knot
    right[: n_cells + 1] = values
    change = np.array([(-1) ** k * comb(degree + 1, k) for k in range(degree + 2)])
    half = (degree - 1) // 2
    for k, first in enumerate((*range(half), *range(count - degree - 1 - half, count - degree - 1))):
        rows[n_cells + 1 + k, first : first + degree + 2] = change
    return np.asarray(np.linalg.solve(rows, right), dtype=np.float64)
