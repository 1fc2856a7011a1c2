"""The part of the paper that an arm can use, for its description and for the picture of a drawing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.redundancy.arm_model import ArmModel
from planner.workspace.canvas import usable_canvas


@dataclass(frozen=True, eq=False, slots=True)
class PaperInReach:
    """reach_mm: least and greatest distance of the pen from the base, on the paper. is_ring: whether all between these
    is reached, as far as the arm turns. width_mm, height_mm and corners_arm_mm (4, 2): the largest rectangle that the
    arm draws on without trouble."""

    reach_mm: tuple[float, float]
    is_ring: bool
    width_mm: float
    height_mm: float
    corners_arm_mm: FloatArray

    @property
    def ring_mm(self) -> tuple[float, float] | None:
        """The inner and outer radius of what is reached, where that is a ring."""
        return self.reach_mm if self.is_ring else None


def paper_in_reach(model: ArmModel) -> PaperInReach:
    """Found numerically, in about half a second. Errors: PlanError where the arm has no canvas."""
    canvas = usable_canvas(model, model.arm.pen.lift_mm)
    rings = model.rings()
    if rings:
        reach_mm = min(float(ring.radii_mm[0]) for ring in rings), max(float(ring.radii_mm[-1]) for ring in rings)
    else:
        base_mm = model.arm.paper.T_paper_base[:2, 3]
        away_mm = np.concatenate(
            [np.linalg.norm(branch.grid.tips_mm[branch.known, :2] - base_mm, axis=1) for branch in model.planes()]
        )
        reach_mm = float(away_mm.min()), float(away_mm.max())
    return PaperInReach(reach_mm, bool(rings), canvas.width_mm, canvas.height_mm, canvas.corners_arm_mm)
