"""The configurations that drawings are drawn in, all over the paper: where errors count."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.kinematics.projection import project
from planner.redundancy.arm_model import ArmModel
from planner.settings import CanvasKind
from planner.workspace.canvas import canvas_of

_ACROSS, _AWAY = 14, 10
"""Places across the canvas and away from the arm, edges and corners included: most is left open there."""


def drawn_joints(model: ArmModel) -> FloatArray:
    """(n, n_joints) at places all over the usable canvas, pen on the paper.

    Errors: PlanError where the arm has no canvas.
    """
    canvas = canvas_of(model, CanvasKind.USABLE, model.arm.pen.lift_mm)
    x, y = np.meshgrid(
        np.linspace(canvas.near_mm, canvas.far_mm, _AWAY), np.linspace(canvas.right_mm, canvas.left_mm, _ACROSS)
    )
    places = np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size)))
    free, exact = project(model.kinematics, model.configuration_map().reference(places), places)
    joints: FloatArray = model.arm.complete(free[exact])
    return joints
