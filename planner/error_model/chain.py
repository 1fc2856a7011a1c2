"""Where the tip is on the paper, and how that changes with everything that may be wrong: joints, lengths, the paper.

Plain NumPy over many configurations at once. The chain is standard Denavit-Hartenberg, `Rz(theta) Tz(d) Tx(a)
Rx(alpha)` a row, with a fixed transform before each and one after the last; the paper's pose in the base frame comes
before it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Geometry:
    """Lengths, twists and the pose of the base over the paper.

    theta, d_mm, a_mm, alpha: (n_joints,), rad and mm. revolute: (n_joints,). base: (6,) where the base frame stands in
    the paper's: x, y, z in mm, then yaw, and the turns about x and y after it, in rad:
    `R = Rz(yaw) Rx(tilt_x) Ry(tilt_y)`. origins: (n_joints, 4, 4) and tool: (4, 4), mm, are what they are.
    """

    theta: FloatArray
    d_mm: FloatArray
    a_mm: FloatArray
    alpha: FloatArray
    revolute: BoolArray
    base: FloatArray
    origins: FloatArray
    tool: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class TipChange:
    """Tips (m, 3) on the paper and their derivatives: by joints, d, a and alpha (m, 3, n_joints), by base (m, 3, 6)."""

    tip_mm: FloatArray
    by_joint: FloatArray
    by_d: FloatArray
    by_a: FloatArray
    by_alpha: FloatArray
    by_base: FloatArray


def rotation_of(yaw: float, tilt_x: float, tilt_y: float) -> FloatArray:
    """(3, 3) Rz(yaw) Rx(tilt_x) Ry(tilt_y)."""
    return _about(2, yaw) @ _about(0, tilt_x) @ _about(1, tilt_y)


def _about(axis: int, angle: float) -> FloatArray:
    c, s = np.cos(angle), np.sin(angle)
    turn: FloatArray = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turn[i, i] = turn[j, j] = c
    turn[i, j], turn[j, i] = -s, s
    return turn


def tips(geometry: Geometry, joints: FloatArray) -> TipChange:
    """The tips at joints (m, n_joints), rad or mm, and their derivatives.

    A turn about the axis z through the origin o moves the tip by z x (tip - o), a length by its direction.
    """
    m, n = joints.shape
    place = geometry.base[:3]
    yaw, tilt_x, tilt_y = geometry.base[3:].tolist()
    start = rotation_of(yaw, tilt_x, tilt_y)
    turn, origin = np.broadcast_to(start, (m, 3, 3)), np.broadcast_to(place, (m, 3))
    axes_z, axes_x, before, after = [], [], [], []
    for k in range(n):
        origin = origin + turn @ geometry.origins[k, :3, 3]
        turn = turn @ geometry.origins[k, :3, :3]
        revolute = bool(geometry.revolute[k])
        theta = geometry.theta[k] + (joints[:, k] if revolute else np.zeros(m))
        d_mm = geometry.d_mm[k] + (np.zeros(m) if revolute else joints[:, k])
        c, s = np.cos(theta), np.sin(theta)
        ca, sa = np.cos(geometry.alpha[k]), np.sin(geometry.alpha[k])
        axis_x = turn[..., 0] * c[:, None] + turn[..., 1] * s[:, None]
        axis_y = turn[..., 1] * c[:, None] - turn[..., 0] * s[:, None]
        axis_z = turn[..., 2]
        axes_z.append(axis_z)
        axes_x.append(axis_x)
        before.append(origin)
        origin = origin + d_mm[:, None] * axis_z + geometry.a_mm[k] * axis_x
        after.append(origin)
        turn = np.stack((axis_x, ca * axis_y + sa * axis_z, ca * axis_z - sa * axis_y), axis=2)
    origin = origin + turn @ geometry.tool[:3, 3]
    z, x = np.stack(axes_z, axis=2), np.stack(axes_x, axis=2)
    turned = np.cross(z, origin[:, :, None] - np.stack(before, axis=2), axis=1)
    twisted = np.cross(x, origin[:, :, None] - np.stack(after, axis=2), axis=1)
    by_joint = np.where(geometry.revolute, turned, z)
    arm = origin - place
    by_base = np.zeros((m, 3, 6))
    by_base[:, :, :3] = np.eye(3)
    after_yaw = _about(2, yaw)
    for column, axis in (
        (3, np.array([0.0, 0.0, 1.0])),
        (4, after_yaw[:, 0]),
        (5, (after_yaw @ _about(0, tilt_x))[:, 1]),
    ):
        by_base[:, :, column] = np.cross(axis, arm)
    return TipChange(np.array(origin), by_joint, z, x, twisted, by_base)
