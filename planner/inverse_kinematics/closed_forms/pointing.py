"""Poses whose tool axis, z of the last frame, points straight down at the paper."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import ArmFileError


def poses_pointing_down(arm: Arm, tip_mm: FloatArray, spin_rad: FloatArray) -> FloatArray:
    """(n, 4, 4) poses at tips (n, 3) with `R = Rz(azimuth + spin) Rx(180°)`; the azimuth of a tip on the base axis
    is 0. Errors: ArmFileError where the arm's pen points along another axis."""
    if not np.allclose(arm.pen.tool_axis, (0.0, 0.0, 1.0), rtol=0, atol=1e-12):
        raise ArmFileError(
            f"arm {arm.name}",
            [
                f"pen.tool_axis: the closed form '{arm.closed_form}' needs z of the last frame, [0, 0, 1]"
                f" (value: {list(arm.pen.tool_axis)})"
            ],
        )
    heading = np.where(np.hypot(tip_mm[:, 0], tip_mm[:, 1]) < 1e-10, 0.0, np.arctan2(tip_mm[:, 1], tip_mm[:, 0]))
    heading = heading + spin_rad
    poses = np.zeros((len(tip_mm), 4, 4))
    poses[:, 0, 0] = np.cos(heading)
    poses[:, 1, 0] = poses[:, 0, 1] = np.sin(heading)
    poses[:, 1, 1] = -poses[:, 0, 0]
    poses[:, 2, 2] = -1.0
    poses[:, :3, 3] = tip_mm
    poses[:, 3, 3] = 1.0
    return poses
