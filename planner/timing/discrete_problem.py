"""The timing problem in finitely many numbers: limits at points of cells, linear forms of the unknowns of b.

Arrays have the cells on their last axis, so that sums over joints and points run along memory.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.timing.cell_cubics import BOOLE, VALUE_FORMS, linear_form
from planner.timing.cell_layout import PAIRS, CellLayout
from planner.timing.per_limit import PerLimit
from planner.timing.timing_problem import FRACTIONS, TimingProblem

_ACCELERATION_POINTS = (0, 2)
"""Those at which acceleration limits are imposed; the right end is the left end of the next cell, or at rest."""


@dataclass(frozen=True, eq=False, slots=True)
class CellMotion:
    """What unknowns amount to; linear in them, so this may be a change as well.

    b: (5, cells) at the points; acceleration: (2, n joints that can reach their limit, cells) at left ends and middles;
    jerk_per_rate: (5, n_joints, cells) at the points, jerk / sqrt(b). Both are in units of their limits.
    """

    b: FloatArray
    acceleration: FloatArray
    jerk_per_rate: FloatArray


class DiscreteProblem:
    """Paths to be timed, with their limits as linear forms of the unknowns.

    b_by_limit: (5, cells) what b is multiplied by to be in units of its greatest; acceleration: (4, 2, n joints that
    can reach that limit, cells) and jerk: (4, 5, n_joints, cells) factors of the four unknowns of a cell;
    acceleration_pairs, jerk_pairs: (10, ...) their products, by PAIRS; n_limits: (n_paths,) limits of each path.
    """

    def __init__(self, problem: TimingProblem) -> None:
        p = self.problem = problem
        self.layout = CellLayout(problem.n_cells)
        self.b_by_limit = problem.rate_limit**-2.0
        self.acceleration = np.stack(
            [
                linear_form(FRACTIONS[k], p.second_by_acceleration[k], 0.5 * p.first_by_acceleration[k], 0.0)
                for k in _ACCELERATION_POINTS
            ],
            axis=1,
        )
        self.jerk = np.stack(
            [
                linear_form(fraction, p.third_by_jerk[k], 1.5 * p.second_by_jerk[k], 0.5 * p.first_by_jerk[k])
                for k, fraction in enumerate(FRACTIONS)
            ],
            axis=1,
        )
        self.acceleration_pairs, self.jerk_pairs = (
            form[PAIRS[0]] * form[PAIRS[1]] for form in (self.acceleration, self.jerk)
        )
        per_cell = len(FRACTIONS) + 2 * sum(form[0, ..., 0].size for form in (self.acceleration, self.jerk))
        self.n_limits = problem.n_cells * per_cell

    def subset(self, paths: BoolArray) -> DiscreteProblem:
        """Only the paths of the mask (n_paths,)."""
        return DiscreteProblem(self.problem.subset(paths))

    def steady_b(self) -> FloatArray:
        """(cells,) the greatest b that each cell allows if it stays the same throughout."""
        p = self.problem
        with np.errstate(divide="ignore"):
            greatest = np.minimum(
                p.rate_limit.min(axis=0) ** 2, 1 / np.abs(p.second_by_acceleration).max(axis=(0, 1), initial=0.0)
            )
            least: FloatArray = np.minimum(greatest, np.abs(p.third_by_jerk).max(axis=(0, 1)) ** (-2 / 3))
        return least

    def motion(self, b: FloatArray) -> CellMotion:
        """What the unknowns (n_unknowns,), or a change of them, amount to."""
        four = self.layout.unknowns_of_cells(b)
        acceleration, jerk = self.acceleration[0] * four[0], self.jerk[0] * four[0]
        for k in range(1, 4):
            acceleration += self.acceleration[k] * four[k]
            jerk += self.jerk[k] * four[k]
        return CellMotion(VALUE_FORMS @ four, acceleration, jerk)

    def slacks(self, motion: CellMotion, allowed: FloatArray) -> PerLimit:
        """Distances to the limits, positive where they are kept; allowed: (5, n_joints, cells) shares of the jerk
        limits."""
        a, jerk = motion.acceleration, motion.jerk_per_rate
        most = allowed * (1.0 / np.sqrt(motion.b))[:, None]
        return PerLimit(1.0 - motion.b * self.b_by_limit, 1.0 - a, 1.0 + a, most - jerk, most + jerk)

    def slack_changes(self, change: CellMotion, d_most_jerk: FloatArray) -> PerLimit:
        """Of the linearised slacks, for a change of the motion and (5, n_joints, cells) of what jerk / sqrt(b) may
        be."""
        a, jerk = change.acceleration, change.jerk_per_rate
        return PerLimit(-change.b * self.b_by_limit, -a, a, d_most_jerk - jerk, d_most_jerk + jerk)

    def times_s(self, b: FloatArray) -> FloatArray:
        """(n_paths,) from b (5, cells) at the points."""
        return self.layout.total([BOOLE[:, None] / np.sqrt(b)])
