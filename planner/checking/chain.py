"""Forward kinematics in plain NumPy, straight from the rows of the arm file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arms.rigid_transform import RigidTransform
from planner.arrays import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class ChainPoses:
    """Where the chain is in n configurations.

    All in the paper's frame. tip_mm: (3, n) of the pen. lowest_mm: (n,) the height of
    the lowest node of the links, the tip aside: links are straight between nodes, so no part of one is lower.
    tool: (3, n) direction of `pen.tool_axis`. nodes_mm: (n_nodes, 3, n) the nodes, from the base's
    origin to the tip; rows: of each segment between two of them, the row that it belongs to, -1 where that is the base.
    """

    tip_mm: FloatArray
    lowest_mm: FloatArray
    tool: FloatArray
    nodes_mm: FloatArray
    rows: tuple[int, ...]


def chain_poses(arm: Arm, positions: FloatArray, heights_mm: FloatArray | float = 0.0) -> ChainPoses:
    """Poses of positions (n, n_joints) in rad and mm. heights_mm: (n,), how far beyond the origin of the last frame the
    tip is along the tool, as the pens of a trajectory have it.

    Each row is Rz(theta) Tz(d) Tx(a) Rx(alpha), so the nodes of a link are the points reached after Tz(d)
    and after Tx(a), and where the next joint's origin or the tool is; a displacement that is always zero makes no node.
    """
    n = len(positions)
    # What the base is to the paper: the paper's place and turns undone.
    base = base_vectors(arm, np.column_stack((np.eye(3), [-arm.paper.x_mm, -arm.paper.y_mm, -arm.paper.z_mm])))
    x, y, z, node = (np.repeat(column[:, np.newaxis], n, axis=1) for column in base.T)
    nodes, rows = [node], []
    for row, (joint, position) in enumerate(zip(arm.joints, positions.T, strict=True)):
        if joint.origin.length_mm:
            node = node + _shift(joint.origin, x, y, z)
            nodes.append(node)
            rows.append(row - 1)
        x, y, z = _turn(joint.origin, x, y, z)
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
        offset = z
        cosine, sine = np.cos(joint.alpha_rad), np.sin(joint.alpha_rad)
        y, z = cosine * y + sine * z, cosine * z - sine * y
    if arm.tool.length_mm:
        node = node + _shift(arm.tool, x, y, z)
        nodes.append(node)
        rows.append(arm.n_joints - 1)
    x, y, z = _turn(arm.tool, x, y, z)
    along_x, along_y, along_z = arm.pen.tool_axis
    tool = along_x * x + along_y * y + along_z * z
    if np.any(heights_mm):
        node = nodes[-1] = node + heights_mm * tool
        # Of a last link along d and then along a, its bend goes as far along d.
        if rows[-2:] == [row, row] and not arm.tool.length_mm:
            nodes[-2] = nodes[-2] + heights_mm * (tool * offset).sum(axis=0) * offset
    corners = np.stack(nodes)
    heights = (corners[:-1] if rows else corners)[:, 2].copy()
    heights[0] = np.maximum(heights[0], 0.0)  # the base stands beside the paper
    lowest = heights.min(axis=0)
    return ChainPoses(node, lowest, tool, corners, tuple(rows))


def _shift(by: RigidTransform, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    """(3, n) the way of a transform along axes (3, n)."""
    way: FloatArray = by.x_mm * x + by.y_mm * y + by.z_mm * z
    return way


def _turn(by: RigidTransform, x: FloatArray, y: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Axes (3, n) turned about their own z by the yaw, then about y by the pitch, then about x by the roll."""
    c, s = np.cos(by.yaw_rad), np.sin(by.yaw_rad)
    x, y = c * x + s * y, c * y - s * x
    c, s = np.cos(by.pitch_rad), np.sin(by.pitch_rad)
    z, x = c * z + s * x, c * x - s * z
    c, s = np.cos(by.roll_rad), np.sin(by.roll_rad)
    return x, c * y + s * z, c * z - s * y


def base_vectors(arm: Arm, vectors: FloatArray) -> FloatArray:
    """(3, n) vectors of the base frame as the paper's, which is turned by Rz(yaw), then Ry(tilt_y), then Rx(tilt_x):
    undone, the last one first."""
    yaw, tilt_y, tilt_x = arm.paper.yaw_rad, arm.paper.tilt_y_rad, arm.paper.tilt_x_rad
    a, b, c = vectors
    a, b = np.cos(yaw) * a + np.sin(yaw) * b, np.cos(yaw) * b - np.sin(yaw) * a
    a, c = np.cos(tilt_y) * a - np.sin(tilt_y) * c, np.cos(tilt_y) * c + np.sin(tilt_y) * a
    b, c = np.cos(tilt_x) * b + np.sin(tilt_x) * c, np.cos(tilt_x) * c - np.sin(tilt_x) * b
    return np.stack((a, b, c))
