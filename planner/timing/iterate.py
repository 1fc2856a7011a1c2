"""One point of the interior-point iteration: unknowns, slacks, multipliers, and what they amount to for each path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.timing.discrete_problem import DiscreteProblem
from planner.timing.per_limit import PerLimit, per_limit

_START_GAP = 2.0
"""The barrier at the start, in shares of the time. A smaller one lets slacks run dry far from the optimum: steps then
stay short, and the gap closes before the gradient does."""


@dataclass(frozen=True, eq=False, slots=True)
class Iterate:
    """One point of the iteration, strictly within all limits.

    b: (n_unknowns,); b_at_points: (5, cells); allowed: (5, n_joints, cells) share of the jerk limits that is allowed at
    the points. For each path (n_paths,) time_s, gap: the mean product of slack and multiplier; step: the share of
    Newton's step that led here; stuck: whether there is no way on from here.
    """

    b: FloatArray
    b_at_points: FloatArray
    slacks: PerLimit
    multipliers: PerLimit
    allowed: FloatArray
    time_s: FloatArray
    gap: FloatArray
    step: FloatArray
    stuck: BoolArray

    def is_near(self, problem: DiscreteProblem, share: float) -> BoolArray:
        """(n_paths,) where the barrier can still cost no more than that share of the time."""
        near: BoolArray = self.gap * problem.n_limits <= share * self.time_s
        return near

    def subset(self, problem: DiscreteProblem, paths: BoolArray) -> Iterate:
        """Only the paths of the mask (n_paths,) of the problem."""
        cells = paths[problem.layout.path_of_cell]
        return Iterate(
            self.b[paths[problem.layout.path_of_unknown]],
            self.b_at_points[:, cells],
            self.slacks.of_cells(cells),
            self.multipliers.of_cells(cells),
            self.allowed[..., cells],
            self.time_s[paths],
            self.gap[paths],
            self.step[paths],
            self.stuck[paths],
        )


def first_iterate(problem: DiscreteProblem, b: FloatArray) -> Iterate:
    """At unknowns (n_unknowns,) that keep all limits, with the same product of slack and multiplier everywhere."""
    motion = problem.motion(b)
    allowed = np.ones_like(motion.jerk_per_rate)
    slacks = problem.slacks(motion, allowed)
    time_s = problem.times_s(motion.b)
    mu = (_START_GAP * time_s / problem.n_limits)[problem.layout.path_of_cell]
    multipliers = per_limit(lambda slack: mu / slack, slacks)
    n_paths = problem.layout.n_paths
    return Iterate(
        b,
        motion.b,
        slacks,
        multipliers,
        allowed,
        time_s,
        mean_gap(problem, slacks, multipliers),
        np.ones(n_paths),
        np.zeros(n_paths, dtype=bool),
    )


def mean_gap(problem: DiscreteProblem, slacks: PerLimit, multipliers: PerLimit) -> FloatArray:
    """(n_paths,) mean product of slack and multiplier: what the barrier is for at its optimum."""
    products = per_limit(np.multiply, multipliers, slacks)
    gap: FloatArray = problem.layout.total(products) / problem.n_limits
    return gap
