"""Closed form of the three-joint arm: waist, shoulder and elbow place the tip, whose tilt is what it then is.

`q1 = atan2(y, x)` or behind; `cos q3 = (D^2 - l2^2 - l3^2) / (2 l2 l3)`; `q2 = atan2(z, ±r) - atan2(l3 s3, l2 + l3 c3)`
(documents on the three-joint arm, with atan2 for their arc tangents; here with lateral offsets).
Branches: in front and over its back, each with the elbow angle q3 above and below 0.
"""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.inverse_kinematics.closed_forms.branches import ELBOWS, Branches, solve_in_blocks
from planner.inverse_kinematics.closed_forms.dh_rows import Row, require_rows, sign_of_twist
from planner.inverse_kinematics.closed_forms.two_links import two_links
from planner.inverse_kinematics.closed_forms.waist import face

_ROWS = (Row((90.0, -90.0), d="any", a="any"), Row((0.0,), d="any", a="link"), Row(None, d="any", a="link"))
N_BRANCHES = 4


def at_tip(arm: Arm, tip_mm: FloatArray, unused_rad: FloatArray) -> Branches:
    """All configurations with the tip at (n, 3). Nothing is left to choose: the second argument is there as every
    family has it. Errors: ArmFileError where the rows are of another form."""
    require_rows(arm, "three_joint", _ROWS)
    base, upper, fore = arm.joints
    twist = sign_of_twist(base)
    left = -twist * (upper.d_mm + fore.d_mm)

    def solve(block: slice, out: FloatArray) -> tuple[FloatArray, BoolArray]:
        x, y, z = tip_mm[block].T
        sides = face(x, y, left)
        singular = sides.singular
        gaps = []
        up = twist * (z - base.d_mm)
        for side in range(2):
            triangle = two_links(sides.along_mm[side] - base.a_mm, up, upper.a_mm, fore.a_mm)
            singular = singular | triangle.singular
            gap = np.maximum(sides.gap_mm, triangle.gap_mm)
            gaps.append(gap)
            for elbow, rows in zip(ELBOWS, out[2 * side : 2 * side + 2], strict=True):
                rows[0] = sides.theta_rad[side] - base.theta_rad
                rows[1] = triangle.direction_rad - elbow * triangle.lead_rad - upper.theta_rad
                rows[2] = elbow * triangle.bend_rad - fore.theta_rad
                rows[:, gap > 0.0] = np.nan
        return np.minimum(*gaps), singular

    return solve_in_blocks(arm, len(tip_mm), N_BRANCHES, solve)
