"""Closed form of the drawing arm: a turning base, three parallel joints, and a link that hangs upright.

The coupling holds the last link's direction, so the end of link 4 is known from the tip. Given the pitch
phi = q2 + q3 + q4 of link 4, the arm's redundancy, the end of link 3 is known too, and q2, q3 follow from a
triangle (documents on the drawing arm, inverse kinematics; here with lateral offsets and joint offsets).
Branches: in front and over its back, each with the elbow angle q3 above and below 0.
"""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.errors import ArmFileError
from planner.inverse_kinematics.closed_forms.branches import ELBOWS, Branches, solve_in_blocks
from planner.inverse_kinematics.closed_forms.dh_rows import Row, require_rows, sign_of_twist
from planner.inverse_kinematics.closed_forms.two_links import two_links
from planner.inverse_kinematics.closed_forms.waist import face

_LINK = Row((0.0,), d="any", a="link")
_ROWS = (
    Row((90.0, -90.0), d="any", a="any"),
    _LINK,
    _LINK,
    Row((0.0,), d="any", a="any"),
    Row((0.0,), d="any", a="any"),
)
N_BRANCHES = 4


def at_tip(arm: Arm, tip_mm: FloatArray, pitch_rad: FloatArray) -> Branches:
    """All configurations with the tip at (n, 3) and link 4 at the pitch (n,) from the horizontal, towards alpha of row
    1.
    Errors: ArmFileError where the rows are of another form."""
    pen_direction = _pen_direction(arm)
    base, upper, fore, wrist, pen = arm.joints
    twist = sign_of_twist(base)
    left = -twist * sum(joint.d_mm for joint in arm.joints[1:])
    ahead = base.a_mm + pen.a_mm * np.cos(pen_direction)
    raised = pen.a_mm * np.sin(pen_direction)

    def solve(block: slice, out: FloatArray) -> tuple[FloatArray, BoolArray]:
        x, y, z = tip_mm[block].T
        pitch = pitch_rad[block]
        sides = face(x, y, left)
        singular = sides.singular
        gaps = []
        inner = wrist.a_mm * np.cos(pitch)
        inner += ahead
        up = twist * (z - base.d_mm)
        up -= raised
        up -= wrist.a_mm * np.sin(pitch)
        for side in range(2):
            triangle = two_links(sides.along_mm[side] - inner, up, upper.a_mm, fore.a_mm)
            singular = singular | triangle.singular
            gap = np.maximum(sides.gap_mm, triangle.gap_mm)
            gaps.append(gap)
            unreachable = gap > 0.0
            for elbow, rows in zip(ELBOWS, out[2 * side : 2 * side + 2], strict=True):
                np.subtract(sides.theta_rad[side], base.theta_rad, out=rows[0])
                np.multiply(triangle.lead_rad, -elbow, out=rows[1])
                rows[1] += triangle.direction_rad
                np.multiply(triangle.bend_rad, elbow, out=rows[2])
                np.subtract(pitch, rows[1], out=rows[3])
                rows[3] -= rows[2]
                rows[1] -= upper.theta_rad
                rows[2] -= fore.theta_rad
                rows[3] -= wrist.theta_rad
                if unreachable.any():
                    rows[:, unreachable] = np.nan
        return np.minimum(*gaps), singular

    return solve_in_blocks(arm, len(tip_mm), N_BRANCHES, solve)


def _pen_direction(arm: Arm) -> float:
    """Angle of the last link within the arm's plane, which the coupling holds: rad from the horizontal."""
    require_rows(arm, "drawing_arm", _ROWS, coupled=True)
    held = (
        len(arm.couplings) == 1
        and arm.couplings[0].joint == 4
        and (dict(arm.couplings[0].coefficients) == {1: -1.0, 2: -1.0, 3: -1.0})
    )
    if not held:
        raise ArmFileError(
            f"arm {arm.name}",
            ["coupling: the closed form 'drawing_arm' needs joint 5 coupled to joints 2, 3 and 4 by -1 each"],
        )
    return arm.couplings[0].constant + sum(joint.theta_rad for joint in arm.joints[1:])
