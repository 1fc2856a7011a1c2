"""Configurations with the pen in the air above places on the paper."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.errors import PlanError
from planner.inverse_kinematics.stroke_configurations import exact_configurations
from planner.kinematics.limits import Limits
from planner.motion.timed_stroke import Contact
from planner.redundancy.arm_model import ArmModel
from planner.travel.travel_moves import TravelRules, plan_travel_moves


def raised_configurations(model: ArmModel, rules: TravelRules, places_mm: FloatArray) -> FloatArray:
    """(n, n_joints) at the lift height above places (n, 2), arm mm. Errors: PlanError where one is out of reach."""
    tips = np.column_stack((places_mm, np.zeros(len(places_mm))))
    branch = next((branch for branch in model.branches() if branch.reaches(places_mm).all()), model.branches()[0])
    independent, infeasible = exact_configurations(model.kinematics, branch.configurations_at(tips)[0], tips)
    if infeasible:
        x, y = places_mm[infeasible[0].path]
        raise PlanError(f"the pen cannot go above ({x:.1f}, {y:.1f}) mm: {infeasible[0].reason}")
    contacts = [Contact(place, configuration) for place, configuration in zip(places_mm, independent, strict=True)]
    nowhere = [None] * len(contacts)
    moves = plan_travel_moves(model.kinematics, Limits.of(model.arm), rules, nowhere, contacts)
    return np.array([move.joints[0] for move in moves])
