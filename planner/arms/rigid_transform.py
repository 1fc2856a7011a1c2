"""A fixed transform between two frames of an arm: what no Denavit-Hartenberg row has to say."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from planner.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class RigidTransform:
    """`Txyz Rz(yaw) Ry(pitch) Rx(roll)`, as URDF has it: x_mm, y_mm, z_mm, and angles in rad."""

    x_mm: float = 0.0
    y_mm: float = 0.0
    z_mm: float = 0.0
    roll_rad: float = 0.0
    pitch_rad: float = 0.0
    yaw_rad: float = 0.0

    @property
    def is_identity(self) -> bool:
        return self == IDENTITY

    @property
    def length_mm(self) -> float:
        """How far apart the two origins are."""
        return float(np.linalg.norm((self.x_mm, self.y_mm, self.z_mm)))

    @property
    def matrix(self) -> FloatArray:
        """(4, 4), mm; exact zeros and ones where angles are right ones."""
        (cr, sr), (cp, sp), (cy, sy) = (
            (_exact(cos(angle)), _exact(sin(angle))) for angle in (self.roll_rad, self.pitch_rad, self.yaw_rad)
        )
        return np.array(
            [
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, self.x_mm],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, self.y_mm],
                [-sp, cp * sr, cp * cr, self.z_mm],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )

    @staticmethod
    def of(matrix: FloatArray) -> RigidTransform:
        """That of a rigid (4, 4). The roll is what is left after yaw and pitch, so that nothing is lost where the pitch
        is a right angle and the two turn about the same axis."""
        turn = matrix[:3, :3]
        yaw = np.arctan2(turn[1, 0], turn[0, 0])
        c, s = np.cos(yaw), np.sin(yaw)
        pitch = np.arctan2(-turn[2, 0], c * turn[0, 0] + s * turn[1, 0])
        roll = np.arctan2(s * turn[0, 2] - c * turn[1, 2], c * turn[1, 1] - s * turn[0, 1])
        x, y, z = matrix[:3, 3].tolist()
        return RigidTransform(x, y, z, float(roll), float(pitch), float(yaw))


IDENTITY = RigidTransform()


def _exact(value: float) -> float:
    rounded = round(value)
    return float(rounded) if abs(value - rounded) < 1e-15 else value
