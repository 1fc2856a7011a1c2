"""Closed form of the SCARA: two links turn in the plane, a joint slides along their axis, the last turns the tool.

`C2 = (x^2 + y^2 - a1^2 - a2^2) / (2 a1 a2)`, q2 = ± its angle, q1 from the triangle, `q4 = heading - q1 - q2`
(documents on the SCARA arm, inverse kinematics). Branches: the elbow angle above and below 0.
"""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import BoolArray, FloatArray
from planner.inverse_kinematics.closed_forms.branches import ELBOWS, Branches, solve_in_blocks
from planner.inverse_kinematics.closed_forms.dh_rows import Row, require_rows
from planner.inverse_kinematics.closed_forms.two_links import two_links

_LINK = Row((0.0,), d="any", a="link")
_ROWS = (_LINK, _LINK, Row((0.0,), d="any", kind=JointKind.PRISMATIC), Row((0.0,), d="any"))
_UPRIGHT = 1e-9
N_BRANCHES = 2


def at_tip(arm: Arm, tip_mm: FloatArray, heading_rad: FloatArray) -> Branches:
    """Both configurations with the tip at (n, 3) and the last frame's x axis turned by the heading (n,) from the
    azimuth of the tip (0 on the base axis). Errors: ArmFileError where the rows are of another form."""
    return _solve(arm, tip_mm, heading_rad, from_azimuth=True)


def at_pose(arm: Arm, pose: FloatArray) -> Branches:
    """Both configurations of each pose (n, 4, 4), in mm. A tilted pose has none, at a gap of inf, as this tool stays
    upright. Errors: ArmFileError where the rows are of another form."""
    branches = _solve(arm, pose[:, :3, 3], np.arctan2(pose[:, 1, 0], pose[:, 0, 0]), from_azimuth=False)
    tilted = (np.hypot(pose[:, 0, 2], pose[:, 1, 2]) > _UPRIGHT) | (pose[:, 2, 2] < 0.0)
    return Branches(
        np.where(tilted[:, None, None], np.nan, branches.configurations),
        np.where(tilted, np.inf, branches.gap_mm),
        branches.singular & ~tilted,
    )


def _solve(arm: Arm, tip_mm: FloatArray, heading_rad: FloatArray, *, from_azimuth: bool) -> Branches:
    require_rows(arm, "scara", _ROWS)
    shoulder, elbow_joint, *_ = arm.joints
    height = sum(joint.d_mm for joint in arm.joints)
    offset = sum(joint.theta_rad for joint in arm.joints)

    def solve(block: slice, out: FloatArray) -> tuple[FloatArray, BoolArray]:
        x, y, z = tip_mm[block].T
        triangle = two_links(x, y, shoulder.a_mm, elbow_joint.a_mm)
        unreachable = triangle.gap_mm > 0.0
        heading = heading_rad[block] - offset
        if from_azimuth:
            heading += triangle.direction_rad
        for elbow, rows in zip(ELBOWS, out, strict=True):
            np.multiply(triangle.lead_rad, -elbow, out=rows[0])
            rows[0] += triangle.direction_rad - shoulder.theta_rad
            np.multiply(triangle.bend_rad, elbow, out=rows[1])
            rows[1] -= elbow_joint.theta_rad
            np.subtract(z, height, out=rows[2])
            np.subtract(heading, rows[0], out=rows[3])
            rows[3] -= rows[1]
            if unreachable.any():
                rows[:, unreachable] = np.nan
        return triangle.gap_mm, triangle.singular

    return solve_in_blocks(arm, len(tip_mm), N_BRANCHES, solve)
