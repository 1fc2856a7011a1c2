"""One Newton step after the other towards the least time: a primal-dual interior-point method for many paths at once.

Every iterate is strictly feasible: what is returned keeps the limits at the points even if the iteration stops early.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.timing.discrete_problem import CellMotion, DiscreteProblem
from planner.timing.iterate import Iterate, mean_gap
from planner.timing.lowered_limits import lowered_limits
from planner.timing.newton_system import newton_direction, newton_system
from planner.timing.per_limit import per_limit

_BOUNDARY = 0.98
"""Share of the way to the nearest limit that a step may go."""
_CENTRING, _MOST_CENTRING = 0.2, 0.9
"""Factors of the barrier with every step: the nearer to the second, the shorter the step before had to be. Smaller ones
let slacks run dry far from the optimum."""
_SHORTENED = 0.6
_MOST_SHORTENED = 30
"""A step that breaks a limit is shortened by that factor, and given up after so many times."""
_KEPT_AT_LEAST = 0.1 * (1 - _BOUNDARY)
"""Share of a jerk limit's slack that a step has to leave."""


def next_iterate(problem: DiscreteProblem, at: Iterate, alive: BoolArray) -> Iterate:
    """One primal-dual Newton step of the paths of the mask (n_paths,); each takes the largest step that keeps it
    feasible."""
    layout = problem.layout
    centring = np.clip(1.0 - at.step, _CENTRING, _MOST_CENTRING)
    mu = np.where(alive, centring * at.gap, at.gap)[layout.path_of_cell]
    pushes = per_limit(lambda slack: mu / slack, at.slacks)  # the multipliers that the barrier wants
    stiffness = per_limit(np.divide, at.multipliers, at.slacks)
    per_cubed_rate = at.b_at_points**-1.5
    system = newton_system(problem, at, per_cubed_rate, pushes, stiffness)
    direction, failed = newton_direction(layout, system)
    stuck = at.stuck | failed
    direction *= (alive & ~stuck)[layout.path_of_unknown]

    change = problem.motion(direction)
    d_most_jerk = -0.5 * (at.allowed * per_cubed_rate[:, None]) * change.b[:, None]
    d_slacks = problem.slack_changes(change, d_most_jerk)
    d_multipliers = per_limit(
        lambda push, multiplier, weight, d: push - multiplier - weight * d,
        pushes,
        at.multipliers,
        stiffness,
        d_slacks,
    )
    dual = np.minimum(1.0, _BOUNDARY * layout.steps_until_zero(at.multipliers, d_multipliers))
    primal = np.minimum(1.0, _BOUNDARY * layout.steps_until_zero([at.b_at_points, *at.slacks], [change.b, *d_slacks]))
    b, motion, primal, lost = _kept_feasible(problem, at, direction, primal)
    scale = dual[layout.path_of_cell]
    multipliers = per_limit(lambda multiplier, d: multiplier + scale * d, at.multipliers, d_multipliers)
    allowed = lowered_limits(motion, at.allowed)
    slacks = problem.slacks(motion, allowed)
    return replace(
        at,
        b=b,
        b_at_points=motion.b,
        slacks=slacks,
        multipliers=multipliers,
        allowed=allowed,
        time_s=problem.times_s(motion.b),
        gap=mean_gap(problem, slacks, multipliers),
        step=np.minimum(primal, dual),
        stuck=stuck | lost,
    )


def _kept_feasible(
    problem: DiscreteProblem, at: Iterate, direction: FloatArray, primal: FloatArray
) -> tuple[FloatArray, CellMotion, FloatArray, BoolArray]:
    """The unknowns after such shares (n_paths,) of the direction, or after less where that would break a limit: those
    of jerk curve, so a step that linearised slacks allow may still be too long. Also their motion, the
    shares, and the paths (n_paths,) that stay where they are, as no share will do."""
    layout = problem.layout
    for _ in range(_MOST_SHORTENED):
        b = at.b + primal[layout.path_of_unknown] * direction
        motion = problem.motion(b)
        moved = problem.slacks(motion, at.allowed)
        bad = layout.smallest(motion.b) <= 0
        for after, before in (
            (moved.jerk_above, at.slacks.jerk_above),
            (moved.jerk_below, at.slacks.jerk_below),
        ):
            bad |= ~(layout.smallest(after - _KEPT_AT_LEAST * before) > 0)
        if not bad.any():
            return b, motion, primal, bad
        primal = np.where(bad, _SHORTENED * primal, primal)
    b = np.where(bad[layout.path_of_unknown], at.b, b)
    return b, problem.motion(b), primal, bad
