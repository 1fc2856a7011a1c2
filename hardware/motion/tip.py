"""Where the pen is: forward kinematics of many configurations, and the Jacobian of one, in plain NumPy."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Tip:
    """The tip of the pen in the paper's frame and how it moves with each joint.

    position_mm: (3,). axis: (3,) unit vector along the pen, out of the nib. position_jacobian and
    axis_jacobian: (3, n_joints), per rad or per mm, every joint moving on its own (no coupling applied).
    """

    position_mm: FloatArray
    axis: FloatArray
    position_jacobian: FloatArray
    axis_jacobian: FloatArray


def tip_at(arm: Arm, joints: FloatArray) -> Tip:
    """The tip at `joints` (n_joints,), rad or mm, by the product of the standard DH rows and the
    geometric Jacobian: z x (tip - origin) for a revolute joint about z, z for a prismatic one along it."""
    to_paper = arm.paper.T_paper_base
    rotation, origin = to_paper[:3, :3], to_paper[:3, 3]
    joint_axes, joint_origins = [], []
    for joint, value in zip(arm.joints, joints.tolist(), strict=True):
        revolute = joint.kind is JointKind.REVOLUTE
        joint_axes.append(rotation[:, 2])
        joint_origins.append(origin)
        theta = joint.theta_rad + (value if revolute else 0.0)
        d_mm = joint.d_mm + (0.0 if revolute else value)
        ct, st, ca, sa = cos(theta), sin(theta), cos(joint.alpha_rad), sin(joint.alpha_rad)
        origin = origin + rotation @ np.array([joint.a_mm * ct, joint.a_mm * st, d_mm])
        rotation = rotation @ np.array([[ct, -st * ca, st * sa], [st, ct * ca, -ct * sa], [0.0, sa, ca]])
    axis = rotation @ np.array(arm.pen.tool_axis)
    z, turns = np.array(joint_axes), np.array([joint.kind is JointKind.REVOLUTE for joint in arm.joints])[:, None]
    return Tip(
        origin,
        axis,
        np.where(turns, np.cross(z, origin - np.array(joint_origins)), z).T,
        np.where(turns, np.cross(z, axis), 0.0).T,
    )


def link_nodes_mm(arm: Arm, positions: FloatArray) -> FloatArray:
    """(n, 2 n_joints, 3) where links bend at `positions` (n, n_joints), rad or mm: for each joint the end of its
    offset d and the end of its length a, the last of all being the tip. The DH rows' product, as in `tip_at`."""
    to_paper = arm.paper.T_paper_base
    rotation, origin = to_paper[:3, :3], np.repeat(to_paper[None, :3, 3], len(positions), axis=0)
    nodes = []
    for joint, value in zip(arm.joints, positions.T, strict=True):
        revolute = joint.kind is JointKind.REVOLUTE
        theta = joint.theta_rad + (value if revolute else np.zeros_like(value))
        d_mm = joint.d_mm + (np.zeros_like(value) if revolute else value)
        ct, st, ca, sa = np.cos(theta), np.sin(theta), cos(joint.alpha_rad), sin(joint.alpha_rad)
        bend = origin + rotation[..., 2] * d_mm[:, None]
        length = np.stack((joint.a_mm * ct, joint.a_mm * st, np.zeros_like(ct)), axis=-1)
        origin = bend + (rotation @ length[..., None])[..., 0]
        rotation = rotation @ np.stack(
            (
                np.stack((ct, -st * ca, st * sa), axis=-1),
                np.stack((st, ct * ca, -ct * sa), axis=-1),
                np.broadcast_to([0.0, sa, ca], (len(positions), 3)),
            ),
            axis=-2,
        )
        nodes += [bend, origin]
    return np.stack(nodes, axis=1)
