"""The play operator, and records cut down to what matters."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.error_model.lag import lagged
from planner.error_model.slack import Course


def followed(told: FloatArray, slack: float) -> FloatArray:
    stands, way = told[0], []
    for u in told:
        stands = min(max(stands, u - slack), u + slack)
        way.append(stands)
    return np.array(way)


steps = st.lists(st.sampled_from([-2.0, -1.0, -0.3, 0.0, 0.0, 0.2, 1.0, 3.0]), min_size=1, max_size=60)


@given(steps=steps, slack=st.floats(0.01, 3.0), seed=st.integers(0, 1000))
def test_turning_points_tell_where_a_joint_stands(steps: list[float], slack: float, seed: int) -> None:
    told = np.cumsum(steps)
    rows = np.random.default_rng(seed).integers(0, len(told), 5)
    course = Course.of(told, rows)
    positions, movers, sides = course.standing(told[course.turns], slack)
    np.testing.assert_allclose(positions, followed(told, slack)[rows], atol=1e-12)
    np.testing.assert_allclose(told[course.turns][movers] + sides * slack, positions, atol=1e-12)


@given(steps=steps, first=st.floats(0.01, 1.0), second=st.floats(0.01, 1.0))
def test_two_plays_in_a_row_are_one(steps: list[float], first: float, second: float) -> None:
    told = np.concatenate((np.zeros(1), np.cumsum(steps)))
    np.testing.assert_allclose(followed(followed(told, first), second), followed(told, first + second), atol=1e-9)


def test_a_lag_comes_near_by_a_part_of_e_in_its_time() -> None:
    told = np.ones((11, 1))
    told[0] = 0.0
    np.testing.assert_allclose(lagged(told, np.array([0.1]), 0.01)[-1], 1 - np.exp(-1.0))
    np.testing.assert_array_equal(lagged(told, np.array([0.0]), 0.01), told)
