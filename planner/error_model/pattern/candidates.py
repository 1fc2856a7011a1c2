"""Places and configurations that a calibration pattern may have marks in."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.error_model.pattern.touch import Heights
from planner.error_model.sheet.layout import drawable_mm
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
_COMING = 0.6
"""Of that spread: from so far around the arm comes down into a configuration, so that joints come from both sides."""
_WAYS = np.array([[0.0, 1.0], [0.0, -1.0], [1.0, 0.0], [-1.0, 0.0]])
"""Of strokes, so that joints come to their marks from both sides."""
_ROUNDING_MM = 1e-6
_SPREAD = 0.5
"""Of its range: up to so far from the map's configurations a joint is tried (standard deviation), where the arm has a
choice."""


@dataclass(frozen=True, eq=False, slots=True)
class Candidates:
    """Strokes that end in a mark. tips_mm, begins_mm: (n, 2) the marks, and where their strokes begin. free, begun,
    raised: (n, n_independent) configurations at the mark, at the beginning and at the lift height above that, from
    which the arm comes down."""

    tips_mm: FloatArray
    begins_mm: FloatArray
    free: FloatArray
    begun: FloatArray
    raised: FloatArray

    def __len__(self) -> int:
        return len(self.tips_mm)

    def of(self, rows: BoolArray) -> Candidates:
        return Candidates(*(getattr(self, field.name)[rows] for field in fields(self)))


def candidates(
    model: ArmModel,
    heights: Heights,
    margin_mm: float,
    count: int,
    random: np.random.Generator,
    *,
    on_sheet: bool = False,
) -> Candidates:
    """So many places all over the usable canvas less a margin, the arm's redundancy used as widely as its limits
    allow, with room for the lift.

    on_sheet: only as far as a printed sheet has room. Errors: PlanError where the arm has no canvas, or none that
    large."""
    arm, kinematics = model.arm, model.kinematics
    configuration_map = model.configuration_map()
    canvas = canvas_of(model, CanvasKind.USABLE, arm.pen.lift_mm)
    low = np.array([canvas.near_mm, canvas.right_mm]) + margin_mm
    high = np.array([canvas.far_mm, canvas.left_mm]) - margin_mm
    if on_sheet:
        low, high = drawable_mm(low.tolist(), high.tolist())
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
        ways = _WAYS[random.integers(len(_WAYS), size=count)]
        begins = tips[:, :2] - heights.length_mm * ways
        free, usable = project(kinematics, reference, _at(tips[:, :2], -heights.reach_mm))
        usable &= _kept(kinematics, free)
        before = np.where(usable[:, None], free, reference) + random.normal(0.0, _COMING * spread, free.shape)
        begun, begins_well = project(kinematics, before, _at(begins, heights.reach_mm))
        usable &= begins_well & _kept(kinematics, begun)
        raised, risen = project(kinematics, np.where(usable[:, None], begun, reference), _at(begins, heights.lift_mm))
        usable &= risen & _kept(kinematics, raised)
        usable &= ((begins >= low) & (begins <= high)).all(axis=1)
        found.append(Candidates(tips[:, :2], begins, free, begun, raised).of(usable))
        if sum(map(len, found)) >= count:
            break
    whole = Candidates(*(np.concatenate([getattr(each, field.name) for each in found]) for field in fields(Candidates)))
    return whole.of(np.arange(len(whole)) < count)


def _at(places_mm: FloatArray, height_mm: float) -> FloatArray:
    """(n, 3) the places (n, 2) at a height."""
    return np.column_stack((places_mm, np.full(len(places_mm), height_mm)))


def _kept(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    """(n,) whether limits are kept with room to spare, and links apart from each other and above the paper, or at least
    no deeper than the tip where that is pressed into it."""
    arm = kinematics.arm
    kept = within_limits(arm, arm.complete(free), slack=-LIMIT_MARGIN * float((arm.maximum - arm.minimum).min()))
    kept &= kinematics.clearance.least_mm(free)[0] >= KEPT_MM
    floor_mm = np.minimum(kinematics.tip_mm(free)[:, 2], 0.0) - _ROUNDING_MM
    return kept & (kinematics.clearance.lowest_mm(free) >= floor_mm)
