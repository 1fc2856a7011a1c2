"""Where the pen is: forward kinematics of many configurations, and the Jacobian of one, in plain NumPy."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import NamedTuple

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arms.rigid_transform import RigidTransform
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
    *links, tip = _links(arm, joints[None])
    position_mm, axis = tip.end.origin[0], np.array(arm.pen.tool_axis) @ np.concatenate(tip.end[:3])
    z, origins = (np.concatenate([getattr(link.start, key) for link in links]) for key in ("z", "origin"))
    arms = np.stack((position_mm - origins, np.broadcast_to(axis, z.shape)))
    turns = np.array([joint.kind is JointKind.REVOLUTE for joint in arm.joints])[:, None]
    of_position, of_axis = np.where(turns, np.cross(z, arms), np.stack((z, np.zeros_like(z))))
    return Tip(position_mm, axis, of_position.T, of_axis.T)


def link_nodes_mm(arm: Arm, positions: FloatArray) -> FloatArray:
    """(n, n_nodes, 3) where links bend at `positions` (n, n_joints), rad or mm: for each joint its origin, if that is
    some way off, the end of its offset d and the end of its length a; then the tip, if it is not at that end."""
    *links, tip = _links(arm, positions)
    nodes = []
    for joint, link in zip(arm.joints, links, strict=True):
        nodes += [link.start.origin] if joint.origin.length_mm else []
        nodes += [link.bend, link.end.origin]
    nodes += [tip.end.origin] if arm.tool.length_mm else []
    return np.stack(nodes, axis=1)


def tips_mm(arm: Arm, positions: FloatArray, heights_mm: FloatArray | float = 0.0) -> FloatArray:
    """(n, 3) the tips of pens that stick out by `heights_mm` (n,) further than the one in the arm's file."""
    last = _links(arm, positions)[-1].end
    along_x, along_y, along_z = arm.pen.tool_axis
    axis = along_x * last.x + along_y * last.y + along_z * last.z
    tips: FloatArray = last.origin + np.reshape(heights_mm, (-1, 1)) * axis
    return tips


class _Frame(NamedTuple):
    """A frame in n configurations: axes and origin, each (n, 3)."""

    x: FloatArray
    y: FloatArray
    z: FloatArray
    origin: FloatArray

    def moved(self, by: RigidTransform) -> _Frame:
        """The frame after a fixed transform."""
        if by.is_identity:
            return self
        axes = np.stack((self.x, self.y, self.z), axis=2) @ by.matrix[:3]
        x, y, z, way = np.moveaxis(axes, 2, 0)
        return _Frame(x, y, z, self.origin + way)


class _Link(NamedTuple):
    """A link: the frame about or along whose z its joint moves, where it bends, (n, 3), and the frame at its end."""

    start: _Frame
    bend: FloatArray
    end: _Frame


def _links(arm: Arm, positions: FloatArray) -> list[_Link]:
    """Every link at `positions` (n, n_joints), and the tool, seen from the paper. Each standard DH row is
    Rz(theta) Tz(d) Tx(a) Rx(alpha)."""
    end = _Frame(*(np.broadcast_to(column, (len(positions), 3)) for column in arm.paper.T_paper_base[:3].T))
    links = []
    for joint, value in zip(arm.joints, positions.T[:, :, None], strict=True):
        start = end.moved(joint.origin)
        turn, slide = (value, 0.0 * value) if joint.kind is JointKind.REVOLUTE else (0.0 * value, value)
        cosine, sine = np.cos(joint.theta_rad + turn), np.sin(joint.theta_rad + turn)
        x, y = cosine * start.x + sine * start.y, cosine * start.y - sine * start.x
        bend = start.origin + (joint.d_mm + slide) * start.z
        c, s = cos(joint.alpha_rad), sin(joint.alpha_rad)
        end = _Frame(x, c * y + s * start.z, c * start.z - s * y, bend + joint.a_mm * x)
        links.append(_Link(start, bend, end))
    return [*links, _Link(end, end.origin, end.moved(arm.tool))]
