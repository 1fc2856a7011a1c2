"""Newton's direction for all paths at once: a symmetric system of half bandwidth 3, built and solved.

Limits are few for each cell and reach over its four unknowns alone, so work is linear in the number of cells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.lapack import dpbtrf, dpbtrs
from planner.timing.cell_cubics import BOOLE, VALUE_FORMS
from planner.timing.cell_layout import PAIRS, CellLayout
from planner.timing.discrete_problem import DiscreteProblem
from planner.timing.iterate import Iterate
from planner.timing.per_limit import PerLimit

_FLATTEST = 1e-9
"""Least factor of the second derivative of the time, where the jerk limits' own would make it negative."""
_SHIFT = 1e-12
"""Added to the diagonal, which is 1 everywhere: a matrix that is singular to the last digit is factorised yet."""

_SQUARES = (VALUE_FORMS[:, PAIRS[0]] * VALUE_FORMS[:, PAIRS[1]]).T


@dataclass(frozen=True, eq=False, slots=True)
class NewtonSystem:
    """band: (4, n_unknowns) the lower band of the matrix, entry (i + k, i) at [k, i]; gradient: (n_unknowns,)."""

    band: FloatArray
    gradient: FloatArray


def newton_system(
    problem: DiscreteProblem, at: Iterate, per_cubed_rate: FloatArray, pushes: PerLimit, stiffness: PerLimit
) -> NewtonSystem:
    """Of time - mu * sum of log(slack), its curvature by the multipliers at hand.

    per_cubed_rate: (5, cells) b^(-3/2) at the points; pushes: mu / slack; stiffness: multiplier / slack.
    """
    allowed, multipliers = at.allowed, at.multipliers
    jerk_stiffness = stiffness.jerk_above + stiffness.jerk_below
    jerk_push = pushes.jerk_above - pushes.jerk_below
    acceleration_stiffness = stiffness.acceleration_above + stiffness.acceleration_below
    acceleration_push = pushes.acceleration_above - pushes.acceleration_below
    by_b = 0.5 * per_cubed_rate * (_over_joints(allowed, pushes.jerk_above + pushes.jerk_below) - BOOLE[:, None])
    by_b += pushes.rate * problem.b_by_limit
    # Second derivative of the time less that of the jerk limits' J / sqrt(b), where that is positive.
    convex = np.maximum(
        BOOLE[:, None] - _over_joints(allowed, multipliers.jerk_above + multipliers.jerk_below), _FLATTEST
    )
    by_b_twice = 0.75 * convex * per_cubed_rate / at.b_at_points
    by_b_twice += 0.25 * per_cubed_rate**2 * np.einsum("pjc,pjc,pjc->pc", allowed, allowed, jerk_stiffness)
    by_b_twice += stiffness.rate * problem.b_by_limit**2
    by_b_and_jerk = 0.5 * per_cubed_rate[:, None] * allowed * (stiffness.jerk_above - stiffness.jerk_below)

    gradient = VALUE_FORMS.T @ by_b
    gradient += np.einsum("kpjc,pjc->kc", problem.jerk, jerk_push)
    gradient += np.einsum("kpjc,pjc->kc", problem.acceleration, acceleration_push)
    crossed = np.einsum("kpjc,pjc->pkc", problem.jerk, by_b_and_jerk)
    mixed = (VALUE_FORMS.T @ crossed.reshape(len(crossed), -1)).reshape(4, 4, -1)
    entries = _SQUARES @ by_b_twice
    entries += mixed[PAIRS] + mixed[PAIRS[::-1]]
    entries += np.einsum("kpjc,pjc->kc", problem.jerk_pairs, jerk_stiffness)
    entries += np.einsum("kpjc,pjc->kc", problem.acceleration_pairs, acceleration_stiffness)
    layout = problem.layout
    return NewtonSystem(layout.band_of(entries), layout.unknowns_of(gradient))


def newton_direction(layout: CellLayout, system: NewtonSystem) -> tuple[FloatArray, BoolArray]:
    """(n_unknowns,) minus the gradient by the matrix, and the paths (n_paths,) whose part of it is not positive
    definite or not finite: nothing for these. The system's arrays are spent."""
    band, of_path = system.band, layout.path_of_unknown
    scale = 1.0 / np.sqrt(band[0])  # unknowns differ by orders of magnitude between corners and straights
    band *= scale
    for k in range(1, 4):
        band[k, :-k] *= scale[k:]
    band[0] *= scale
    band[0] += _SHIFT
    right = scale * system.gradient
    failed = np.zeros(layout.n_paths, dtype=bool)
    failed[of_path[~np.isfinite(band.sum(axis=0) + right)]] = True
    while True:  # each round leaves out one path more
        out = failed[of_path]
        band[:, out], scale[out], right[out] = np.array([[1.0], [0.0], [0.0], [0.0]]), 0.0, 0.0
        factor, first_bad = dpbtrf(band, lower=1)
        if first_bad == 0:
            break
        failed[of_path[first_bad - 1]] = True
    newton: FloatArray = -scale * dpbtrs(factor, right, lower=1)[0]
    failed[of_path[~np.isfinite(newton)]] = True
    newton[failed[of_path]] = 0.0
    return newton, failed


def _over_joints(one: FloatArray, other: FloatArray) -> FloatArray:
    """(n_points, cells) sums over the joints."""
    sums: FloatArray = np.einsum("pjc,pjc->pc", one, other)
    return sums
