"""Places and configurations that a calibration pattern may have marks in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.errors import PlanError
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import within_limits
from planner.kinematics.link_clearance import KEPT_MM
from planner.kinematics.projection import project
from planner.redundancy.arm_model import ArmModel
from planner.redundancy.configuration_tests import LIMIT_MARGIN
from planner.settings import CanvasKind
from planner.workspace.canvas import canvas_of

_ROUNDS = 40
_COMING = 0.25
"""Of that spread: from so far around the arm comes down into a configuration, so that joints come from both sides."""
_SPREAD = 0.5
"""Of its range: up to so far from the map's configurations a joint is tried (standard deviation), where the arm has a
choice."""


@dataclass(frozen=True, eq=False, slots=True)
class Candidates:
    """tips_mm: (n, 2); free: (n, n_independent) configurations there; raised: (n, n_independent) at the lift height
    above, from which the arm comes down; drawn: (n, n_independent) what drawings are drawn in at the same places."""

    tips_mm: FloatArray
    free: FloatArray
    raised: FloatArray
    drawn: FloatArray

    def __len__(self) -> int:
        return len(self.tips_mm)

    def of(self, rows: BoolArray) -> Candidates:
        return Candidates(self.tips_mm[rows], self.free[rows], self.raised[rows], self.drawn[rows])


def candidates(model: ArmModel, margin_mm: float, count: int, random: np.random.Generator) -> Candidates:
    """So many places all over the usable canvas less a margin, the arm's redundancy used as widely as its limits
    allow, with room for the lift. Errors: PlanError where the arm has no canvas, or none that large."""
    arm, kinematics = model.arm, model.kinematics
    configuration_map = model.configuration_map()
    canvas = canvas_of(model, CanvasKind.USABLE, arm.pen.lift_mm)
    low = np.array([canvas.near_mm, canvas.right_mm]) + margin_mm
    high = np.array([canvas.far_mm, canvas.left_mm]) - margin_mm
    if (high <= low).any():
        raise PlanError(
            f"arm {arm.name}: its canvas of {canvas.width_mm:.0f} x {canvas.height_mm:.0f} mm is too small "
            f"for a pattern with a margin of {margin_mm:g} mm"
        )
    spread = _SPREAD * kinematics.independent_of(arm.maximum - arm.minimum)
    spread[0] = 0.0  # the azimuth is the place's
    found: list[Candidates] = []
    for _ in range(_ROUNDS):
        tips = np.column_stack((random.uniform(low, high, (count, 2)), np.zeros(count)))
        reference = configuration_map.reference(tips) + (
            random.uniform(0.0, 1.0, (count, 1)) * random.normal(0.0, spread, (count, kinematics.n_independent))
        )
        free, usable = project(kinematics, reference, tips)
        usable &= _kept(kinematics, free)
        over = np.where(usable[:, None], free, reference) + random.normal(0.0, _COMING * spread, free.shape)
        raised, risen = project(kinematics, over, tips + np.array([0.0, 0.0, arm.pen.lift_mm]))
        usable &= risen & _kept(kinematics, raised)
        drawn, exact = project(kinematics, configuration_map.reference(tips), tips)
        usable &= exact
        found.append(Candidates(tips[usable, :2], free[usable], raised[usable], drawn[usable]))
        if sum(map(len, found)) >= count:
            break
    whole = Candidates(
        *(
            np.concatenate(part)
            for part in zip(*((each.tips_mm, each.free, each.raised, each.drawn) for each in found), strict=True)
        )
    )
    return whole.of(np.arange(len(whole)) < count)


def _kept(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    """(n,) whether limits are kept with room to spare, and links apart from each other and above the paper."""
    arm = kinematics.arm
    kept = within_limits(arm, arm.complete(free), slack=-LIMIT_MARGIN * float((arm.maximum - arm.minimum).min()))
    kept &= kinematics.clearance.least_mm(free)[0] >= KEPT_MM
    return kept & (kinematics.nodes_mm(free)[:, :-1, 2] >= min(float(arm.paper.T_paper_base[2, 3]), 0.0)).all(axis=1)
