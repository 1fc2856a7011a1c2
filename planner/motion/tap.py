"""Strokes of one point: the pen rests there, and no more."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.inverse_kinematics.references import References
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath, colliding_paths, exact_configurations
from planner.motion.timed_stroke import Contact, TimedStroke
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings

_LEAST_S = 0.05
"""How long a tap rests on the paper at least: a pen needs a moment to leave a dot."""


def timed_taps(
    model: ArmModel, references: References, settings: PlanSettings, tips_mm: FloatArray
) -> list[TimedStroke | InfeasiblePath]:
    """The one joint sample of each tap (n, 2), arm mm, or why it cannot be drawn."""
    tips = np.column_stack((tips_mm, np.zeros(len(tips_mm))))
    independent, infeasible_paths = exact_configurations(model.kinematics, references.at(tips), tips)
    blocked = {infeasible_path.path: infeasible_path for infeasible_path in infeasible_paths}
    joints = model.arm.complete(independent)
    blocked = colliding_paths(model.kinematics, list(joints[:, None])) | blocked
    rest = max(round(max(settings.dwell_s, _LEAST_S) * settings.rate_hz), 1)
    contacts = [Contact(tip, configuration) for tip, configuration in zip(tips_mm, independent, strict=True)]
    return [
        blocked.get(index) or TimedStroke(joints[index : index + 1], contact, contact, rest)
        for index, contact in enumerate(contacts)
    ]
