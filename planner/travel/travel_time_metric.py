"""Paper points as configurations, so that the distance between them tells how long the arm travels."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from planner.arrays import FloatArray
from planner.redundancy.arm_model import ArmModel
from planner.redundancy.configuration_map import branch_references


def travel_time_metric(model: ArmModel) -> Callable[[FloatArray], FloatArray]:
    """From points (n, 2) in mm to all joints (n, n_joints) of the map's configurations there, over their jerk limits.

    A short move from rest to rest takes `(32 |dq| / jerk)^(1/3)`, whatever the speed and acceleration limits.
    Errors: PlanError where the arm has no configuration map.
    """
    arm, branches = model.arm, model.branches()

    def embed(points_mm: FloatArray) -> FloatArray:
        configurations = branch_references(
            branches, np.column_stack((points_mm, np.zeros(len(points_mm)))), np.arange(len(points_mm))
        )
        mapped: FloatArray = arm.complete(configurations) / arm.max_jerk
        return mapped

    return embed
