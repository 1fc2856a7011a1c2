"""Minimum-time motion along paths within joint velocity, acceleration and jerk limits.

With b = (dsigma/dt)^2 as a function of sigma and ' = d/dsigma, a joint path q(sigma) moves with

    velocity      q' sqrt(b)
    acceleration  q'' b + q' b'/2
    jerk          (q''' b + 3/2 q'' b' + 1/2 q' b'') sqrt(b)

(Verscheure et al. 2009 for the first two; the third is not convex). `docs/timing.md` derives the rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.timing.cell_cubics import HERMITE, VALUE_FORMS
from planner.timing.discrete_problem import DiscreteProblem
from planner.timing.feasible_start import feasible_start
from planner.timing.interior_point import next_iterate
from planner.timing.iterate import first_iterate
from planner.timing.timing_problem import TimingProblem

_MOST_ITERATIONS = 80
_CELLS_AT_ONCE = 1250
"""Paths of about so many cells are solved together: fewer cost more calls, more do not fit a processor's cache."""
_GAP = 1e-3
"""Iteration stops where the barrier can still save less than this share of a path's time."""
_COMPACT_BELOW = 0.7
"""Paths that are done leave the working set once fewer than this share of its cells is still being improved."""
_CLEARLY_FASTER = 0.95
"""A motion that is not optimal is preferred to a steady pace where its time is below this share: what it may have to
be slowed by between the points does not undo that."""


@dataclass(frozen=True, eq=False, slots=True)
class PathTiming:
    """rates: (total cells, 4) polynomials of b in each cell, lowest power of the fraction first, that keep the limits
    at the points; converged: (n_paths,) whether they are near the least time, rather than the fallback."""

    rates: FloatArray
    converged: BoolArray


def minimum_time(problem: TimingProblem) -> PathTiming:
    """The motion near the least time that the limits allow.

    Where the solver does not get there, the fallback is taken: what it has, or sigma at the greatest steady rate,
    whichever is faster. Either keeps the limits: a path is at rest at both ends whatever the rate.
    """
    group = np.cumsum(problem.n_cells) // _CELLS_AT_ONCE
    timings = [_timed_together(problem.subset(group == one)) for one in sorted(set(group.tolist()))]
    return PathTiming(
        np.concatenate([timing.rates for timing in timings]), np.concatenate([timing.converged for timing in timings])
    )


def _timed_together(problem: TimingProblem) -> PathTiming:
    discrete = DiscreteProblem(problem)
    layout = discrete.layout
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):  # of paths that fail
        b, converged = _solved(discrete)
    four = layout.unknowns_of_cells(b)
    time_s = discrete.times_s(VALUE_FORMS @ four)
    steady = np.minimum.reduceat(discrete.steady_b(), layout.first_cell)
    is_slow = problem.n_cells / np.sqrt(steady) < time_s * np.where(converged, 1.0, 1.0 / _CLEARLY_FASTER)
    constant = np.outer(steady, [1.0, 0.0, 0.0, 0.0])
    rates = np.where(is_slow[layout.path_of_cell, None], constant[layout.path_of_cell], four.T @ HERMITE)
    return PathTiming(rates, converged)


def _solved(problem: DiscreteProblem) -> tuple[FloatArray, BoolArray]:
    """The unknowns of all paths, and which of these (n_paths,) are near the least time."""
    result = feasible_start(problem)
    converged = np.zeros(problem.layout.n_paths, dtype=bool)
    iterate = first_iterate(problem, result)
    where, paths = np.arange(len(result)), np.arange(problem.layout.n_paths)  # of the working set in the result
    for _ in range(_MOST_ITERATIONS):
        near = iterate.is_near(problem, _GAP)
        alive = ~near & ~iterate.stuck
        if np.repeat(alive, problem.layout.n_cells).mean() < _COMPACT_BELOW:
            result[where], converged[paths] = iterate.b, near
            if not alive.any():
                break
            where, paths = where[alive[problem.layout.path_of_unknown]], paths[alive]
            iterate, problem = iterate.subset(problem, alive), problem.subset(alive)
            alive = np.ones(problem.layout.n_paths, dtype=bool)
        iterate = next_iterate(problem, iterate, alive)
    else:
        result[where], converged[paths] = iterate.b, iterate.is_near(problem, _GAP)
    return result, converged
