"""The type of a singular configuration: whether motion in the null space leaves it, and whether the tool then rests.

In a singular configuration J has more of a null space than elsewhere. It is of type 2 where a step along that leads to
configurations of full rank, as the stretched SCARA's elbow does, and of type 1 where it does not, as in an aligned
wrist, whose joints turn against each other and stay aligned. Such a step holds the tool to first order. Whether a
motion that holds it altogether leads out is another question: `pose(q + z) = pose(q)`, `|z| = t` is solved by
Gauss-Newton from many directions of the null space (N. S. Bedrossian, "Classification of singular configurations for
redundant manipulators", 1990).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray
from planner.kinematics.frame_jacobian import chain_frames, frame_jacobian
from planner.kinematics.singularity import mobility
from planner.kinematics.small_step import rotation_vector

_DISTANCE = 0.05
"""rad, or of the arm's length where joints slide."""
_DIRECTIONS, _ITERATIONS = 24, 40
_HELD = 1e-10
"""The tool rests where it is no further off, rad or of the arm's length."""
_RANK, _SINGULAR = 1e-5, 1e-7
"""Of the greatest singular value: what the least has to be for a configuration to be clear of the singularity, which is
_DISTANCE away, and what it is at most within it."""


@dataclass(frozen=True, slots=True)
class Escape:
    """null_motion_leaves: type 2, else type 1. tool_can_rest: whether a motion with the tool at rest leads out of it.
    arm_can_move: whether there is any motion with the tool at rest."""

    null_motion_leaves: bool
    tool_can_rest: bool
    arm_can_move: bool

    @property
    def type(self) -> int:
        return 2 if self.null_motion_leaves else 1

    def __str__(self) -> str:
        leaves = "leaves it" if self.null_motion_leaves else "stays in it"
        if self.tool_can_rest:
            rest = "the tool can rest meanwhile"
        elif self.null_motion_leaves:
            rest = "the tool moves with it, to second order"
        else:
            rest = "only a motion of the tool leads out"
        return f"type {self.type}: motion in the null space {leaves}; {rest}"


def escape(arm: Arm, joints: FloatArray) -> Escape | None:
    """Of a configuration (n_joints,), rad or mm, couplings kept; None where it is not singular."""
    problem = _Problem(arm, joints)
    _, values, right = np.linalg.svd(problem.jacobian(np.zeros(problem.n)))
    rank = int((values > _SINGULAR * values.max(initial=1e-300)).sum())
    if rank >= problem.freedom:
        return None
    null = right[rank:]
    random = np.random.default_rng(0).normal(size=(_DIRECTIONS, len(null))) @ null
    steps = _DISTANCE * np.concatenate((null, -null, random / np.linalg.norm(random, axis=1)[:, None]))
    held = [z for z in map(problem.at_rest, steps) if z is not None]
    return Escape(any(map(problem.is_clear, steps)), any(map(problem.is_clear, held)), bool(held))


class _Problem:
    """The tool's pose over displacements z (n,) of the independent joints, without units."""

    def __init__(self, arm: Arm, joints: FloatArray) -> None:
        able = mobility(arm)
        self._arm, self._joints = arm, joints
        self._rows, self.freedom = list(able.rows), able.freedom
        self._of_row = np.array([1 / able.length_mm] * 3 + [1.0] * 3)
        slides = [arm.joints[index].kind is JointKind.PRISMATIC for index in arm.independent_joints]
        self._matrix = arm.coupling_matrix[0] * np.where(slides, able.length_mm, 1.0)
        self._pose = chain_frames(arm, joints[None])[0, -1]
        self.n = self._matrix.shape[1]

    def jacobian(self, z: FloatArray) -> FloatArray:
        """(n_rows, n)"""
        whole = frame_jacobian(self._arm, (self._joints + self._matrix @ z)[None])[0] @ self._matrix
        rows: FloatArray = (self._of_row[:, None] * whole)[self._rows]
        return rows

    def off(self, z: FloatArray) -> FloatArray:
        """(n_rows,) how far the tool is from where it was."""
        pose = chain_frames(self._arm, (self._joints + self._matrix @ z)[None])[0, -1]
        turned = rotation_vector(pose[:3, :3] @ self._pose[:3, :3].T)
        off: FloatArray = (self._of_row * np.concatenate((pose[:3, 3] - self._pose[:3, 3], turned)))[self._rows]
        return off

    def at_rest(self, start: FloatArray) -> FloatArray | None:
        """A displacement of length _DISTANCE with the tool at rest, looked for from such a one; None where none is
        found."""
        z = start
        for _ in range(_ITERATIONS):
            residual = np.append(self.off(z), (z @ z - _DISTANCE**2) / (2 * _DISTANCE))
            if np.abs(residual).max() < _HELD:
                return z
            slope = np.vstack((self.jacobian(z), z / _DISTANCE))
            step = np.linalg.lstsq(slope, residual, rcond=1e-9)[0]
            z = z - step * min(1.0, 0.5 * _DISTANCE / max(float(np.linalg.norm(step)), 1e-300))
        return None

    def is_clear(self, z: FloatArray) -> bool:
        values = np.linalg.svd(self.jacobian(z), compute_uv=False)
        return bool(values[self.freedom - 1] > _RANK * values[0])
