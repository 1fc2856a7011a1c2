"""Spherical wrist: three joints whose axes meet in a point take any orientation in two ways."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.inverse_kinematics.closed_forms.dh_rows import Row

_ALIGNED = 1e-12
_SINGULAR = 1e-9
"""Sine of the middle joint's angle below which the outer two axes are one, and below which they count as
singular: rounding of the joints before the wrist lies between."""


@dataclass(frozen=True, eq=False, slots=True)
class WristAngles:
    """Theta of the three wrist rows, (n,): this solution, and its twin `(t4 + pi, -t5, t6 + pi)`. Where the axes
    are aligned (flagged within rounding) only t4 + t6 (or their difference) is determined: t4 is 0 there."""

    theta_rad: tuple[FloatArray, FloatArray, FloatArray]
    aligned: BoolArray


def wrist_rows(arm: Arm) -> tuple[Row, Row, Row]:
    """The form of rows 4 to 6: right angles, the second undoing the first, and lengths along the outer axes alone."""
    undone = -90.0 if arm.n_joints > 3 and arm.joints[3].alpha_rad > 0 else 90.0
    return Row((90.0, -90.0), d="any"), Row((undone,)), Row((0.0,), d="any")


def wrist_angles(
    rotation: FloatArray,
    waist_rad: FloatArray,
    waist_twist: float,
    plane_rad: FloatArray,
    plane_twist: float,
    wrist_twist: float,
) -> WristAngles:
    """Angles that complete `Rz(waist) Rx(s1 90°) Rz(plane) Rx(s2 90°)` to the rotation, by
    `Rz(t4) Rx(-s3 90°) Rz(t5) Rx(s3 90°) Rz(t6)`, a turn about z, about s3 y and about z.

    rotation: (3, 3, n), row, column, target; the twists s1, s2, s3 are the signs of the right angles. t6 follows
    from t4, not by itself, so that the pose is met even where t4 is ill-conditioned.
    """
    c1, s1 = np.cos(waist_rad), np.sin(waist_rad)
    cp, sp = np.cos(plane_rad), np.sin(plane_rad)

    def in_forearm(column: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """A column of the rotation, seen from the frame before the wrist."""
        x, y, z = rotation[:, column]
        ahead, aside, up = c1 * x + s1 * y, waist_twist * (s1 * x - c1 * y), waist_twist * z
        return cp * ahead + sp * up, plane_twist * aside, plane_twist * (sp * ahead - cp * up)

    approach = in_forearm(2)
    sine = np.hypot(approach[0], approach[1])
    aligned = sine < _ALIGNED
    safe = np.where(aligned, 1.0, sine)
    c4, s4 = np.where(aligned, 1.0, approach[0] / safe), np.where(aligned, 0.0, approach[1] / safe)
    normal, sliding = in_forearm(0), in_forearm(1)
    theta = (
        np.arctan2(s4, c4),
        wrist_twist * np.arctan2(sine, approach[2]),
        np.arctan2(c4 * normal[1] - s4 * normal[0], c4 * sliding[1] - s4 * sliding[0]),
    )
    return WristAngles(theta, sine < _SINGULAR)


def fill_wrist(rows: FloatArray, wrist: WristAngles, offsets_rad: Sequence[float]) -> None:
    """Write the joints of the wrist, and of its twin, into the last three columns of rows (2, n_joints, n)."""
    t4, t5, t6 = wrist.theta_rad
    for row, flip, sign in ((rows[0], 0.0, 1.0), (rows[1], np.pi, -1.0)):
        row[3] = t4 + (flip - offsets_rad[0])
        row[4] = sign * t5 - offsets_rad[1]
        row[5] = t6 + (flip - offsets_rad[2])


def targets_and_wrist_centres(pose: FloatArray, tool_mm: float) -> tuple[FloatArray, FloatArray]:
    """Rotations (3, 3, n) and wrist centres `p - l a` (3, n), mm, of poses (n, 4, 4): targets run last."""
    columns = np.ascontiguousarray(pose[:, :3, :].transpose(1, 2, 0))
    return columns[:, :3], columns[:, 3] - tool_mm * columns[:, 2]
