"""Timed paths keep every limit throughout, come close to the least time, and do not depend on one another."""

from __future__ import annotations

from itertools import pairwise

import casadi
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import JointPaths
from planner.kinematics.limits import Limits
from planner.motion.stroke_motion import motions
from planner.timing.path_timing import minimum_time
from planner.travel.ruckig_profile import rest_to_rest
from tests.timing.rig import (
    LIMITS,
    LINES,
    duration_s,
    joint_curve,
    polar_paths,
    problem_of,
    rate_curve,
    rates_by_formula,
    rates_over_sigma,
    seen_often,
    share_of_limits,
    timed,
)

FINE_HZ = 1e5

places = st.tuples(st.floats(50, 130), st.floats(-60, 60)).map(lambda place: tuple(round(value, 3) for value in place))
lines_made = (
    st.lists(places, min_size=2, max_size=6, unique=True)
    .map(np.array)
    .filter(lambda line: np.hypot(*np.diff(line, axis=0).T).min() > 1e-3)
)


def steady_s(paths: JointPaths, limits: Limits) -> float:
    """Duration of the fastest motion of a single path with sigma at a constant rate."""
    n_cells = int(paths.n_cells[0])
    curve, sigma = joint_curve(paths, 0), np.linspace(0, n_cells, 20 * n_cells + 1)
    rates = [
        (limit / np.maximum(np.abs(curve.derivative(order)(sigma)), 1e-12)).min() ** (1 / order)
        for order, limit in enumerate((limits.velocity, limits.acceleration, limits.jerk), 1)
    ]
    return n_cells / float(min(rates))


@pytest.mark.parametrize("name", LINES)
def test_limits_hold_at_twenty_points_of_every_cell(name: str) -> None:
    paths = polar_paths([LINES[name]])
    motion = timed(paths)
    n_cells = int(paths.n_cells[0])
    within = (np.arange(n_cells)[:, None] + np.linspace(1e-9, 1 - 1e-9, 21)).ravel()
    rates = rates_by_formula(joint_curve(paths, 0), rate_curve(motion, 0), within)
    for rate, limit in zip(rates, (LIMITS.velocity, LIMITS.acceleration, LIMITS.jerk), strict=True):
        assert (np.abs(rate) / limit).max() <= 1 + 1e-6


@settings(deadline=None, max_examples=15)
@given(lines_made)
def test_limits_hold_between_the_samples(line: FloatArray) -> None:
    """By differences of positions, at the rate of the samples and at ten times that."""
    motion = timed(polar_paths([line]))
    for times in (1, 10):
        samples = seen_often(motion, times).samples()[0]
        assert (share_of_limits(samples, 0.01 / times) <= 1.002).all()


@settings(deadline=None, max_examples=15)
@given(lines_made)
def test_samples_begin_and_end_at_rest_at_the_ends_of_the_path(line: FloatArray) -> None:
    paths = polar_paths([line])
    motion = timed(paths)
    samples = motion.samples()[0]
    curve = joint_curve(paths, 0)
    assert len(samples) == motion.n_periods[0] + 1
    np.testing.assert_allclose(samples[[0, -1]], curve([0.0, float(paths.n_cells[0])]), atol=1e-12)
    # The least that rest allows: from it, a constant jerk gets a joint no further than J t^3 / 6.
    assert (np.abs(samples[[1, -2]] - samples[[0, -1]]) <= LIMITS.jerk * 0.01**3 / 6 * 1.001).all()


@settings(deadline=None, max_examples=15)
@given(lines_made)
def test_no_slower_than_at_a_constant_rate(line: FloatArray) -> None:
    paths = polar_paths([line])
    motion = timed(paths, rate_hz=FINE_HZ)
    assert motion.n_periods[0] / FINE_HZ <= steady_s(paths, LIMITS)


def test_a_stroke_is_timed_as_if_it_were_alone() -> None:
    paths = polar_paths(list(LINES.values()))
    together = minimum_time(problem_of(paths)).rates
    begins = np.concatenate(([0], np.cumsum(paths.n_cells)))
    for line, (first, last) in zip(LINES.values(), pairwise(begins.tolist()), strict=True):
        alone = minimum_time(problem_of(polar_paths([line]))).rates
        assert len(alone) == last - first
        # Its motion may differ in places that hardly matter; its time does not.
        powers = np.linspace(0.0, 1.0, 21) ** np.arange(4)[:, None]
        times_s = [float((1 / np.sqrt(rates @ powers)).mean(axis=1).sum()) for rates in (together[first:last], alone)]
        assert times_s[0] == pytest.approx(times_s[1], rel=2e-3)


def test_the_cap_on_the_rate_is_kept() -> None:
    paths = polar_paths([LINES["bend"]])
    independent, capped = timed(paths), timed(paths, rate_limit=20.0)
    knots = np.arange(int(paths.n_cells[0]) + 1)
    assert rate_curve(independent, 0)(knots).max() > 1.5 * 20.0**2
    assert rate_curve(capped, 0)(knots[:-1]).max() <= 20.0**2


