"""An arm as plain values for JSON, in the units of its file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from planner.arms.arm import Arm
from planner.arms.coupling_section import coupling_values
from planner.arms.frame_section import frame_values
from planner.json_numbers import rounded


def arm_description(arm: Arm) -> dict[str, Any]:
    """Name, joints with their limits, DH rows, couplings and pen, in degrees, millimetres and seconds.

    A coupling reads joint = constant_deg + sum of coefficients[other] * other (constant_mm where the joint slides).
    Figures are rounded to nine decimals, so that a degree that went through radians comes back as it was. A joint has
    `thickness_mm` where the file gives it, a row its `origin` and the arm its `tool` where they are more than nothing.
    """
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
            | ({} if joint.origin.is_identity else {"origin": _rounded(frame_values(joint.origin))})
            for joint in arm.joints
        ],
        "coupling": [_rounded(coupling_values(coupling, arm.joints)) for coupling in arm.couplings],
        "pen": {"lift_mm": arm.pen.lift_mm, "clearance_mm": arm.pen.clearance_mm},
    } | ({} if arm.tool.is_identity else {"tool": _rounded(frame_values(arm.tool))})


def _rounded(values: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers, in tables too, as they are told in JSON; texts as they are."""
    return {
        key: _rounded(value) if isinstance(value, Mapping) else value if isinstance(value, str) else rounded(value)
        for key, value in values.items()
    }
