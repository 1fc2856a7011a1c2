"""Strokes in time: the motion that a timing gives, checked between the cell ends, laid on the sample grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.inverse_kinematics.joint_path import JointPaths
from planner.ragged import starts_of
from planner.timing.limits import Limits

_CHECKS_PER_CELL = 20
_CELLS_AT_ONCE = 8192
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_NODES, _WEIGHTS = 0.5 * (_NODES + 1), 0.5 * _WEIGHTS


@dataclass(frozen=True, eq=False, slots=True)
class StrokeMotions:
    """Timed strokes, laid end to end, each lasting a whole number of sample periods.

    three: (total cells, 3) coefficients of b = (dsigma/dt)^2 in each cell, the stretch applied;
    cell_s: (total cells,) duration of each cell; n_periods: (n_paths,) duration in sample periods.
    """

    paths: JointPaths
    rate_hz: float
    three: FloatArray
    cell_s: FloatArray
    n_periods: IntArray

    def sample(self, path: int) -> FloatArray:
        """(n_periods + 1, n_joints) positions of one stroke at its samples, both ends included."""
        starts = starts_of(self.paths.n_cells)
        first, last = int(starts[path]), int(starts[path + 1])
        n_periods = int(self.n_periods[path])
        begins = np.concatenate(([0.0], np.cumsum(self.cell_s[first:last])))
        times = np.arange(n_periods + 1) * (begins[-1] / n_periods)
        times[-1] = begins[-1]
        cell = np.clip(np.searchsorted(begins, times, side="right") - 1, 0, last - first - 1)
        fraction = _fraction_after(self.three[first + cell], times - begins[cell], self.cell_s[first + cell])
        return self.paths.at(first + cell, fraction)


def motions(paths: JointPaths, coefficients: FloatArray, limits: Limits, rate_hz: float) -> StrokeMotions:
    """Lay timed paths on the sample grid: each is slowed by the little that makes it last whole periods, and by
    what any limit is exceeded between the cell ends (slowing by k divides velocity by k, acceleration by
    k^2 and jerk by k^3)."""
    n_cells = paths.n_cells
    first = np.repeat(starts_of(n_cells + 2)[:-1] - starts_of(n_cells)[:-1], n_cells) + np.arange(int(n_cells.sum()))
    three = np.column_stack([coefficients[first + k] for k in range(3)])
    slower = np.maximum.reduceat(_slowing_needed(paths, three, limits), starts_of(n_cells)[:-1])
    durations = np.add.reduceat(_until(three, np.ones(len(three))), starts_of(n_cells)[:-1]) * np.maximum(slower, 1.0)
    n_periods = np.maximum(np.ceil(durations * rate_hz - 1e-9).astype(np.int64), 1)
    slower = np.maximum(slower, 1.0) * (n_periods / rate_hz) / durations
    three = three / np.repeat(slower, n_cells)[:, None] ** 2
    return StrokeMotions(paths, rate_hz, three, _until(three, np.ones(len(three))), n_periods)


def _slowing_needed(paths: JointPaths, three: FloatArray, limits: Limits) -> FloatArray:
    """(total cells,) factor by which each cell has to be slowed for all limits to hold throughout it."""
    fractions = np.linspace(0.0, 1.0, _CHECKS_PER_CELL + 1)
    needed = np.empty(len(three))
    for begin in range(0, len(three), _CELLS_AT_ONCE):
        cells = np.arange(begin, min(begin + _CELLS_AT_ONCE, len(three)))
        worst = np.zeros(len(cells))
        for fraction in fractions:
            q1, q2, q3 = (paths.at(cells, np.full(len(cells), fraction), k) for k in (1, 2, 3))
            b, slope, bend = _rate_squared(three[cells], np.full(len(cells), fraction))
            root = np.sqrt(b)[:, None]
            b, slope, bend = b[:, None], slope[:, None], bend[:, None]
            velocity = np.abs(q1 * root / limits.velocity).max(axis=1)
            acceleration = np.abs((q2 * b + 0.5 * q1 * slope) / limits.acceleration).max(axis=1)
            jerk = np.abs((q3 * b + 1.5 * q2 * slope + 0.5 * q1 * bend) * root / limits.jerk).max(axis=1)
            worst = np.maximum(worst, np.maximum(velocity, np.maximum(np.sqrt(acceleration), np.cbrt(jerk))))
        needed[cells] = worst
    return needed


def _rate_squared(three: FloatArray, fraction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """b, b' and b'' (n,) at one fraction of each cell."""
    c0, c1, c2 = three.T
    f = fraction
    b = 0.5 * c0 * (1 - f) ** 2 + c1 * (0.5 + f - f * f) + 0.5 * c2 * f * f
    return b, -c0 * (1 - f) + c1 * (1 - 2 * f) + c2 * f, c0 - 2 * c1 + c2


def _until(three: FloatArray, fraction: FloatArray) -> FloatArray:
    """(n,) time from the start of each cell to a fraction of it: the integral of 1 / sqrt(b)."""
    total = np.zeros(len(three))
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        total += weight / np.sqrt(_rate_squared(three, fraction * node)[0])
    time_s: FloatArray = total * fraction
    return time_s


def _fraction_after(three: FloatArray, time_s: FloatArray, cell_s: FloatArray) -> FloatArray:
    """(n,) fraction of its cell that each motion has reached so long after entering it (Newton's method)."""
    fraction = np.clip(time_s / cell_s, 0.0, 1.0)
    for _ in range(8):
        change = (time_s - _until(three, fraction)) * np.sqrt(_rate_squared(three, fraction)[0])
        fraction = np.clip(fraction + change, 0.0, 1.0)
        if np.abs(change).max(initial=0.0) < 1e-13:
            break
    return fraction
