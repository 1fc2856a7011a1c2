"""Joint splines: through their knots, at rest in sigma at both ends, and true to any linear coupling."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import JointPaths, interpolate
from planner.ragged import starts_of
from tests.arms.chains import random_configurations

CELLS = st.lists(st.integers(4, 12), min_size=1, max_size=4).map(np.array)
ENDS = np.array([0.0, 1.0])


def knots_of(n_cells: FloatArray, seed: int) -> FloatArray:
    return np.random.default_rng(seed).normal(size=(int(np.sum(n_cells)) + len(n_cells), 3))


def by_path(n_cells: FloatArray, knots: FloatArray) -> list[FloatArray]:
    return np.split(knots, starts_of(n_cells + 1)[1:-1])


@settings(deadline=None)
@given(n_cells=CELLS, seed=st.integers(0, 2**32 - 1))
def test_splines_meet_knots_and_rest_at_both_ends(n_cells: FloatArray, seed: int) -> None:
    knots = knots_of(n_cells, seed)
    paths = interpolate(n_cells, knots)
    value, slope, bend = (paths.positions(ENDS, derivative) for derivative in range(3))
    starts = starts_of(n_cells)
    for own, begin, end in zip(by_path(n_cells, knots), starts[:-1], starts[1:], strict=True):
        np.testing.assert_allclose(value[begin:end, 0], own[:-1], atol=1e-9)
        np.testing.assert_allclose(value[begin:end, 1], own[1:], atol=1e-9)
        for derivative in (slope, bend):
            np.testing.assert_allclose(derivative[begin, 0], 0, atol=1e-8)
            np.testing.assert_allclose(derivative[end - 1, 1], 0, atol=1e-8)


@settings(deadline=None)
@given(n_cells=CELLS, seed=st.integers(0, 2**32 - 1))
def test_no_derivative_up_to_the_fourth_jumps_at_a_knot(n_cells: FloatArray, seed: int) -> None:
    paths = interpolate(n_cells, knots_of(n_cells, seed))
    inner = np.setdiff1d(np.arange(1, n_cells.sum()), starts_of(n_cells))
    for derivative in range(5):
        values = paths.positions(ENDS, derivative)
        np.testing.assert_allclose(values[inner, 0], values[inner - 1, 1], atol=1e-7)


def test_derivatives_are_difference_quotients() -> None:
    n_cells = np.array([6])
    paths = interpolate(n_cells, knots_of(n_cells, 1))
    cells, at, step = np.arange(6), np.linspace(0.1, 0.9, 6), 1e-5
    for derivative in range(1, 4):
        slope = (paths.at(cells, at + step, derivative - 1) - paths.at(cells, at - step, derivative - 1)) / (2 * step)
        np.testing.assert_allclose(paths.at(cells, at, derivative), slope, atol=1e-6)


def test_couplings_hold_between_knots(arm: Arm) -> None:
    n_cells = np.array([5, 9])
    paths = interpolate(n_cells, arm.complete(random_configurations(arm, 1, 16)))
    fractions = np.linspace(0, 1, 21)
    np.testing.assert_allclose(paths.positions(fractions)[..., 1:].sum(axis=-1), -np.pi / 2, atol=1e-11)
    np.testing.assert_allclose(paths.positions(fractions, 1)[..., 1:].sum(axis=-1), 0, atol=1e-10)


def test_paths_laid_end_to_end_do_not_feel_each_other() -> None:
    n_cells = np.array([4, 7, 5])
    knots = knots_of(n_cells, 2)
    together = interpolate(n_cells, knots)
    alone = [interpolate(n_cells[k : k + 1], own).controls for k, own in enumerate(by_path(n_cells, knots))]
    np.testing.assert_allclose(together.controls, np.concatenate(alone), atol=1e-10)


def test_a_course_with_resting_ends_comes_back_to_sixth_order() -> None:
    """sin^3-like ends rest; halving the cells divides the error by about 2^6."""

    def error(cells: int) -> float:
        def positions_at(sigma: FloatArray) -> FloatArray:
            return np.sin(np.pi * sigma / cells) ** 4

        paths: JointPaths = interpolate(np.array([cells]), positions_at(np.arange(cells + 1.0))[:, None])
        fractions = np.linspace(0, 1, 9)
        wanted = positions_at(np.arange(cells)[:, None] + fractions)
        return float(np.abs(paths.positions(fractions)[..., 0] - wanted).max())

    assert error(20) / error(40) > 40
    assert error(40) < 1e-5


@settings(deadline=None)
@given(n_cells=CELLS, seed=st.integers(0, 2**32 - 1))
def test_a_subdivided_path_is_the_same_curve_in_twice_the_cells(n_cells: FloatArray, seed: int) -> None:
    paths = interpolate(n_cells, knots_of(n_cells, seed))
    finer = paths.subdivided()
    assert finer.n_cells.tolist() == (2 * paths.n_cells).tolist()
    fractions = np.linspace(0.0, 1.0, 5)
    for derivative in range(3):
        whole = paths.positions(fractions, derivative)
        halves = finer.positions(fractions, derivative).reshape(len(whole), 2, 5, -1)
        np.testing.assert_allclose(2**derivative * halves[:, 0, ::2], whole[:, :3], atol=1e-9)
        np.testing.assert_allclose(2**derivative * halves[:, 1, ::2], whole[:, 2:], atol=1e-9)