@pytest.mark.parametrize(("distance_mm", "velocity", "most"), [(80.0, 30.0, 1.02), (40.0, 1e3, 1.02), (3.0, 1e3, 1.06)])
def test_one_joint_on_a_straight_line_is_nearly_as_fast_as_its_limits_allow(
    distance_mm: float, velocity: float, most: float
) -> None:
    """Against the jerk-limited move from rest to rest, which is known: with and without a phase of full speed. The
    shorter the line, the fewer cells there are to shape the motion with."""
    limits = Limits(np.array([1e3, velocity]), np.array([1e6, 400.0]), np.array([1e9, 20000.0]))
    paths = polar_paths([np.array([[50.0, 0.0], [50.0 + distance_mm, 0.0]])])
    least = rest_to_rest(distance_mm / 10, velocity, 400.0, 20000.0).duration_s
    taken = timed(paths, limits, FINE_HZ).n_periods[0] / FINE_HZ
    assert least * (1 - 1e-6) <= taken <= most * least


def least_time(paths: JointPaths, limits: Limits) -> float:
    """The least time with b a cubic in each cell, value and slope shared, stated with SciPy's splines (double knots)
    and solved by Ipopt."""
    n_cells = int(paths.n_cells[0])
    curve = joint_curve(paths, 0)
    knots = np.concatenate(([0.0, 0.0], np.repeat(np.arange(n_cells + 1), 2), [n_cells, n_cells]))
    unknown = casadi.SX.sym("b", 2 * n_cells + 2)
    splines = BSpline(knots, np.eye(2 * n_cells + 2), 3)

    def at(sigma: FloatArray, order: int) -> casadi.SX:
        basis = splines.derivative(order) if order else splines
        return casadi.sparsify(casadi.SX(basis(sigma))) @ unknown

    constraints, low, high = [], [], []

    def within(expression: casadi.SX, least: float, most: float) -> None:
        constraints.append(expression)
        low.append(np.full(n_cells, least))
        high.append(np.full(n_cells, most))

    start = 0.5 * (n_cells / steady_s(paths, limits)) ** 2
    for share in (1e-9, 0.25, 0.5, 0.75, 1 - 1e-9):
        sigma = np.arange(n_cells) + share
        b, slope, bend = (at(sigma, order) for order in range(3))
        within(b, 1e-3 * start, np.inf)
        for joint in range(len(limits.velocity)):
            q1, q2, q3 = (curve.derivative(order)(sigma)[:, joint] for order in (1, 2, 3))
            within((q3 * b + 1.5 * q2 * slope + 0.5 * q1 * bend) * casadi.sqrt(b) / limits.jerk[joint], -1, 1)
            if share < 0.1:
                within(q1**2 * b / limits.velocity[joint] ** 2, 0, 1)
                within((q2 * b + q1 * slope / 2) / limits.acceleration[joint], -1, 1)
    nodes, node_weights = np.polynomial.legendre.leggauss(6)
    time = sum(
        casadi.sum1(weight / 2 / casadi.sqrt(at(np.arange(n_cells) + (node + 1) / 2, 0)))
        for node, weight in zip(nodes, node_weights, strict=True)
    )
    solver = casadi.nlpsol(
        "time",
        "ipopt",
        {"x": unknown, "f": time, "g": casadi.vertcat(*constraints)},
        {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False, "ipopt.tol": 1e-6},
    )
    solution = solver(x0=start, lbg=np.concatenate(low), ubg=np.concatenate(high))
    assert solver.stats()["success"]
    return float(solution["f"])


@pytest.mark.parametrize("name", LINES)
def test_the_optimum_is_found(name: str) -> None:
    paths = polar_paths([LINES[name]])
    best = least_time(paths, LIMITS)
    found = duration_s(rates_over_sigma(minimum_time(problem_of(paths)).rates), int(paths.n_cells[0]))
    assert 0.998 * best <= found <= 1.003 * best


def test_motions_slow_a_path_that_is_too_fast_and_fill_whole_periods() -> None:
    """Coefficients twice and a half too fast are put right; those with room to spare are not hurried."""
    paths = polar_paths([LINES["bend"]])
    coefficients = minimum_time(problem_of(paths)).rates
    fast, slow = 6.25 * coefficients, coefficients / 6.25
    best, hasty, easy = (motions(paths, b, LIMITS, 100.0) for b in (coefficients, fast, slow))
    assert (share_of_limits(seen_often(hasty, 10).samples()[0], 0.001) <= 1.002).all()
    assert abs(int(hasty.n_periods[0]) - int(best.n_periods[0])) <= 1
    assert int(easy.n_periods[0]) >= 2.4 * int(best.n_periods[0])
    for motion in (best, hasty, easy):
        np.testing.assert_allclose(motion.cell_s.sum(), motion.n_periods[0] / 100.0, rtol=1e-9)
