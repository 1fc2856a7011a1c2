"""Strokes timed so that between samples, too, the tip stays within the tolerance of its stroke.

Caps on the speed along a path (`rate_limit`, `chord_error_limit`) foresee what samples cut off where the pen is at
speed. What is left is measured on the samples themselves: where it is too much, the speed around is capped and the
stroke timed anew, further around with every round, so that in the end the whole of it is slower; where it is hardly too
much, the whole of it is slower at once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import JointPaths
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits
from planner.motion.between_samples import stroke_excess
from planner.motion.stroke_motion import StrokeMotions, motions
from planner.placement.pen_path import StrokePaths
from planner.ragged import starts_of, within
from planner.timing.path_timing import minimum_time
from planner.timing.timing_problem import FRACTIONS, TimingProblem

_ROUNDS = 16
_MARGIN, _MARGIN_THERE = 0.97, 0.94
"""What is aimed at, of what is allowed, where all of a stroke is slowed, and where some places are."""
_FEW_PERIODS = 0.5
"""Where no more is lost, all of a stroke is slowed: to time it anew would save less than that takes."""
_LATE = (0.25, 0.5, 0.75)
_MANY_PERIODS = 300
"""Shares of a period by which samples may come later: what slows one place moves all samples behind it. So a stroke
that is timed anew more than once, or lasts longer, is slowed at each place for the samples that are worst there: there
would be no end otherwise."""
_SLOWEST = 0.5
"""Least factor that a round slows by: figures far above what is allowed follow no power of the speed."""


@dataclass(frozen=True, eq=False, slots=True)
class Timed:
    """joints: (n, n_joints) samples of a stroke. converged: whether it is timed near the least time, rather than by the
    fallback. held: whether the tip is within the tolerance between all samples."""

    joints: FloatArray
    converged: bool
    held: bool


def timed_within(
    kinematics: Kinematics,
    limits: Limits,
    paths: StrokePaths,
    splines: JointPaths,
    rate_limit: FloatArray,
    tolerance_mm: float,
    rate_hz: float,
) -> list[Timed]:
    """The motion of each path: paths and splines with the same cells, rate_limit (total cells, n_fractions) as
    `TimingProblem.of` has it."""
    derivatives = (splines.positions(FRACTIONS, 1), splines.positions(FRACTIONS, 2), splines.positions(FRACTIONS, 3))
    problem = TimingProblem.of(splines.n_cells, derivatives, limits, rate_limit)
    timed: dict[int, Timed] = {}
    left = np.arange(len(splines.n_cells))
    for around in 2 ** np.arange(_ROUNDS):
        timing = minimum_time(problem)
        tried = _tried(kinematics, limits, paths, splines, timing.rates, tolerance_mm, rate_hz)
        samples, over = tried.samples, tried.worst > 1.0
        costs = tried.motion.n_periods * (np.sqrt(np.maximum(tried.worst, _MARGIN) / _MARGIN) - 1.0)
        slightly = over & (costs <= _FEW_PERIODS)
        if slightly.any():
            slower = np.repeat(_MARGIN / tried.worst, splines.n_cells)[:, None] * timing.rates
            cells = np.repeat(slightly, splines.n_cells)
            some = paths.subset(slightly), splines.subset(slightly)
            slowed = _tried(kinematics, limits, *some, slower[cells], tolerance_mm, rate_hz)
            for index, made, worst in zip(np.flatnonzero(slightly), slowed.samples, slowed.worst, strict=True):
                if worst <= 1.0:
                    samples[index], over[index] = made, False
        timed.update(zip(left.tolist(), map(Timed, samples, timing.converged.tolist(), (~over).tolist()), strict=True))
        if not over.any():
            break
        problem, paths, splines, left = problem.subset(over), paths.subset(over), splines.subset(over), left[over]
        excess = tried.excess[np.repeat(over, tried.motion.n_periods)]
        cap = _cap_where_over(kinematics, paths, tried.motion.subset(over), excess, tolerance_mm, int(around))
        problem = replace(problem, rate_limit=np.minimum(problem.rate_limit, cap))
    return [timed[index] for index in sorted(timed)]


@dataclass(frozen=True, eq=False, slots=True)
class _Tried:
    """Motions of some strokes, their samples, and by how much the tip strays in each step, and at most in each
    stroke."""

    motion: StrokeMotions
    samples: list[FloatArray]
    excess: FloatArray
    worst: FloatArray


def _tried(
    kinematics: Kinematics,
    limits: Limits,
    paths: StrokePaths,
    splines: JointPaths,
    rates: FloatArray,
    tolerance_mm: float,
    rate_hz: float,
) -> _Tried:
    motion = motions(splines, rates, limits, rate_hz)
    samples = motion.samples()
    excess = stroke_excess(kinematics, paths, motion, samples, tolerance_mm)
    return _Tried(motion, samples, excess, np.maximum.reduceat(excess, starts_of(motion.n_periods)[:-1]))


def _cap_where_over(
    kinematics: Kinematics,
    paths: StrokePaths,
    motion: StrokeMotions,
    excess: FloatArray,
    tolerance_mm: float,
    around: int,
) -> FloatArray:
    """(total cells,) caps on dsigma/dt, inf where the tip does not stray too far; excess: (total steps,) at the samples
    as they are."""
    cap = _slower_where(motion, excess, around)
    chosen = (motion.n_periods > _MANY_PERIODS) | (around > 1)
    if chosen.any():
        some, of = motion.subset(chosen), paths.subset(chosen)
        cells = np.repeat(chosen, paths.pen.n_cells)
        for late in _LATE:
            later = stroke_excess(kinematics, of, some, some.samples(late), tolerance_mm, late)
            cap[cells] = np.minimum(cap[cells], _slower_where(some, later, around, late))
    return cap


def _slower_where(motion: StrokeMotions, excess: FloatArray, around: int, late: float = 0.0) -> FloatArray:
    """(total cells,) caps on dsigma/dt below the motion's own in the cells of each step (total steps,) with an excess,
    and of so many steps before and behind; inf elsewhere."""
    n_cells, n_steps = motion.paths.n_cells, motion.steps(late)
    cells, _ = motion.places(1, late)  # one more than steps for each path
    first = np.repeat(starts_of(n_steps + 1)[:-1], n_steps)
    step = within(n_steps)
    begin = cells[first + np.maximum(step - around, 0)]
    end = cells[first + np.minimum(step + 1 + around, np.repeat(n_steps, n_steps))]
    rate = motion.rates @ np.vander(FRACTIONS, 4, increasing=True).T
    fastest = np.sqrt(rate.max(axis=1))
    cap = np.full(int(n_cells.sum()), np.inf)
    for at in np.flatnonzero(excess > 1.0).tolist():
        slower = max(_MARGIN_THERE / np.sqrt(excess[at]), _SLOWEST)
        cap[begin[at] : end[at] + 1] = np.minimum(
            cap[begin[at] : end[at] + 1], slower * fastest[begin[at] : end[at] + 1]
        )
    return cap
