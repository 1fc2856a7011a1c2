"""Forward kinematics in plain NumPy, straight from the Denavit-Hartenberg rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class ChainPoses:
    """Where the chain is in n configurations.

    tip_mm: (3, n) the origin of the last frame. lowest_mm: (n,) the height of the lowest node of the
    links, the tip aside: links are straight between nodes, so no part of one is lower.
    tool: (3, n) direction of `pen.tool_axis` in the base frame. nodes_mm: (n_nodes, 3, n) the nodes, from the base's
    origin to the tip; rows: of each segment between two of them, the row that it belongs to.
    """

    tip_mm: FloatArray
    lowest_mm: FloatArray
    tool: FloatArray
    nodes_mm: FloatArray
    rows: tuple[int, ...]


def chain_poses(arm: Arm, positions: FloatArray) -> ChainPoses:
    """Poses of positions (n, n_joints) in rad and mm.

    Each row is Rz(theta) Tz(d) Tx(a) Rx(alpha), so the nodes of a link are the points reached after Tz(d)
    and after Tx(a); a displacement that is always zero makes no node.
    """
    n = len(positions)
    x, y, z = (np.repeat(axis[:, np.newaxis], n, axis=1) for axis in np.eye(3))
    node = np.zeros((3, n))
    nodes, rows = [node], []
    for row, (joint, position) in enumerate(zip(arm.joints, positions.T, strict=True)):
        slides = joint.kind is JointKind.PRISMATIC
        theta = joint.theta_rad + (0.0 if slides else position)
        cosine, sine = np.cos(theta), np.sin(theta)
        x, y = cosine * x + sine * y, cosine * y - sine * x
        if slides or joint.d_mm:
            node = node + (joint.d_mm + (position if slides else 0.0)) * z
            nodes.append(node)
            rows.append(row)
        if joint.a_mm:
            node = node + joint.a_mm * x
            nodes.append(node)
            rows.append(row)
        cosine, sine = np.cos(joint.alpha_rad), np.sin(joint.alpha_rad)
        y, z = cosine * y + sine * z, cosine * z - sine * y
    along_x, along_y, along_z = arm.pen.tool_axis
    corners = np.stack(nodes)
    lowest = (corners[:-1] if rows else corners)[:, 2].min(axis=0)
    return ChainPoses(node, lowest, along_x * x + along_y * y + along_z * z, corners, tuple(rows))
