"""Strokes in time: the motion that a timing gives, checked between the cell ends, laid on the sample grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.inverse_kinematics.joint_path import JointPaths
from planner.kinematics.limits import Limits
from planner.ragged import starts_of, within
from planner.spline import evaluate, first_controls
from planner.spline_paths import DEGREE
from planner.timing.length_bound import SLOW_ARM, require_bounded

_CHECKS_PER_CELL = 20
_CELLS_AT_ONCE = 2048
_FEW = 0.5 - 0.5 * np.cos(np.pi * np.arange(7) / 6)
"""Fractions of a cell that fix a polynomial of degree 6: Chebyshev's points, which lose no digits."""
_CHECKED = np.linspace(0.0, 1.0, _CHECKS_PER_CELL + 1)
_FROM_FEW = np.polynomial.chebyshev.chebvander(2 * _CHECKED - 1, 6) @ np.linalg.inv(
    np.polynomial.chebyshev.chebvander(2 * _FEW - 1, 6)
)
"""(n_checks, 7) values at the checks from those at the few."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_NEWTON_ROUNDS, _BISECTIONS = 8, 60
_EXACT = 1e-13
"""Fractions of a cell are found to so much: four rounds of Newton's method are usual, and bisection is sure."""
_NODES, _WEIGHTS = 0.5 * (_NODES + 1), 0.5 * _WEIGHTS


@dataclass(frozen=True, eq=False, slots=True)
class StrokeMotions:
    """Timed strokes, laid end to end, each lasting a whole number of sample periods.

    rates: (total cells, 4) polynomials of b = (dsigma/dt)^2 in each cell, lowest power of the fraction first;
    cell_s: (total cells,) duration of each cell; n_periods: (n_paths,) duration in sample periods.
    """

    paths: JointPaths
    rate_hz: float
    rates: FloatArray
    cell_s: FloatArray
    n_periods: IntArray

    def steps(self, late: float = 0.0) -> IntArray:
        """(n_paths,) steps from sample to sample of each stroke, with samples so late."""
        return self.n_periods + (late > 0.0)

    def samples(self, late: float = 0.0) -> list[FloatArray]:
        """(steps + 1, n_joints) positions of each stroke at its samples, both ends included. With late, a share of a
        period, all samples but the ends are so much later: what they would be had the stroke begun a little before."""
        return np.split(self.paths.at(*self.places(1, late)), np.cumsum(self.steps(late) + 1)[:-1])

    def places(self, per_step: int = 1, late: float = 0.0) -> tuple[IntArray, FloatArray]:
        """Cells, and fractions of them, (n,) in which all strokes are at so many equal parts of a step from sample to
        sample, both ends of each included."""
        starts = starts_of(self.paths.n_cells)
        counts = per_step * self.steps(late) + 1
        after = np.cumsum(self.cell_s)  # on one axis of time, stroke after stroke
        begins = after - self.cell_s
        begins_s, ends_s = begins[starts[:-1]], after[starts[1:] - 1]
        number = within(counts)
        periods = np.maximum(number / per_step - (1.0 - late if late else 0.0), 0.0)
        period_s = (ends_s - begins_s) / self.n_periods
        times = np.minimum(
            np.repeat(begins_s, counts) + periods * np.repeat(period_s, counts), np.repeat(ends_s, counts)
        )
        cell = np.clip(
            np.searchsorted(begins, times, side="right") - 1,
            np.repeat(starts[:-1], counts),
            np.repeat(starts[1:] - 1, counts),
        )
        fraction = _fraction_after(self.rates[cell], times - begins[cell], self.cell_s[cell])
        fraction[number == 0] = 0.0
        fraction[number == np.repeat(counts - 1, counts)] = 1.0
        return cell, fraction

    def subset(self, chosen: BoolArray) -> StrokeMotions:
        """Only the strokes of the mask (n_paths,)."""
        cells = np.repeat(chosen, self.paths.n_cells)
        return StrokeMotions(
            self.paths.subset(chosen), self.rate_hz, self.rates[cells], self.cell_s[cells], self.n_periods[chosen]
        )


def motions(paths: JointPaths, rates: FloatArray, limits: Limits, rate_hz: float) -> StrokeMotions:
    """Lay timed paths on the sample grid: each is slowed by the little that makes it last whole periods, and by
    what any limit is exceeded between the cell ends (slowing by k divides velocity by k, acceleration by
    k^2 and jerk by k^3). Errors: UsageError where that takes too long to be a plan."""
    n_cells = paths.n_cells
    slower = np.maximum.reduceat(_slowing_needed(paths, rates, limits), starts_of(n_cells)[:-1])
    slower = np.maximum(slower, 1.0)
    cell_s = _until(rates, np.ones(len(rates)))
    durations = np.add.reduceat(cell_s, starts_of(n_cells)[:-1])
    require_bounded(float((durations * slower).sum()), rate_hz, "the drawing", SLOW_ARM)
    n_periods = np.maximum(np.ceil(durations * slower * rate_hz - 1e-9).astype(np.int64), 1)
    slower = np.repeat(n_periods / rate_hz / durations, n_cells)
    return StrokeMotions(paths, rate_hz, rates / slower[:, None] ** 2, cell_s * slower, n_periods)


