"""Where the paper lies, seen from the arm's base."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.arms.rigid_transform import RigidTransform
from planner.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class PaperPose:
    """The paper's frame in the base frame: drawings lie in its plane z = 0, heights are counted along its z.

    Its z, the normal, is on the side that is drawn on, where the arm is. For who looks at that side with x up, y is on
    the left: so the page of a drawing has its top at high x. x_mm, y_mm, z_mm: the origin. `R_base_paper = Rz(yaw)
    Ry(tilt_y) Rx(tilt_x)`, angles in rad. All zero: the paper is the plane z = 0 of the base frame.
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
        x, y, z = self.x_mm, self.y_mm, self.z_mm
        return RigidTransform(x, y, z, self.tilt_x_rad, self.tilt_y_rad, self.yaw_rad).matrix

    @property
    def T_paper_base(self) -> FloatArray:
        """(4, 4), mm."""
        forth = self.T_base_paper
        back = np.eye(4)
        back[:3, :3] = forth[:3, :3].T
        back[:3, 3] = -forth[:3, :3].T @ forth[:3, 3]
        return back

    @property
    def normal(self) -> FloatArray:
        """(3,) out of the side that is drawn on, in the base frame."""
        normal: FloatArray = self.T_base_paper[:3, 2]
        return normal

    def moved(self, by_mm: FloatArray) -> PaperPose:
        """Elsewhere by a vector (3,) of the base frame, turned as before."""
        x, y, z = by_mm.tolist()
        return replace(self, x_mm=self.x_mm + x, y_mm=self.y_mm + y, z_mm=self.z_mm + z)

    @staticmethod
    def of(T_base_paper: FloatArray) -> PaperPose:
        """The pose of a rigid transform (4, 4), tilt_y no more than a right angle. At a right angle, where yaw and
        tilt_x turn about the same axis, tilt_x is zero."""
        turn = T_base_paper[:3, :3]
        x, y, z = T_base_paper[:3, 3].tolist()
        level = np.hypot(turn[0, 0], turn[1, 0])
        upright = level < _UPRIGHT
        yaw = np.arctan2(-turn[0, 1], turn[1, 1]) if upright else np.arctan2(turn[1, 0], turn[0, 0])
        c, s = np.cos(yaw), np.sin(yaw)  # the yaw is undone, so that tilt_x makes up for how little it is known
        tilt_x = np.arctan2(s * turn[0, 2] - c * turn[1, 2], c * turn[1, 1] - s * turn[0, 1])
        return PaperPose(x, y, z, float(yaw), float(tilt_x), float(np.arctan2(-turn[2, 0], level)))

    def to_base(self, points_mm: FloatArray) -> FloatArray:
        """(..., 3) points of the paper's frame in the base frame."""
        forth = self.T_base_paper
        moved: FloatArray = points_mm @ forth[:3, :3].T + forth[:3, 3]
        return moved


_UPRIGHT = 1e-9
"""Cosine of a tilt that is a right angle but for rounding."""

BASE_PLANE = PaperPose()
"""The paper of an arm whose file says nothing of it."""
