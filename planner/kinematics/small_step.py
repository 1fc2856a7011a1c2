"""A small step of the tool as one of the joints, and back: `dx = J dq` at a configuration, seen from any frame.

Of all steps of the joints that make the step of the tool, the quickest is taken, `dq = S (J S)^+ dx` with S the joints'
speeds: the least sum of squares of the times that they take. Where no step of the joints makes that of the tool, the
one that comes nearest is taken, lengths in units of the arm's own, and what is missing is told.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.kinematics.frame_jacobian import chain_frames, frame_jacobian
from planner.kinematics.singularity import RANK_TOLERANCE, mobility

_LEFT_OUT = 1e-9
"""Of a step: what arithmetic leaves."""


@dataclass(frozen=True, eq=False, slots=True)
class SmallStep:
    """joints: (n_joints,) rad or mm, couplings kept. tool: (6,) mm and rad along and about the axes of the frame, what
    these joints make of it. missing: (6,) what was asked for and cannot be had; zeros where rows were not asked for.
    moved: (6,) what the tool really does when the joints go that far, of which `tool` is the linear part. time_s: that
    the slowest joint takes.
    """

    joints: FloatArray
    tool: FloatArray
    missing: FloatArray
    moved: FloatArray
    time_s: float

    @property
    def is_possible(self) -> bool:
        return not self.missing.any()


def step_of_tool(arm: Arm, joints: FloatArray, wanted: FloatArray, in_frame: int = 0) -> SmallStep:
    """The step of the joints at a configuration (n_joints,) for one of the tool, `wanted`: (3,) mm, its turn being
    left to the arm, or (6,) mm and rad. Errors: UsageError where the chain has no such frame."""
    jacobian = frame_jacobian(arm, joints[None], None, in_frame)[0]
    matrix, _ = arm.coupling_matrix
    length_mm = mobility(arm, None, in_frame).length_mm
    rows = len(wanted)
    scale = np.array([1 / length_mm] * 3 + [1.0] * 3)[:rows]
    speeds = arm.max_velocity[list(arm.independent_joints)]
    scaled = scale[:, None] * (jacobian @ matrix)[:rows] * speeds
    independent = speeds * (np.linalg.pinv(scaled, rcond=RANK_TOLERANCE) @ (scale * wanted))
    step = matrix @ independent
    missing = np.zeros(6)
    missing[:rows] = wanted - jacobian[:rows] @ step
    missing[np.abs(missing) * np.array([1 / length_mm] * 3 + [1.0] * 3) <= _LEFT_OUT * np.abs(scale * wanted).max()] = 0
    return _step(arm, joints, step, jacobian, missing, in_frame)


def step_of_joints(arm: Arm, joints: FloatArray, step: FloatArray, in_frame: int = 0) -> SmallStep:
    """What a step (n_joints,) of the joints makes of the tool. Errors: as `step_of_tool`."""
    jacobian = frame_jacobian(arm, joints[None], None, in_frame)[0]
    return _step(arm, joints, step, jacobian, np.zeros(6), in_frame)


def _step(
    arm: Arm, joints: FloatArray, step: FloatArray, jacobian: FloatArray, missing: FloatArray, in_frame: int
) -> SmallStep:
    before, after = chain_frames(arm, np.stack((joints, joints + step)))
    turn = before[in_frame, :3, :3].T
    moved = np.concatenate(
        (
            turn @ (after[-1, :3, 3] - before[-1, :3, 3]),
            turn @ rotation_vector(after[-1, :3, :3] @ before[-1, :3, :3].T),
        )
    )
    return SmallStep(step, jacobian @ step, missing, moved, float((np.abs(step) / arm.max_velocity).max()))


def rotation_vector(rotation: FloatArray) -> FloatArray:
    """(3,) axis times angle, rad, of a rotation (3, 3) by less than half a turn."""
    twist = np.array(
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    )
    sine, cosine = float(np.linalg.norm(twist)) / 2, (float(np.trace(rotation)) - 1) / 2
    vector: FloatArray = twist / 2 * (np.arctan2(sine, cosine) / sine if sine > 1e-12 else 1.0)
    return vector
