"""Closed form of the Stanford-type arm, by kinematic decoupling: waist and shoulder aim a sliding joint at the
wrist centre `p - d6 a`, and the spherical wrist takes the orientation (documents on the Stanford-type arm).

The slide meets the wrist centre with an extension above or below zero, the shoulder turned about. Branches, the
last changing fastest: extension positive and negative (those that the slide's range has), in front and over its
back, wrist plain and flipped; 8, or 4 where the extension has one sign.
"""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import BoolArray, FloatArray
from planner.inverse_kinematics.closed_forms.branches import Branches, solve_in_blocks
from planner.inverse_kinematics.closed_forms.dh_rows import Row, require_rows, sign_of_twist
from planner.inverse_kinematics.closed_forms.pointing import poses_pointing_down
from planner.inverse_kinematics.closed_forms.waist import face
from planner.inverse_kinematics.closed_forms.wrist import (
    fill_wrist,
    targets_and_wrist_centres,
    wrist_angles,
    wrist_rows,
)

_TURN = (90.0, -90.0)
_ROWS = (Row(_TURN, d="any", a="any"), Row(_TURN, d="any"), Row((0.0,), kind=JointKind.PRISMATIC, d="any"))
_AT_SHOULDER_MM = 1e-10


def at_tip(arm: Arm, tip_mm: FloatArray, spin_rad: FloatArray) -> Branches:
    """All configurations with the tip at (n, 3), the tool straight down and x of the last frame turned by the spin (n,)
    from the azimuth of the tip. Errors: ArmFileError where rows or tool axis are of another form."""
    return at_pose(arm, poses_pointing_down(arm, tip_mm, spin_rad))


def at_pose(arm: Arm, pose: FloatArray) -> Branches:
    """All configurations of each pose (n, 4, 4), in mm. Errors: ArmFileError where the rows are of another form."""
    require_rows(arm, "stanford", (*_ROWS, *wrist_rows(arm)))
    base, shoulder_joint, slide, forearm, wrist_joint, tool = arm.joints
    twist, slide_twist = sign_of_twist(base), sign_of_twist(shoulder_joint)
    wrist_twist = sign_of_twist(wrist_joint)
    offsets = [slide.theta_rad + forearm.theta_rad, wrist_joint.theta_rad, tool.theta_rad]
    left = -twist * shoulder_joint.d_mm
    fixed_mm = slide.d_mm + forearm.d_mm
    signs = extension_signs(arm)

    def solve(block: slice, out: FloatArray) -> tuple[FloatArray, BoolArray]:
        rotation, (x, y, z) = targets_and_wrist_centres(pose[block], tool.d_mm)
        sides = face(x, y, left)
        singular = sides.singular
        unreachable = sides.gap_mm > 0.0
        up = twist * (z - base.d_mm)
        for side, waist in enumerate(sides.theta_rad):
            along = sides.along_mm[side] - base.a_mm
            extension = np.hypot(along, up)
            at_shoulder = extension < _AT_SHOULDER_MM
            singular = singular | (at_shoulder & ~unreachable)
            for k, sign in enumerate(signs):
                # The slide points along -s2 (-sin, cos) of the shoulder's angle, s2 the sign of its twist.
                outward = -slide_twist * sign
                shoulder = np.where(at_shoulder, 0.0, np.arctan2(-outward * along, outward * up))
                wrist = wrist_angles(rotation, waist, twist, shoulder, slide_twist, wrist_twist)
                singular = singular | (wrist.aligned & ~unreachable)
                rows = out[4 * k + 2 * side : 4 * k + 2 * side + 2]
                rows[:, 0] = waist - base.theta_rad
                rows[:, 1] = shoulder - shoulder_joint.theta_rad
                rows[:, 2] = sign * extension - fixed_mm
                fill_wrist(rows, wrist, offsets)
                rows[:, :, unreachable] = np.nan
        return sides.gap_mm, singular

    return solve_in_blocks(arm, len(pose), 4 * len(signs), solve)


def extension_signs(arm: Arm) -> tuple[float, ...]:
    """The signs that the way from shoulder to wrist centre can have within the slide's range."""
    slide, forearm = arm.joints[2], arm.joints[3]
    fixed_mm = slide.d_mm + forearm.d_mm
    if slide.minimum + fixed_mm >= 0.0:
        return (1.0,)
    return (-1.0,) if slide.maximum + fixed_mm <= 0.0 else (1.0, -1.0)
