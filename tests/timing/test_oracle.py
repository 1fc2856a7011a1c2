"""The planner's timing beside independent ones: sequential linear programs, Ruckig along sigma, a constant rate."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import JointPaths
from planner.kinematics.limits import Limits
from planner.travel.ruckig_profile import rest_to_rest
from tests.timing.rig import LIMITS, joint_curve, polar_paths, rate_curve, rates_by_formula, timed
from tests.timing.slp import least_time_s

FINE_HZ = 1e5
_FINER = 4
"""Cells of the linear programs for each of the planner's."""
CAP = 150.0
"""On dsigma/dt, below what the joints' limits allow on straight parts."""
SHORT = {
    "straight": np.array([[60.0, -10.0], [85.0, 15.0]]),
    "corner": np.array([[80.0, 0.0], [92.0, 0.0], [92.0, 9.0]]),
    "reversal": np.array([[80.0, 10.0], [90.0, 11.0], [79.0, 10.5]]),
}

places = st.tuples(st.floats(50, 130), st.floats(-60, 60)).map(lambda place: tuple(round(value, 3) for value in place))
near_places = st.tuples(st.integers(80, 92), st.integers(-6, 6)).map(lambda place: (float(place[0]), float(place[1])))


def lines_through(points: st.SearchStrategy[tuple[float, float]], most: int) -> st.SearchStrategy[FloatArray]:
    return (
        st.lists(points, min_size=2, max_size=most, unique=True)
        .map(np.array)
        .filter(lambda line: np.hypot(*np.diff(line, axis=0).T).min() > 1e-3)
    )


lines_made, short_lines = lines_through(places, 5), lines_through(near_places, 3)
limits_made = st.builds(
    lambda velocity, acceleration_s, jerk_s: Limits(
        *(
            np.array([4.0, 6.0]) * factor
            for factor in (velocity, velocity * acceleration_s, velocity * acceleration_s * jerk_s)
        )
    ),
    st.floats(0.3, 3.0),
    st.floats(5.0, 30.0),
    st.floats(10.0, 60.0),
)


def as_timed(line: FloatArray) -> JointPaths:
    """The joint path of a line with its cells cut in two, as the planner times it."""
    return polar_paths([line]).subdivided()


def least_s(paths: JointPaths, limits: Limits, cap: float = np.inf) -> float:
    curve = joint_curve(paths, 0)
    return least_time_s(
        lambda sigma, order: curve.derivative(order)(sigma),
        int(paths.n_cells[0]),
        limits,
        lambda sigma: np.full(len(sigma), cap),
        _FINER,
    )


def taken_s(paths: JointPaths, limits: Limits, cap: float = np.inf) -> float:
    return float(timed(paths, limits, FINE_HZ, cap).n_periods[0]) / FINE_HZ


def steady_s(curve: BSpline[np.float64], n_cells: int, limits: Limits) -> float:
    """Duration at the greatest constant rate of sigma."""
    sigma = np.linspace(0, n_cells, 20 * n_cells + 1)
    rates = [
        (limit / np.maximum(np.abs(curve.derivative(order)(sigma)), 1e-12)).min() ** (1 / order)
        for order, limit in enumerate((limits.velocity, limits.acceleration, limits.jerk), 1)
    ]
    return n_cells / float(min(rates))


def ruckig_s(curve: BSpline[np.float64], n_cells: int, limits: Limits) -> float:
    """Duration of the fastest of some rest-to-rest moves of sigma whose limits suit the worst point of the path.

    |q''| v^2 + |q'| a and |q'''| v^3 + 3 |q''| v a + |q'| j are then within the limits wherever sigma moves with at
    most v, a and j.
    """
    sigma = np.linspace(0, n_cells, 20 * n_cells + 1)
    q1, q2, q3 = (np.maximum(np.abs(curve.derivative(order)(sigma)), 1e-12) for order in (1, 2, 3))
    times = []
    for share in (0.5, 0.7, 0.85, 0.95):
        velocity = share * n_cells / steady_s(curve, n_cells, limits)
        room = limits.jerk - q3 * velocity**3
        acceleration = min(
            float(((limits.acceleration - q2 * velocity**2) / q1).min()),
            0.5 * float((room / (3 * q2 * velocity)).min()),
        )
        jerk = float(((room - 3 * q2 * velocity * acceleration) / q1).min())
        times.append(rest_to_rest(n_cells, velocity, acceleration, jerk).duration_s)
    return min(times)


@pytest.mark.parametrize(("name", "cap"), [("straight", CAP), ("corner", np.inf), ("reversal", np.inf)])
def test_within_a_hundredth_of_the_least_time_by_linear_programs(name: str, cap: float) -> None:
    paths = as_timed(SHORT[name])
    least = least_s(paths, LIMITS, cap)
    # The programs' b has a constant second derivative in each cell, the planner's a linear one: it may do better.
    assert 0.98 * least <= taken_s(paths, LIMITS, cap) <= 1.01 * least


def test_the_linear_programs_find_the_known_least_time() -> None:
    """One joint on a straight line, in three phases of jerk with the greatest acceleration and speed between."""
    limits = Limits(np.array([1e3, 30.0]), np.array([1e6, 400.0]), np.array([1e9, 20000.0]))
    paths = as_timed(np.array([[50.0, 0.0], [130.0, 0.0]]))
    known = rest_to_rest(8.0, 30.0, 400.0, 20000.0).duration_s
    assert 0.999 * known <= least_s(paths, limits) <= 1.003 * known


@settings(deadline=None, max_examples=4)
@given(short_lines)
def test_near_the_least_time_on_any_short_line(line: FloatArray) -> None:
    paths = as_timed(line)
    least = least_s(paths, LIMITS)
    assert 0.95 * least <= taken_s(paths, LIMITS) <= 1.05 * least


@settings(deadline=None, max_examples=12)
@given(lines_made, limits_made)
def test_no_limit_is_broken_whatever_the_limits(line: FloatArray, limits: Limits) -> None:
    paths = as_timed(line)
    motion = timed(paths, limits)
    n_cells = int(paths.n_cells[0])
    within = (np.arange(n_cells)[:, None] + np.linspace(1e-9, 1 - 1e-9, 21)).ravel()
    rates = rates_by_formula(joint_curve(paths, 0), rate_curve(motion, 0), within)
    for rate, limit in zip(rates, (limits.velocity, limits.acceleration, limits.jerk), strict=True):
        assert (np.abs(rate) / limit).max() <= 1 + 1e-6


@settings(deadline=None, max_examples=12)
@given(lines_made, limits_made)
def test_never_slower_than_ruckig_along_sigma_or_a_constant_rate(line: FloatArray, limits: Limits) -> None:
    paths = as_timed(line)
    curve, n_cells = joint_curve(paths, 0), int(paths.n_cells[0])
    taken = taken_s(paths, limits)
    assert taken <= ruckig_s(curve, n_cells, limits)
    assert taken <= steady_s(curve, n_cells, limits)
