"""What the page shows of an arm."""

from __future__ import annotations

from typing import Any

import numpy as np

from planner.arms.arm import Arm
from planner.arms.description import arm_description
from planner.arms.usual_servos import describes_servos
from planner.error_model.over_paper import expected_error
from planner.errors import PlanError
from planner.kinematics.sensitivity import sideways_error
from planner.redundancy.arm_model import ArmModel
from planner.workspace.paper_map import paper_nodes
from planner.workspace.reach import paper_in_reach


def arm_view(arm: Arm) -> dict[str, Any]:
    """The arm's description with its canvas, its home, and a map of its error over the paper, null out of reach: what
    is expected, mm, where the file says how joints are moved, else mm for each degree that a joint is off. Plain values
    for JSON."""
    model = ArmModel(arm)
    try:
        paper, nodes = paper_in_reach(model), paper_nodes(model)
    except PlanError as error:
        return arm_description(arm) | {"canvas_mm": None, "refusal": str(error)}
    figure = expected_error if describes_servos(arm) else sideways_error
    over_paper = nodes.map_of(figure(arm, nodes.joints))
    home = arm.complete(model.configuration_map().home[None])
    return arm_description(arm) | {
        "canvas_mm": paper.corners_arm_mm.round(3).tolist(),
        "reach_mm": [round(edge, 3) for edge in paper.reach_mm],
        "base_mm": arm.paper.T_paper_base[:2, 3].round(3).tolist(),
        "home": (home[0] / arm.per_file_unit).round(4).tolist(),
        "map": {
            "x_mm": nodes.x_mm.round(2).tolist(),
            "y_mm": nodes.y_mm.round(2).tolist(),
            "error_mm": [[None if np.isnan(cell) else round(float(cell), 4) for cell in row] for row in over_paper],
            "is_expected": describes_servos(arm),
        },
    }
