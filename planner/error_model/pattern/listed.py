"""The list of a pattern's marks, for who measures them."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.error_model.believed import believed
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.model import Told, tips_at
from planner.error_model.pattern.pattern import Pattern
from planner.error_model.pattern.touch import SLOPE
from planner.error_model.sheet.marks import Mark, TouchDown
from planner.error_model.sheet.modes import with_modes

_DRAWS = 200


def listed_marks(arm: Arm, pattern: Pattern, approach: int) -> list[Mark]:
    """The marks with their times by the record's clock, their lines, and how they may be off together.

    approach: set points that are played before those of the pattern.
    """
    rate_hz = pattern.trajectory.rate_hz
    times_s, lines_s = ((samples + approach) / rate_hz for samples in (pattern.mark_samples, pattern.zero_samples))
    marks = []
    for number, (place, touch, time_s, line_s) in enumerate(
        zip(pattern.marks_mm.tolist(), pattern.touches, times_s.tolist(), lines_s.tolist(), strict=True)
    ):
        (x0, y0), (x1, y1) = touch.zero_mm.tolist(), touch.end_mm.tolist()
        marks.append(Mark(number, time_s, (place[0], place[1]), TouchDown((x0, y0), (x1, y1), SLOPE, line_s)))
    parameters = Parameters.of(believed(arm), arm)
    joints = arm.from_file_units(pattern.trajectory.positions)
    told = np.column_stack([curve.told(joints[:, k]) for k, curve in enumerate(parameters.prior.curves)])
    change, stands = tips_at(parameters.prior, Told.of(told, pattern.mark_samples))
    jacobian = parameters.jacobian(parameters.prior, change, stands)
    random = np.random.default_rng(0)
    vectors = random.normal(size=(_DRAWS, len(parameters.sd))) * parameters.sd
    by_slack = change.tip_mm[:, :2] - pattern.marks_mm
    return with_modes(marks, by_slack + np.einsum("nip,mp->mni", jacobian[:, :2], vectors))