def _slowing_needed(paths: JointPaths, rates: FloatArray, limits: Limits) -> FloatArray:
    """(total cells,) factor by which each cell has to be slowed for all limits to hold throughout it.

    In a cell the acceleration, and the jerk divided by the rate, are polynomials of degrees 6 and 5: a few values
    of each give all others by one product of matrices. A peak between two checks, seen by samples at a high rate,
    is higher than the nearer of them by an eighth of the second difference at most, as of a parabola.
    """
    needed = np.empty(len(rates))
    first = first_controls(paths.n_cells, DEGREE)
    for begin in range(0, len(rates), _CELLS_AT_ONCE):
        cells = slice(begin, begin + _CELLS_AT_ONCE)
        q1, q2, q3 = (evaluate(paths.controls, first[cells], _FEW, DEGREE, k) for k in (1, 2, 3))
        b, slope, curvature = (rate[:, :, None] for rate in _rate_squared(rates[cells, None], _FEW))
        velocity = q1 / limits.velocity
        acceleration = (q2 * b + 0.5 * q1 * slope) / limits.acceleration
        jerk = (q3 * b + 1.5 * q2 * slope + 0.5 * q1 * curvature) / limits.jerk
        root = np.sqrt(_rate_squared(rates[cells, None], _CHECKED)[0])
        worst = _largest(velocity) * root
        np.maximum(worst, np.sqrt(_largest(acceleration)), out=worst)
        np.maximum(worst, np.cbrt(_largest(jerk) * root), out=worst)
        bend = np.maximum(-np.diff(worst, 2, axis=1), 0.0)
        needed[cells] = (worst + np.pad(bend, ((0, 0), (1, 1)), mode="edge") / 8).max(axis=1)
    return needed


def _largest(few: FloatArray) -> FloatArray:
    """(n_cells, n_checks) the largest joint's size at all checks of each cell, from values (n_cells, n_few, n_joints)
    of polynomials at a few fractions."""
    largest = np.zeros((len(few), len(_FROM_FEW)))
    for joint in range(few.shape[2]):
        np.maximum(largest, np.abs(few[:, :, joint] @ _FROM_FEW.T), out=largest)
    return largest


def _rate_squared(rates: FloatArray, fraction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """b, b' and b'' at fractions of cells: rates (..., 4), the rest of it and `fraction` broadcast."""
    c0, c1, c2, c3 = rates[..., 0], rates[..., 1], rates[..., 2], rates[..., 3]
    f = fraction
    return c0 + f * (c1 + f * (c2 + f * c3)), c1 + f * (2 * c2 + f * 3 * c3), 2 * c2 + 6 * c3 * f


def _until(rates: FloatArray, fraction: FloatArray) -> FloatArray:
    """(n,) time from the start of each cell to a fraction of it: the integral of 1 / sqrt(b)."""
    total = np.zeros(len(rates))
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        total += weight / np.sqrt(_rate_squared(rates, fraction * node)[0])
    time_s: FloatArray = total * fraction
    return time_s


def _fraction_after(rates: FloatArray, time_s: FloatArray, cell_s: FloatArray) -> FloatArray:
    """(n,) fraction of its cell that each motion has reached so long after entering it: by Newton's method, and by
    bisection where that does not get there."""
    fraction = np.clip(time_s / cell_s, 0.0, 1.0)
    moved = np.full(len(fraction), np.inf)
    for _ in range(_NEWTON_ROUNDS):
        change = (time_s - _until(rates, fraction)) * np.sqrt(_rate_squared(rates, fraction)[0])
        before, fraction = fraction, np.clip(fraction + change, 0.0, 1.0)
        moved = np.abs(fraction - before)
        if moved.max(initial=0.0) < _EXACT:
            return fraction
    open_ = moved >= _EXACT
    fraction[open_] = _bisected(rates[open_], time_s[open_])
    return fraction


def _bisected(rates: FloatArray, time_s: FloatArray) -> FloatArray:
    """(n,) fraction of its cell at which each motion is at a time: time grows along a cell."""
    low, high = np.zeros(len(rates)), np.ones(len(rates))
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        is_later = _until(rates, middle) < time_s
        low, high = np.where(is_later, middle, low), np.where(is_later, high, middle)
    fraction: FloatArray = 0.5 * (low + high)
    return fraction
