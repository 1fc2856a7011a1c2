"""Closed-form inverse kinematics, one file a family of arms, found through one table.

A family gives all branches for many targets at once: `at_tip` for drawing, where a redundancy may be
left, and `at_pose` where the arm has a whole pose to meet.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import UsageError
from planner.inverse_kinematics.closed_forms import drawing_arm, scara, six_joint, stanford, three_joint
from planner.inverse_kinematics.closed_forms.branches import Branches
from planner.inverse_kinematics.closed_forms.selection import AtTip, selected_configurations

References = Callable[[Arm, FloatArray], FloatArray]
"""Arm and tips (n, 3) in mm to independent joints (n, n_independent), NaN where no configuration exists."""

AtPose = Callable[[Arm, FloatArray], Branches]
"""Arm and poses (n, 4, 4), mm, to all configurations."""


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


def closed_form_configurations(arm: Arm) -> References:
    """Reference configurations for drawing, by the arm's closed form. Errors: UsageError where it has none."""
    family = family_of(arm)

    def references(arm: Arm, tip_mm: FloatArray) -> FloatArray:
        return selected_configurations(arm, family.at_tip, family.redundancy is not None, tip_mm)

    return references
