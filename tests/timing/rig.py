"""Joint paths of known form, and motions looked at with other means than the planner's own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import BSpline, PPoly

from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import JointPaths, interpolate
from planner.kinematics.limits import Limits
from planner.motion.stroke_motion import StrokeMotions, motions
from planner.placement.pen_path import smooth_paths
from planner.spline_paths import DEGREE
from planner.timing.path_timing import minimum_time
from planner.timing.timing_problem import FRACTIONS, TimingProblem

LIMITS = Limits(np.array([4.0, 6.0]), np.array([60.0, 80.0]), np.array([1500.0, 1200.0]))
"""Of a joint that turns (rad) and one that slides (cm), so that both have their say."""

LINES = {
    "straight": np.array([[60.0, -40.0], [110.0, 50.0]]),
    "corner": np.array([[70.0, 0.0], [100.0, 0.0], [100.0, 40.0]]),
    "reversal": np.array([[60.0, 10.0], [90.0, 12.0], [65.0, 10.5]]),
    "hair": np.array([[80.0, 0.0], [80.01, 0.0]]),
    "bend": np.column_stack((90 + 30 * np.cos(np.linspace(0, 4, 200)), 30 * np.sin(np.linspace(0, 4, 200)))),
}


def polar_paths(lines: list[FloatArray]) -> JointPaths:
    """Joint paths of a turning and a sliding joint that draw the lines (mm): azimuth in rad and radius in cm."""
    pen = smooth_paths(lines, 0.0225)
    corners = pen.positions(np.array([0.0, 1.0]))
    ends = np.cumsum(pen.n_cells)
    x, y = np.insert(corners[:, 0], ends, corners[ends - 1, 1], axis=0).T
    return interpolate(pen.n_cells, np.column_stack((np.arctan2(y, x), np.hypot(x, y) / 10)))


def problem_of(paths: JointPaths, limits: Limits = LIMITS, rate_limit: float = np.inf) -> TimingProblem:
    derivatives = (paths.positions(FRACTIONS, 1), paths.positions(FRACTIONS, 2), paths.positions(FRACTIONS, 3))
    return TimingProblem.of(
        paths.n_cells, derivatives, limits, np.full((int(paths.n_cells.sum()), len(FRACTIONS)), rate_limit)
    )


def timed(
    paths: JointPaths, limits: Limits = LIMITS, rate_hz: float = 100.0, rate_limit: float = np.inf
) -> StrokeMotions:
    return motions(paths, minimum_time(problem_of(paths, limits, rate_limit)).rates, limits, rate_hz)


def seen_often(motion: StrokeMotions, times: int) -> StrokeMotions:
    """The same motion with so many times the samples."""
    return replace(motion, rate_hz=motion.rate_hz * times, n_periods=motion.n_periods * times)


def joint_curve(paths: JointPaths, index: int) -> BSpline[np.float64]:
    """One joint path as SciPy's spline over sigma."""
    first = int((paths.n_cells[:index] + DEGREE).sum())
    n_cells = int(paths.n_cells[index])
    return BSpline(
        np.arange(-DEGREE, n_cells + DEGREE + 1, dtype=np.float64),
        paths.controls[first : first + n_cells + DEGREE],
        DEGREE,
    )


def rate_curve(motion: StrokeMotions, index: int) -> PPoly:
    """(dsigma/dt)^2 of one stroke as SciPy's piecewise polynomial over sigma."""
    first, n_cells = int(motion.paths.n_cells[:index].sum()), int(motion.paths.n_cells[index])
    return rates_over_sigma(motion.rates[first : first + n_cells])


def rates_over_sigma(rates: FloatArray) -> PPoly:
    """Cubics (n_cells, 4) of the fraction, lowest power first, as one function of sigma."""
    return PPoly(rates.T[::-1], np.arange(len(rates) + 1, dtype=np.float64))


def duration_s(rate: PPoly, n_cells: int, per_cell: int = 400) -> float:
    """The integral of 1 / sqrt(b) over sigma, by midpoints."""
    sigma = (np.arange(n_cells * per_cell) + 0.5) / per_cell
    return float((1 / np.sqrt(rate(sigma))).sum() / per_cell)


def rates_by_formula(
    curve: BSpline[np.float64], rate: PPoly, sigma: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Joint velocity, acceleration and jerk (n, n_joints) by the chain rule, off the knots."""
    q1, q2, q3 = (curve.derivative(order)(sigma) for order in (1, 2, 3))
    b, slope, bend = (rate(sigma)[:, None], rate.derivative(1)(sigma)[:, None], rate.derivative(2)(sigma)[:, None])
    return (q1 * np.sqrt(b), q2 * b + q1 * slope / 2, (q3 * b + 1.5 * q2 * slope + 0.5 * q1 * bend) * np.sqrt(b))


def share_of_limits(samples: FloatArray, period_s: float, limits: Limits = LIMITS) -> FloatArray:
    """(3,) largest share of the velocity, acceleration and jerk limits, by differences of samples."""
    return np.array(
        [
            (np.abs(np.diff(samples, order, axis=0)) / period_s**order / limit).max(initial=0.0)
            for order, limit in enumerate((limits.velocity, limits.acceleration, limits.jerk), 1)
        ]
    )
