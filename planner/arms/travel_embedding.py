"""Paper points as postures, so that the distance between them tells how long the arm travels."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from planner.arms.arm import Arm
from planner.arms.posture_field import posture_sheets, sheet_references
from planner.arrays import FloatArray


def travel_embedding(arm: Arm) -> Callable[[FloatArray], FloatArray]:
    """From points (n, 2) in mm to all joints (n, n_joints) of the field's postures there, over their jerk limits.

    A short move from rest to rest takes `(32 |dq| / jerk)^(1/3)`, whatever the speed and acceleration limits.
    Errors: PlanError where the arm has no posture field.
    """
    sheets = posture_sheets(arm)

    def embed(points_mm: FloatArray) -> FloatArray:
        postures = sheet_references(sheets, np.column_stack((points_mm, np.zeros(len(points_mm)))),
                                    np.arange(len(points_mm)))
        embedded: FloatArray = arm.complete(postures) / arm.max_jerk
        return embedded

    return embed
