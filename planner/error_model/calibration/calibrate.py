"""An arm, records and measured marks to a calibrated arm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from planner.arms.accuracy import Accuracy
from planner.arms.arm import Arm
from planner.arms.usual_settings import usual_clearance_mm
from planner.arrays import FloatArray
from planner.error_model.believed import arm_of, believed
from planner.error_model.calibration.fit import Fit, Marks, fit
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.calibration.plausible import (
    DOUBTFUL,
    POOR,
    refuse_another_sheet,
    refuse_mirrored,
    wrong_direction,
)
from planner.error_model.calibration.sheets import Sheet, marks_of
from planner.error_model.drawn import drawn_joints
from planner.error_model.model import tips_at
from planner.errors import CalibrationError
from planner.redundancy.arm_model import ArmModel

FEWEST_MARKS = 12
_UNTOLD = 0.8
"""Of its prior sd: a parameter that keeps more is not told by the marks."""
_BRISK_MM_S = 25.0
"""Faster, and servos told by pulses, which lag each in its own way and look for pulses each in its own time, draw
visibly worse. Marks are made at rest and tell nothing of lags, so that a pen may be up to 15 ms late or early: 0.4 mm
along its line at this speed."""
_TOUCHED_AGAIN = 2
"""So often it is told anew, with the arm as it is known by then, when the pen came to the paper."""
_SWAPPED = 0.3
"""Of how far marks are off: two that are nearer than this to each other's places were exchanged."""
_STANDING_STILL = 0.2
"""Of its mean slope: a curve as flat as that, where marks are poorly explained, is held from turning back by its prior
alone."""
_GAUGE = 0.9
"""Correlation from which on two parameters can only be told together."""


@dataclass(frozen=True, slots=True)
class Outlier:
    """A mark that the fit does not believe, and how far off it is."""

    sheet: str
    mark: int
    off_mm: float


@dataclass(frozen=True, eq=False, slots=True)
class Calibrated:
    """arm: as calibrated. before_mm: rms along the paper of the marks against the arm as it was. outliers: marks that
    were not believed; exchanged: pairs of them that lie where the other should. untold: parameters that the marks tell
    nothing of. gauges: pairs that they cannot tell apart. has_heights: whether heights were measured."""

    arm: Arm
    fit: Fit
    before_mm: float
    outliers: tuple[Outlier, ...]
    exchanged: tuple[tuple[int, int], ...]
    untold: tuple[str, ...]
    gauges: tuple[tuple[str, str], ...]
    has_heights: bool


