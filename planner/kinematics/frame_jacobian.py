"""The geometric Jacobian of any frame of the chain, expressed in any other.

For frame k, joint i <= k that turns about axis z of frame i-1 through its origin p:
`v = z x (p_k - p) dq, w = z dq`; one that slides along it: `v = z dq, w = 0`; joints beyond k do not move it.
Expressed in frame j both are turned by the transpose of `R_base_j`.
"""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray
from planner.errors import UsageError


def chain_frames(arm: Arm, joints: FloatArray) -> FloatArray:
    """Frames 0 (base) to n_joints (tool) as T_base_frame (n, n_joints + 1, 4, 4), mm, at joints (n, n_joints)."""
    frames = np.zeros((len(joints), arm.n_joints + 1, 4, 4))
    frames[:, 0] = np.eye(4)
    for index, joint in enumerate(arm.joints):
        frames[:, index + 1] = frames[:, index] @ _row(
            joint.theta_rad, joint.d_mm, joint.a_mm, joint.alpha_rad, joint.kind, joints[:, index]
        )
    return frames


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
    jacobian = np.zeros((len(joints), 6, arm.n_joints))
    to_frame = np.swapaxes(frames[:, in_frame, :3, :3], 1, 2)
    for index, joint in enumerate(arm.joints[:last]):
        axis, origin = frames[:, index, :3, 2], frames[:, index, :3, 3]
        revolute = joint.kind is JointKind.REVOLUTE
        linear = np.cross(axis, frames[:, last, :3, 3] - origin) if revolute else axis
        jacobian[:, :3, index] = np.einsum("nij,nj->ni", to_frame, linear)
        if revolute:
            jacobian[:, 3:, index] = np.einsum("nij,nj->ni", to_frame, axis)
    return jacobian


def _row(
    theta_rad: float, d_mm: float, a_mm: float, alpha_rad: float, kind: JointKind, position: FloatArray
) -> FloatArray:
    """(n, 4, 4) Rz(theta) Tz(d) Tx(a) Rx(alpha) of one joint at positions (n,)."""
    revolute = kind is JointKind.REVOLUTE
    theta = theta_rad + position if revolute else np.full_like(position, theta_rad)
    c, s = np.cos(theta), np.sin(theta)
    ca, sa = np.round((np.cos(alpha_rad), np.sin(alpha_rad)), 15)  # exactly 0 and 1 at right angles
    row = np.zeros((len(position), 4, 4))
    row[:, 0] = np.stack((c, -s * ca, s * sa, a_mm * c), axis=1)
    row[:, 1] = np.stack((s, c * ca, -c * sa, a_mm * s), axis=1)
    row[:, 2, 1:] = sa, ca, 0.0
    row[:, 2, 3] = d_mm + (0.0 if revolute else position)
    row[:, 3, 3] = 1.0
    return row
