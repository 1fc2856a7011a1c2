"""Closed-form inverse kinematics, one file a family of arms, found through one table.

A family gives all branches for many targets at once: `at_tip` for drawing, where a redundancy may be
left, and `at_pose` where the arm has a whole pose to meet.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import UsageError
from planner.inverse_kinematics.closed_forms import drawing_arm, scara, six_joint, stanford, three_joint
from planner.inverse_kinematics.closed_forms.branches import Branches
from planner.inverse_kinematics.closed_forms.selection import AtTip, select

ClosedForm = Callable[[FloatArray], FloatArray]
"""Tips (n, 3) in mm to independent joints (n, n_independent), NaN where no configuration exists."""

AtPose = Callable[[Arm, FloatArray], Branches]
"""Arm and poses (n, 4, 4), mm, to all configurations."""


_LEVEL = float(np.cos(np.radians(5.0)))
"""Cosine of the tilt up to which a paper counts as level."""


@dataclass(frozen=True, slots=True)
class Family:
    """The closed form of a family; `redundancy` names what `at_tip` leaves to choose, if anything."""

    at_tip: AtTip
    at_pose: AtPose | None
    redundancy: str | None


FAMILIES: Mapping[str, Family] = {
    "drawing_arm": Family(drawing_arm.at_tip, None, "pitch of link 4"),
    "scara": Family(scara.at_tip, scara.at_pose, "heading from the azimuth"),
    "three_joint": Family(three_joint.at_tip, None, None),
    "six_joint": Family(six_joint.at_tip, six_joint.at_pose, "spin from the azimuth"),
    "stanford": Family(stanford.at_tip, stanford.at_pose, "spin from the azimuth"),
}


def family_of(arm: Arm) -> Family:
    """The closed form that the arm names. Errors: UsageError where it names none."""
    if arm.closed_form is None:
        raise UsageError(f"arm {arm.name} names no closed form (key closed_form in its file); other methods need none")
    return FAMILIES[arm.closed_form]


def closed_form_of(arm: Arm) -> ClosedForm:
    """The configurations that the arm's closed form draws with: one branch, chosen here, once. Errors: UsageError where
    the arm has no closed form, or not for how its paper is turned, PlanError where none of its configurations is within
    the joint limits."""
    at_tip, redundancy = family_of(arm).at_tip, family_of(arm).redundancy
    if arm.paper.normal[2] < _LEVEL:
        raise UsageError(
            f"arm {arm.name}: closed forms are for a paper that lies level, and [paper] tilts it by"
            f" {np.degrees(np.arccos(np.clip(arm.paper.normal[2], -1.0, 1.0))):.0f} degrees; other methods take any"
        )
    chosen = select(arm, at_tip, redundancy is not None)

    def configurations(tip_mm: FloatArray) -> FloatArray:
        in_base_mm = tip_mm if arm.paper.is_base_plane else arm.paper.to_base(tip_mm)
        radius = np.hypot(in_base_mm[:, 0], in_base_mm[:, 1])
        return at_tip(arm, in_base_mm, chosen.redundancy_at(radius)).configurations[:, chosen.branch]

    return configurations
