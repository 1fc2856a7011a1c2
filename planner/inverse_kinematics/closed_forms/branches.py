"""All configurations of a closed form for many targets, and which of them may be used, or is nearest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.kinematics.joint_time import joint_time_s

ELBOWS = (1.0, -1.0)
"""Order of the elbow branches: by the sign of the elbow's angle."""

_BLOCK = 4096  # targets at a time, so that intermediate results stay in the processor's cache

Solve = Callable[[slice, FloatArray], tuple[FloatArray, BoolArray]]
"""Fills configurations (n_branches, n_independent, m) of a slice of m targets; returns gaps in mm and singular flags,
(m,)."""


@dataclass(frozen=True, eq=False, slots=True)
class Branches:
    """Every configuration of each of n targets.

    configurations: (n, n_branches, n_independent) independent joints, rad or mm, each angle at the turn nearest the
    middle of its
        joint's range; NaN where a branch does not exist.
    gap_mm: (n,) 0 where some branch exists, else the length that is missing; inf where no length would help.
    singular: (n,) true where branches coincide or infinitely many configurations exist (tip on the base axis, stretched
        or folded links, aligned wrist axes); one of them is given.
    """

    configurations: FloatArray
    gap_mm: FloatArray
    singular: BoolArray

    @property
    def exist(self) -> BoolArray:
        """(n, n_branches) which branches exist."""
        found: BoolArray = np.logical_not(np.isnan(self.configurations).any(axis=-1))
        return found

    def only(self, chosen: BoolArray) -> Branches:
        """These branches without those that are not chosen, (n, n_branches)."""
        return Branches(np.where(chosen[..., None], self.configurations, np.nan), self.gap_mm, self.singular)


def solve_in_blocks(arm: Arm, n_targets: int, n_branches: int, solve: Solve) -> Branches:
    """Branches of all targets, solved block by block and brought to the turn nearest the middle of the ranges."""
    independent = list(arm.independent_joints)
    revolute = np.array([arm.joints[index].kind is JointKind.REVOLUTE for index in independent])
    turn = np.where(revolute, 2 * np.pi, 0.0)[:, None]
    turns = np.where(revolute, 0.5 / np.pi, 0.0)[:, None]
    middle = ((arm.minimum + arm.maximum) / 2)[independent][:, None]
    # A row per joint: every step writes to adjacent memory.
    rows = np.empty((n_branches, len(independent), n_targets))
    gap = np.empty(n_targets)
    singular = np.empty(n_targets, dtype=np.bool_)
    for first in range(0, n_targets, _BLOCK):
        block = slice(first, min(first + _BLOCK, n_targets))
        out = np.empty((n_branches, len(independent), block.stop - first))
        gap[block], singular[block] = solve(block, out)
        away = out - middle
        away *= turns
        np.rint(away, out=away)
        away *= turn
        np.subtract(out, away, out=rows[:, :, block])
    return Branches(rows.transpose(2, 0, 1), gap, singular)


def nearest(arm: Arm, branches: Branches, before: FloatArray) -> tuple[IntArray, FloatArray]:
    """Index (n,) of the branch that the joints reach soonest from the independent joints `before` (n, n_independent),
    and that joint time (n,) in s; -1 and inf where no branch exists. Limits are not asked: see `Branches.only`."""
    time = joint_time_s(arm, arm.complete(before)[:, None], arm.complete(branches.configurations))
    time = np.where(np.isnan(time), np.inf, time)
    index = time.argmin(axis=1)
    soonest = time[np.arange(len(time)), index]
    return np.where(np.isfinite(soonest), index, -1), soonest
