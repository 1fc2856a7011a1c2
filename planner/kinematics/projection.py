"""From a reference configuration to the nearest configuration that puts the pen exactly on its target."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import JointKind
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.kinematics.chain import Kinematics

RESIDUAL_MM = 1e-9
"""A configuration is exact where its task misses by less than this (mm, or 1e-9 rad of pointing)."""

_DAMPING = 1e-12
"""Of each equation's own size: millimetres and radians stand side by side, and what is little to a tip that moves by a
metre would hold the pointing of its pen off its target."""

_STILL_RAD = 1e-11
"""Iteration goes on while a configuration still moves by more than this, in rad or mm: a target is met long before the
configuration nearest to its reference is found."""


def joint_scale(kinematics: Kinematics) -> FloatArray:
    """(n_independent,) speeds of the independent joints: dividing by them measures configurations in seconds of joint
    motion."""
    return kinematics.independent_of(kinematics.arm.max_velocity)


def turning_joints(kinematics: Kinematics) -> BoolArray:
    """(n_independent,) which of the independent joints turn; the others slide."""
    arm = kinematics.arm
    return np.array([arm.joints[index].kind is JointKind.REVOLUTE for index in arm.independent_joints])


@dataclass(frozen=True, eq=False, slots=True)
class Pins:
    """One more equation for each configuration, `row . q = value`: a joint that has to be at a place. rows: (n,
    n_independent)."""

    rows: FloatArray
    values: FloatArray


def project(
    kinematics: Kinematics, reference: FloatArray, tip_mm: FloatArray, *, iterations: int = 30, pins: Pins | None = None
) -> tuple[FloatArray, BoolArray]:
    """For each target the configuration closest to its reference, measured in joint time, and whether it is exact.

    reference: (n, n_independent); tip_mm: (n, 3); pins: what configurations have to meet beside their targets.
    Solves `min |(q - r) / speed|` subject to `task(q) = target` by linearising the task about the latest q
    (Gauss-Newton on the constraint):
    `q <- r + S^2 J^T (J S^2 J^T)^-1 (target - task(q) + J (q - r))`, S = diag(speed).
    Depends on target and reference alone, and smoothly, so smooth input gives a smooth joint path.
    """

    def task_at(rows: IntArray) -> tuple[FloatArray, FloatArray]:
        task, jacobian = kinematics.task_and_jacobian(solution[rows])
        if pins is None:
            return task, jacobian
        pinned = np.einsum("nj,nj->n", pins.rows[rows], solution[rows])
        return np.column_stack((task, pinned)), np.concatenate((jacobian, pins.rows[rows, None]), axis=1)

    target = kinematics.task_target(tip_mm)
    if pins is not None:
        target = np.column_stack((target, pins.values))
    scale = joint_scale(kinematics)
    squared_scale = scale**2
    fastest_turn = scale[turning_joints(kinematics)].max(initial=0.0)
    allowed = 0.5 * np.pi / fastest_turn if fastest_turn else np.inf
    solution = reference.copy()
    best = np.full(len(reference), np.inf)
    moved = np.full(len(reference), np.inf)
    active = np.arange(len(reference))
    for _ in range(iterations):
        task, jacobian = task_at(active)
        miss = target[active] - task
        best[active] = np.abs(miss).max(axis=1, initial=0.0)
        going = (best[active] > RESIDUAL_MM) | (moved[active] > _STILL_RAD)
        if not going.any():
            break
        active, miss, jacobian = active[going], miss[going], jacobian[going]
        offset = solution[active] - reference[active]
        wanted = miss + np.einsum("nij,nj->ni", jacobian, offset)
        weighted = jacobian * squared_scale
        gram = np.einsum("nij,nkj->nik", weighted, jacobian)
        gram += _damping(gram)
        multiplier = np.linalg.solve(gram, wanted[:, :, None])
        change = np.einsum("nij,ni->nj", weighted, multiplier[:, :, 0]) - offset
        # A step of more than a quarter turn says that the linearisation is meaningless there.
        longest = np.abs(change / scale).max(axis=1)
        change *= np.minimum(1.0, allowed / np.maximum(longest, 1e-300))[:, None]
        moved[active] = np.abs(change).max(axis=1)
        solution[active] += change
    else:
        task, _ = task_at(active)
        best[active] = np.abs(target[active] - task).max(axis=1, initial=0.0)
    return solution, best <= 100 * RESIDUAL_MM


def _damping(gram: FloatArray) -> FloatArray:
    """(n, k, k) diagonals that keep Gram matrices (n, k, k) from being singular, an equation that no joint can change
    included."""
    sizes = np.einsum("nii->ni", gram)
    least = _DAMPING * sizes.sum(axis=1, keepdims=True)
    damping: FloatArray = _DAMPING * np.maximum(sizes, least)[:, :, None] * np.eye(gram.shape[1])
    return damping
