"""A motion that keeps all limits with room to spare: where the interior-point method begins."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.ragged import starts_of
from planner.timing.discrete_problem import DiscreteProblem

_STEEPEST = 0.05
"""Slope of log b, per cell."""
_USED = 0.9
"""Share of the limit that is used where a path is closest to one."""
_APART = 1e3
"""Cells between one path and the next, as far as slopes are concerned: no path has its say on another."""


def feasible_start(problem: DiscreteProblem) -> FloatArray:
    """(n_unknowns,) the lower envelope of what each cell allows alone, of limited slope in log b, scaled until all
    limits hold."""
    layout = problem.layout
    lowest = problem.steady_b()
    largest = np.maximum.reduceat(np.where(np.isfinite(lowest), lowest, 0.0), layout.first_cell)
    lowest = np.where(np.isfinite(lowest), lowest, np.where(largest > 0, largest, 1.0)[layout.path_of_cell])
    n_knots = layout.n_cells + 1
    left_knot = layout.first_unknown // 2
    caps = np.full(int(n_knots.sum()), np.inf)
    for knot in (left_knot, left_knot + 1):
        caps[knot] = np.minimum(caps[knot], lowest)
    place = _APART * np.repeat(np.arange(layout.n_paths), n_knots) + np.arange(len(caps))
    level = np.log(caps)
    rise = np.minimum.accumulate(level - _STEEPEST * place) + _STEEPEST * place
    fall = np.minimum.accumulate((level + _STEEPEST * place)[::-1])[::-1] - _STEEPEST * place
    b = np.zeros(layout.n_unknowns)
    b[0::2] = np.exp(np.minimum(rise, fall))
    b[3:-1:2] = 0.5 * (b[4::2] - b[:-4:2])
    ends = starts_of(2 * n_knots)
    b[ends[:-1] + 1] = b[ends[1:] - 1] = 0.0
    return _scaled(problem, b)


def _scaled(problem: DiscreteProblem, b: FloatArray) -> FloatArray:
    """b times a factor for each path: velocity^2 and acceleration go with b, jerk^(2/3) as well."""
    motion = problem.motion(b)
    worst = np.maximum(
        (motion.b * problem.b_by_limit).max(axis=0), np.abs(motion.acceleration).max(axis=(0, 1), initial=0.0)
    )
    worst = np.maximum(worst, (np.abs(motion.jerk_per_rate).max(axis=1) * np.sqrt(motion.b)).max(axis=0) ** (2 / 3))
    factor = _USED / np.maximum.reduceat(worst, problem.layout.first_cell)
    scaled: FloatArray = b * factor[problem.layout.path_of_unknown]
    return scaled
