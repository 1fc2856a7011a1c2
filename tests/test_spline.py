"""Uniform B-splines: partition of unity, polynomials kept, derivatives, smooth joints between cells; and the
arrays of sequences laid end to end that they are evaluated over."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline, make_interp_spline

from planner.arrays import FloatArray
from planner.ragged import starts_of, within
from planner.spline import cell_polynomials, evaluate, evaluate_at, first_controls, interpolating, subdivided, weights

DEGREES = pytest.mark.parametrize("degree", [1, 2, 3, 5])
FRACTIONS = np.linspace(0, 1, 11)
COUNTS = st.lists(st.integers(1, 9), min_size=1, max_size=6).map(np.array)


@DEGREES
def test_weights_are_a_partition_of_unity(degree: int) -> None:
    table = weights(degree, FRACTIONS)
    assert table.shape == (11, degree + 1)
    assert (table >= -1e-15).all()
    np.testing.assert_allclose(table.sum(axis=1), 1.0, atol=1e-14)
    for derivative in range(1, degree + 1):
        np.testing.assert_allclose(weights(degree, FRACTIONS, derivative).sum(axis=1), 0.0, atol=1e-12)


@DEGREES
def test_weights_are_those_of_the_basis_splines(degree: int) -> None:
    """SciPy's basis over integer knots, cell by cell of one bump."""
    bump = BSpline.basis_element(np.arange(degree + 2), extrapolate=False)
    for derivative in range(degree + 1):
        table = weights(degree, FRACTIONS[1:-1], derivative)
        curve = bump.derivative(derivative) if derivative else bump
        for i in range(degree + 1):
            np.testing.assert_allclose(table[:, i], curve(degree - i + FRACTIONS[1:-1]), atol=1e-12)


@DEGREES
def test_derivatives_are_difference_quotients(degree: int) -> None:
    step = 1e-5
    inner = FRACTIONS[1:-1]
    for derivative in range(1, degree + 1):
        lower = derivative - 1
        slope = (weights(degree, inner + step, lower) - weights(degree, inner - step, lower)) / (2 * step)
        np.testing.assert_allclose(weights(degree, inner, derivative), slope, atol=1e-8)


@DEGREES
def test_neighbouring_cells_meet_in_all_derivatives_but_the_last(degree: int) -> None:
    """The end of a cell, in terms of control points k + 1 .., is the beginning of the next."""
    for derivative in range(degree):
        end, begin = weights(degree, np.array([0.0, 1.0]), derivative)[::-1]
        np.testing.assert_allclose(end[1:], begin[:-1], atol=1e-12)
        assert end[0] == pytest.approx(0, abs=1e-12) and begin[-1] == pytest.approx(0, abs=1e-12)
    assert cell_polynomials(degree).shape == (degree + 1, degree + 1)


@given(counts=COUNTS)
def test_ragged_positions_count_within_each_sequence(counts: np.ndarray) -> None:
    starts = starts_of(counts)
    assert starts[0] == 0 and starts[-1] == counts.sum() and (np.diff(starts) == counts).all()
    expected = [place for count in counts for place in range(count)]
    assert within(counts).tolist() == expected


@given(n_cells=COUNTS, degree=st.sampled_from([3, 5]))
def test_each_cell_begins_at_its_own_control_point(n_cells: np.ndarray, degree: int) -> None:
    controls = first_controls(n_cells, degree)
    starts = starts_of(n_cells)
    for path, (begin, end) in enumerate(pairwise(starts.tolist())):
        own = controls[begin:end]
        assert own.tolist() == list(range(begin + path * degree, end + path * degree))


def controls_of(n_cells: FloatArray, degree: int) -> FloatArray:
    total = int(np.sum(n_cells)) + degree * len(n_cells)
    return np.random.default_rng(4).normal(size=(total, 3))


@DEGREES
def test_curves_laid_end_to_end_are_curves_of_their_own(degree: int) -> None:
    n_cells = np.array([3, 1, 4])
    controls = controls_of(n_cells, degree)
    cells = first_controls(n_cells, degree)
    together = evaluate(controls, cells, FRACTIONS, degree, 1)
    assert together.shape == (8, 11, 3)
    for own, begin in zip(np.split(controls, starts_of(n_cells + degree)[1:-1]), starts_of(n_cells), strict=False):
        knots = np.arange(len(own) + degree + 1) - degree
        curve = BSpline(knots, own, degree).derivative()
        for cell in range(len(own) - degree):
            np.testing.assert_allclose(together[begin + cell, 1:-1], curve(cell + FRACTIONS[1:-1]), atol=1e-12)


def test_one_fraction_a_cell_is_the_diagonal_of_all_fractions() -> None:
    n_cells = np.array([5, 6])
    controls, cells = controls_of(n_cells, 5), first_controls(n_cells, 5)
    table = evaluate(controls, cells, FRACTIONS, 5, 2)
    single = evaluate_at(controls, cells, FRACTIONS, 5, 2)
    np.testing.assert_allclose(single, table[np.arange(11), np.arange(11)], atol=1e-12)


def test_interpolating_spline_is_the_not_a_knot_one() -> None:
    values = np.random.default_rng(3).normal(size=(12, 2))
    controls = interpolating(values)
    known = make_interp_spline(np.arange(12), values, k=5)
    sigma = np.linspace(0, 11, 200)
    cell = np.minimum(sigma.astype(np.int64), 10)
    np.testing.assert_allclose(evaluate_at(controls, cell, sigma - cell, 5), known(sigma), atol=1e-9)


@DEGREES
def test_a_subdivided_curve_is_the_same_curve_in_twice_the_cells(degree: int) -> None:
    n_cells = np.array([3, 1, 4])
    controls = controls_of(n_cells, degree)
    finer = subdivided(controls, n_cells, degree)
    assert finer.shape == (int((2 * n_cells + degree).sum()), 3)
    whole = evaluate(controls, first_controls(n_cells, degree), FRACTIONS / 2, degree)
    rest = evaluate(controls, first_controls(n_cells, degree), (1 + FRACTIONS) / 2, degree)
    halves = evaluate(finer, first_controls(2 * n_cells, degree), FRACTIONS, degree)
    np.testing.assert_allclose(halves[0::2], whole, atol=1e-12)
    np.testing.assert_allclose(halves[1::2], rest, atol=1e-12)
