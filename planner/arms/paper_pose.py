"""Where the paper lies, seen from the arm's base."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np

from planner.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class PaperPose:
    """The paper's frame in the base frame: drawings lie in its plane z = 0, heights are counted along its z.

    x_mm, y_mm, z_mm: its origin. `R_base_paper = Rz(yaw) Ry(tilt_y) Rx(tilt_x)`, angles in rad. All zero: the paper is
    the plane z = 0 of the base frame.
    """

    x_mm: float = 0.0
    y_mm: float = 0.0
    z_mm: float = 0.0
    yaw_rad: float = 0.0
    tilt_x_rad: float = 0.0
    tilt_y_rad: float = 0.0

    @property
    def is_base_plane(self) -> bool:
        return self == BASE_PLANE

    @property
    def T_base_paper(self) -> FloatArray:
        """(4, 4), mm."""
        (ca, sa), (cb, sb), (cg, sg) = (
            (cos(angle), sin(angle)) for angle in (self.yaw_rad, self.tilt_y_rad, self.tilt_x_rad)
        )
        return np.array(
            [
                [ca * cb, ca * sb * sg - sa * cg, ca * sb * cg + sa * sg, self.x_mm],
                [sa * cb, sa * sb * sg + ca * cg, sa * sb * cg - ca * sg, self.y_mm],
                [-sb, cb * sg, cb * cg, self.z_mm],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )

    @property
    def T_paper_base(self) -> FloatArray:
        """(4, 4), mm."""
        forth = self.T_base_paper
        back = np.eye(4)
        back[:3, :3] = forth[:3, :3].T
        back[:3, 3] = -forth[:3, :3].T @ forth[:3, 3]
        return back

    def raised(self, height_mm: float) -> PaperPose:
        """So much higher, straight up from the base."""
        return replace(self, z_mm=self.z_mm + height_mm)

    @staticmethod
    def of(T_base_paper: FloatArray) -> PaperPose:
        """The pose of a rigid transform (4, 4) whose tilts stay below a right angle."""
        turn = T_base_paper[:3, :3]
        x, y, z = T_base_paper[:3, 3].tolist()
        return PaperPose(
            x,
            y,
            z,
            float(np.arctan2(turn[1, 0], turn[0, 0])),
            float(np.arctan2(turn[2, 1], turn[2, 2])),
            float(np.arctan2(-turn[2, 0], np.hypot(turn[2, 1], turn[2, 2]))),
        )

    def to_base(self, points_mm: FloatArray) -> FloatArray:
        """(..., 3) points of the paper's frame in the base frame."""
        forth = self.T_base_paper
        moved: FloatArray = points_mm @ forth[:3, :3].T + forth[:3, 3]
        return moved


BASE_PLANE = PaperPose()
"""The paper of an arm whose file says nothing of it."""