def calibrate(arm: Arm, sheets: Sequence[Sheet]) -> Calibrated:
    """The most probable arm. Errors: CalibrationError, ArmFileError where the arm file says nothing of its servos."""
    parameters = Parameters.of(believed(arm), arm)
    sets, numbers = zip(*(marks_of(arm, sheet) for sheet in sheets), strict=True)
    n_seen = sum(int(np.isfinite(marks.tips_mm[:, 0]).sum()) for marks in sets)
    if n_seen < FEWEST_MARKS:
        raise CalibrationError(
            sheets[0].name,
            f"{n_seen} marks were seen; {FEWEST_MARKS} at least are needed, and 49 for half a millimetre",
        )
    for sheet in sheets:
        refuse_mirrored(sheet.name, sheet.record, sheet.measured, arm.joints[0].name)
    found = fit(parameters, sets)
    for _ in range(_TOUCHED_AGAIN if any(len(sheet.measured.touches.marks) for sheet in sheets) else 0):
        sets, numbers = zip(*(marks_of(arm, sheet, found.model) for sheet in sheets), strict=True)
        found = fit(parameters, sets)
    joint = wrong_direction(arm, parameters, found, sets)
    if joint is not None:
        raise CalibrationError(
            sheets[0].name,
            f"joint {arm.joints[joint].name} seems to turn the other way than the "
            "arm file says: the marks fit with its direction changed; mend the "
            "file, and draw the pattern anew",
        )
    if found.noise > POOR:
        for sheet in sheets:
            refuse_another_sheet(sheet.name, sheet.record, sheet.measured)
    model = found.model
    too_flat = _STANDING_STILL if found.noise > DOUBTFUL else 0.0
    for joint_, curve in zip(arm.joints, model.curves, strict=True):
        if curve.flattest <= too_flat:
            raise CalibrationError(
                sheets[0].name,
                f"the curve of joint {joint_.name} would not be monotone: its servo "
                "cannot be so; measure again, or correct its table or its limits",
            )
    sd = found.tip_sd_mm(parameters.jacobian_at(drawn_joints(ArmModel(arm)), model))
    slack = parameters.slack_of(np.sqrt(np.diag(found.covariance)))
    # The mean, in which a corner that marks say nothing of does not drown all else.
    accuracy = Accuracy(n_seen, float(sd[:, :2].mean()), float(sd[:, 2].mean()), tuple(slack.tolist()))
    names = [(sheet.name, int(number)) for sheet, of_sheet in zip(sheets, numbers, strict=True) for number in of_sheet]
    outliers = tuple(
        Outlier(*names[k], float(np.sqrt(np.nansum(found.residuals_mm[k] ** 2))))
        for k in np.flatnonzero(found.outliers & np.isfinite(found.residuals_mm).any(axis=1))
    )
    has_pulses = any(joint.servo is not None for joint in arm.joints)
    before = _before_mm(parameters, sets)
    exchanged = _exchanged(found, names, np.concatenate([marks.tips_mm for marks in sets]))
    pen = replace(arm.pen, speed_mm_s=min(arm.pen.speed_mm_s, _BRISK_MM_S)) if has_pulses else arm.pen
    calibrated = replace(arm_of(model, arm), accuracy=accuracy, pen=pen)
    if arm.pen.clearance_mm == usual_clearance_mm(arm):  # another one is what somebody wants
        calibrated = replace(calibrated, pen=replace(pen, clearance_mm=usual_clearance_mm(calibrated)))
    return Calibrated(
        calibrated,
        found,
        before,
        outliers,
        exchanged,
        _untold(found),
        _gauges(found),
        bool(np.isfinite(found.residuals_mm[:, 2]).any()),
    )


def _before_mm(parameters: Parameters, sets: Sequence[Marks]) -> float:
    errors = np.concatenate([marks.tips_mm - tips_at(parameters.prior, marks.told)[0].tip_mm for marks in sets])
    return float(np.sqrt(np.nanmean((errors[:, :2] ** 2).sum(axis=1))))


def _exchanged(found: Fit, names: Sequence[tuple[str, int]], tips_mm: FloatArray) -> tuple[tuple[int, int], ...]:
    """Pairs of marks, neither believed, that would be if each had the other's number."""
    where = (tips_mm - found.residuals_mm)[:, :2]  # the model's
    astray = np.flatnonzero(found.outliers & np.isfinite(tips_mm[:, 0])).tolist()
    pairs = []
    for place, i in enumerate(astray):
        for j in astray[place + 1 :]:
            swapped = np.hypot(*(tips_mm[[i, j], :2] - where[[j, i]]).T)
            if (swapped < _SWAPPED * np.hypot(*found.residuals_mm[[i, j], :2].T)).all():
                pairs.append((names[i][1], names[j][1]))
    return tuple(pairs)


def _untold(found: Fit) -> tuple[str, ...]:
    left = np.sqrt(np.diag(found.covariance)) / found.parameters.sd
    return tuple(name for name, share in zip(found.parameters.names, left, strict=True) if share > _UNTOLD)


def _gauges(found: Fit) -> tuple[tuple[str, str], ...]:
    """Pairs that can only be told together; of one curve, whose shape is told by all of its terms, there are none."""
    sd = np.sqrt(np.diag(found.covariance))
    correlation = np.abs(found.covariance / np.outer(sd, sd))
    one, other = np.nonzero(np.triu(correlation > _GAUGE, k=1))
    names = found.parameters.names
    pairs = ((names[i], names[j]) for i, j in zip(one.tolist(), other.tolist(), strict=True))
    return tuple((a, b) for a, b in pairs if a.rsplit(" ", 1)[0] != b.rsplit(" ", 1)[0] or " curve " not in a)
