"""Closed form of the six-joint arm with a spherical wrist, by kinematic decoupling.

The wrist centre `pm = p - l4 a` depends on q1, q2, q3 alone: waist and triangle, as in the three-joint arm, except
that the forearm lies along z4. The wrist then takes the orientation (documents on the six-joint arm, decoupling;
here with lateral and elbow offsets). Branches, the last changing fastest: in front and over its back, elbow angle
above and below 0, wrist plain and flipped. The elbow angle is the one between upper arm and forearm.
"""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.inverse_kinematics.closed_forms.branches import ELBOWS, Branches, solve_in_blocks
from planner.inverse_kinematics.closed_forms.dh_rows import Row, require_rows, sign_of_twist
from planner.inverse_kinematics.closed_forms.pointing import poses_pointing_down
from planner.inverse_kinematics.closed_forms.two_links import two_links
from planner.inverse_kinematics.closed_forms.waist import face
from planner.inverse_kinematics.closed_forms.wrist import (
    fill_wrist,
    targets_and_wrist_centres,
    wrist_angles,
    wrist_rows,
)

_TURN = (90.0, -90.0)
_ROWS = (Row(_TURN, d="any", a="any"), Row((0.0,), d="any", a="link"), Row(_TURN, d="any", a="any"))
N_BRANCHES = 8


def at_tip(arm: Arm, tip_mm: FloatArray, spin_rad: FloatArray) -> Branches:
    """All configurations with the tip at (n, 3), the tool straight down and x of the last frame turned by the spin (n,)
    from the azimuth of the tip. Errors: ArmFileError where rows or tool axis are of another form."""
    return at_pose(arm, poses_pointing_down(arm, tip_mm, spin_rad))


def at_pose(arm: Arm, pose: FloatArray) -> Branches:
    """All configurations of each pose (n, 4, 4), in mm. Errors: ArmFileError where the rows are of another form."""
    require_rows(arm, "six_joint", (*_ROWS, *wrist_rows(arm)))
    base, upper, elbow_joint, forearm, wrist_joint, tool = arm.joints
    twist, forearm_twist = sign_of_twist(base), sign_of_twist(elbow_joint)
    wrist_twist = sign_of_twist(wrist_joint)
    left = -twist * (upper.d_mm + elbow_joint.d_mm)
    across = -forearm_twist * forearm.d_mm
    fore_mm, fore_angle = float(np.hypot(elbow_joint.a_mm, across)), float(np.arctan2(across, elbow_joint.a_mm))

    def solve(block: slice, out: FloatArray) -> tuple[FloatArray, BoolArray]:
        rotation, (x, y, z) = targets_and_wrist_centres(pose[block], tool.d_mm)
        sides = face(x, y, left)
        singular = sides.singular
        gaps = []
        up = twist * (z - base.d_mm)
        for side, waist in enumerate(sides.theta_rad):
            triangle = two_links(sides.along_mm[side] - base.a_mm, up, upper.a_mm, fore_mm)
            singular = singular | triangle.singular
            gap = np.maximum(sides.gap_mm, triangle.gap_mm)
            gaps.append(gap)
            for k, elbow in enumerate(ELBOWS):
                shoulder = triangle.direction_rad - elbow * triangle.lead_rad
                bend = elbow * triangle.bend_rad - fore_angle
                wrist = wrist_angles(rotation, waist, twist, shoulder + bend, forearm_twist, wrist_twist)
                singular = singular | (wrist.aligned & (gap == 0.0))
                rows = out[4 * side + 2 * k : 4 * side + 2 * k + 2]
                rows[:, 0] = waist - base.theta_rad
                rows[:, 1] = shoulder - upper.theta_rad
                rows[:, 2] = bend - elbow_joint.theta_rad
                fill_wrist(rows, wrist, [joint.theta_rad for joint in arm.joints[3:]])
                rows[:, :, gap > 0.0] = np.nan
        return np.minimum(*gaps), singular

    return solve_in_blocks(arm, len(pose), N_BRANCHES, solve)
