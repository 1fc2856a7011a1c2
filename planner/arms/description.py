"""An arm as plain values for JSON, in the units of its file."""

from __future__ import annotations

import math
from typing import Any

from planner.arms.arm import Arm
from planner.json_numbers import rounded


def arm_description(arm: Arm) -> dict[str, Any]:
    """Name, joints with their limits, DH rows, couplings and pen, in degrees, millimetres and seconds.

    A coupling reads joint = constant_deg + sum of coefficients[other] * other. Figures are rounded to nine
    decimals, so that a degree that went through radians comes back as it was. A joint has `thickness_mm` where the
    file gives it.
    """
    names = [joint.name for joint in arm.joints]
    return {
        "name": arm.name,
        "joints": [
            {
                "name": joint.name,
                "kind": joint.kind.value,
                "unit": joint.file_unit,
                "min": rounded(joint.minimum / joint.per_file_unit),
                "max": rounded(joint.maximum / joint.per_file_unit),
                "max_velocity": rounded(joint.max_velocity / joint.per_file_unit),
                "max_acceleration": rounded(joint.max_acceleration / joint.per_file_unit),
                "max_jerk": rounded(joint.max_jerk / joint.per_file_unit),
            }
            | ({} if joint.thickness_mm is None else {"thickness_mm": joint.thickness_mm})
            for joint in arm.joints
        ],
        "dh": [
            {
                "theta_deg": rounded(math.degrees(joint.theta_rad)),
                "d_mm": rounded(joint.d_mm),
                "a_mm": rounded(joint.a_mm),
                "alpha_deg": rounded(math.degrees(joint.alpha_rad)),
            }
            for joint in arm.joints
        ],
        "coupling": [
            {
                "joint": names[coupling.joint],
                "constant_deg": rounded(math.degrees(coupling.constant_rad)),
                "coefficients": {names[other]: rounded(value) for other, value in coupling.coefficients},
            }
            for coupling in arm.couplings
        ],
        "pen": {"lift_mm": arm.pen.lift_mm, "clearance_mm": arm.pen.clearance_mm},
    }
