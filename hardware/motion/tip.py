"""Where the pen is: forward kinematics of many configurations, and the Jacobian of one, in plain NumPy."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import NamedTuple

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
    """The tip at `joints` (n_joints,), rad or mm, with the geometric Jacobian: z x (tip - origin) for a revolute joint
    about z, z for a prismatic one along it."""
    *frames, tip = _frames(arm, joints[None])
    position_mm, axis = tip.origin[0], np.array(arm.pen.tool_axis) @ np.concatenate((tip.x, tip.y, tip.z))
    z, origins = (np.concatenate(columns) for columns in zip(*((one.z, one.origin) for one in frames), strict=True))
    arms = np.stack((position_mm - origins, np.broadcast_to(axis, z.shape)))
    turns = np.array([joint.kind is JointKind.REVOLUTE for joint in arm.joints])[:, None]
    of_position, of_axis = np.where(turns, np.cross(z, arms), np.stack((z, np.zeros_like(z))))
    return Tip(position_mm, axis, of_position.T, of_axis.T)


def link_nodes_mm(arm: Arm, positions: FloatArray) -> FloatArray:
    """(n, 2 n_joints, 3) where links bend at `positions` (n, n_joints), rad or mm: for each joint the end of its
    offset d and the end of its length a, the last of all being the tip."""
    _, *frames = _frames(arm, positions)
    return np.stack([node for frame in frames for node in (frame.bend, frame.origin)], axis=1)


def tips_mm(arm: Arm, positions: FloatArray, heights_mm: FloatArray | float = 0.0) -> FloatArray:
    """(n, 3) the tips of pens that stick out by `heights_mm` (n,) further than the one in the arm's file."""
    last = _frames(arm, positions)[-1]
    along_x, along_y, along_z = arm.pen.tool_axis
    axis = along_x * last.x + along_y * last.y + along_z * last.z
    tips: FloatArray = last.origin + np.reshape(heights_mm, (-1, 1)) * axis
    return tips


class _Frame(NamedTuple):
    """The frame at the end of a link in n configurations: axes, origin and where the link bends, each (n, 3)."""

    x: FloatArray
    y: FloatArray
    z: FloatArray
    bend: FloatArray
    origin: FloatArray


def _frames(arm: Arm, positions: FloatArray) -> list[_Frame]:
    """The base's frame and that of every link at `positions` (n, n_joints), seen from the paper. Each standard DH row
    is Rz(theta) Tz(d) Tx(a) Rx(alpha)."""
    x, y, z, origin = (np.broadcast_to(column, (len(positions), 3)) for column in arm.paper.T_paper_base[:3].T)
    frames = [_Frame(x, y, z, origin, origin)]
    for joint, value in zip(arm.joints, positions.T[:, :, None], strict=True):
        turn, slide = (value, 0.0 * value) if joint.kind is JointKind.REVOLUTE else (0.0 * value, value)
        cosine, sine = np.cos(joint.theta_rad + turn), np.sin(joint.theta_rad + turn)
        x, y = cosine * x + sine * y, cosine * y - sine * x
        bend = origin + (joint.d_mm + slide) * z
        origin = bend + joint.a_mm * x
        y, z = (
            cos(joint.alpha_rad) * y + sin(joint.alpha_rad) * z,
            cos(joint.alpha_rad) * z - sin(joint.alpha_rad) * y,
        )
        frames.append(_Frame(x, y, z, bend, origin))
    return frames
