"""The part of the paper that an arm can use, for its description and for the picture of a drawing."""

from __future__ import annotations

from dataclasses import dataclass

from planner.arrays import FloatArray
from planner.redundancy.arm_model import ArmModel
from planner.workspace.canvas import usable_canvas


@dataclass(frozen=True, eq=False, slots=True)
class PaperInReach:
    """reach_mm: least and greatest distance of the pen from the base, on the paper. width_mm, height_mm and
    corners_arm_mm (4, 2): the largest rectangle that the arm draws on without trouble."""

    reach_mm: tuple[float, float]
    width_mm: float
    height_mm: float
    corners_arm_mm: FloatArray


def paper_in_reach(model: ArmModel) -> PaperInReach:
    """Found numerically, in about half a second. Errors: PlanError where the arm has no canvas."""
    branches = model.branches()
    reach_mm = (
        min(float(branch.radii_mm[0]) for branch in branches),
        max(float(branch.radii_mm[-1]) for branch in branches),
    )
    canvas = usable_canvas(model, model.arm.pen.lift_mm)
    return PaperInReach(reach_mm, canvas.width_mm, canvas.height_mm, canvas.corners_arm_mm)
