"""The geometric Jacobian of any frame of the chain, expressed in any other.

For frame k, joint i <= k that turns about axis z of frame i-1, moved by the joint's own origin, through the point p:
`v = z x (p_k - p) dq, w = z dq`; one that slides along it: `v = z dq, w = 0`; joints beyond k do not move it.
Expressed in frame j both are turned by the transpose of `R_base_j`.
"""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm, Joint, JointKind
from planner.arms.rigid_transform import RigidTransform
from planner.arrays import FloatArray
from planner.errors import UsageError
from planner.kinematics.dh_row import dh_entries


def chain_frames(arm: Arm, joints: FloatArray) -> FloatArray:
    """Frames 0 (base) to n_joints (tool) as T_base_frame (n, n_joints + 1, 4, 4), mm, at joints (n, n_joints): those in
    between are at the ends of the rows."""
    frames = np.zeros((len(joints), arm.n_joints + 1, 4, 4))
    frames[:, 0] = np.eye(4)
    for index, joint in enumerate(arm.joints):
        frames[:, index + 1] = _moved(frames[:, index], joint.origin) @ _row(joint, joints[:, index])
    frames[:, -1] = _moved(frames[:, -1], arm.tool)
    return frames


def joint_frames(arm: Arm, frames: FloatArray) -> FloatArray:
    """(n, n_joints, 4, 4) the frames about or along whose z the joints move, of `chain_frames`."""
    moved = [_moved(frames[:, index], joint.origin) for index, joint in enumerate(arm.joints)]
    stacked: FloatArray = np.stack(moved, axis=1)
    return stacked


def frame_jacobian(arm: Arm, joints: FloatArray, of_frame: int | None = None, in_frame: int = 0) -> FloatArray:
    """(n, 6, n_joints) velocity of frame `of_frame` (the last one by default) along the axes of frame `in_frame`.

    joints: (n, n_joints), rad or mm, each taken as independent of the others. Rows vx vy vz in mm, then wx wy wz
    in rad, per rad or mm of the joint. Errors: UsageError where the chain has no such frame.
    """
    last = arm.n_joints if of_frame is None else of_frame
    for frame in (last, in_frame):
        if not 0 <= frame <= arm.n_joints:
            raise UsageError(f"arm '{arm.name}' has frames 0 (base) to {arm.n_joints} (tool), not {frame}")
    frames = chain_frames(arm, joints)
    moving = joint_frames(arm, frames)
    jacobian = np.zeros((len(joints), 6, arm.n_joints))
    to_frame = np.swapaxes(frames[:, in_frame, :3, :3], 1, 2)
    for index, joint in enumerate(arm.joints[:last]):
        axis, origin = moving[:, index, :3, 2], moving[:, index, :3, 3]
        revolute = joint.kind is JointKind.REVOLUTE
        linear = np.cross(axis, frames[:, last, :3, 3] - origin) if revolute else axis
        jacobian[:, :3, index] = np.einsum("nij,nj->ni", to_frame, linear)
        if revolute:
            jacobian[:, 3:, index] = np.einsum("nij,nj->ni", to_frame, axis)
    return jacobian


def _moved(frames: FloatArray, by: RigidTransform) -> FloatArray:
    """(n, 4, 4) frames (n, 4, 4), moved along with themselves."""
    moved: FloatArray = frames if by.is_identity else frames @ by.matrix
    return moved


def _row(joint: Joint, position: FloatArray) -> FloatArray:
    """(n, 4, 4) the transform of a joint's row at positions (n,)."""
    revolute = joint.kind is JointKind.REVOLUTE
    theta = joint.theta_rad + (position if revolute else np.zeros_like(position))
    d_mm = joint.d_mm + (np.zeros_like(position) if revolute else position)
    row = np.empty((len(position), 4, 4))
    for i, entries in enumerate(dh_entries(np.cos(theta), np.sin(theta), d_mm, joint.a_mm, joint.alpha_rad)):
        for k, entry in enumerate(entries):
            row[:, i, k] = entry
    return row
