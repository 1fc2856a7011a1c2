"""A drawn and measured sheet as what a fit takes: what the servos were told, when, and what came of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.error_model.calibration.files import Measured, Record
from planner.error_model.calibration.fit import Marks
from planner.error_model.lag import lagged
from planner.error_model.model import ErrorModel, Told, tips_at
from planner.errors import CalibrationError

_LINE_S = 0.75
"""Before and after the moment that it is given with, a pen is on its way along a line."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """One drawn and measured sheet. name: of the file that its marks come from."""

    name: str
    record: Record
    measured: Measured


def rows_of_marks(record: Record, marks: IntArray) -> IntArray:
    """(m,) the set point in the middle of each mark's dwell; -1 where the record has no such stroke."""
    rows = np.full(len(marks), -1)
    for k, mark in enumerate(marks.tolist()):
        dwell = np.flatnonzero(record.stroke == mark)
        if mark >= 0 and len(dwell):
            rows[k] = dwell[len(dwell) // 2]
    return rows


def marks_of(arm: Arm, sheet: Sheet, model: ErrorModel | None = None) -> tuple[Marks, IntArray]:
    """The marks of a sheet and, as further ones, the lines beside them; and the number of the mark of each (m,).

    model: what is known of the arm by now, to tell when the pen came to the paper along a line: a tip sticks and slips
    while it comes down slowly. Errors: CalibrationError.
    """
    record, measured, touches = sheet.record, sheet.measured, sheet.measured.touches
    rows = rows_of_marks(record, measured.marks)
    if (rows < 0).any():
        raise CalibrationError(
            sheet.name,
            f"mark {measured.marks[np.argmax(rows < 0)]} is not in the record, which "
            f"has 0 to {record.stroke.max()}: is it that of another pattern?",
        )
    moments = np.searchsorted(record.times_s, touches.times_s)
    if (moments >= len(record.times_s)).any():
        raise CalibrationError(
            sheet.name, "lines were drawn after the end of the record: is it that of another pattern?"
        )
    told = lagged(record.told, _lags_s(arm), record.period_s)
    if model is not None:
        moments = _touched(model, told, moments, round(_LINE_S / record.period_s))
    # Ink begins where height is zero: height + fall . place = fall . begin, all along a straight line.
    lines = np.full((len(moments), 3), np.nan)
    lines[:, 2] = (touches.falls * touches.begins_mm).sum(axis=1)
    of_line = np.array([np.flatnonzero(measured.marks == mark)[0] for mark in touches.marks], dtype=np.int64)
    return (
        Marks(
            Told.of(told, np.concatenate((rows, moments))),
            np.concatenate((measured.tips_mm, lines)),
            np.concatenate((measured.sd_mm, measured.sd_mm[of_line])),
            np.concatenate((np.zeros((len(rows), 2)), touches.falls)),
        ),
        np.concatenate((measured.marks, touches.marks)),
    )


def _lags_s(arm: Arm) -> FloatArray:
    return np.array(
        [joint.servo.lag_s if joint.servo else joint.bus.lag_s if joint.bus else 0.0 for joint in arm.joints]
    )


def _touched(model: ErrorModel, told: FloatArray, moments: IntArray, reach: int) -> IntArray:
    """(t,) the set points at which the model's tip comes to the paper, near `moments`; these where it does not."""
    windows = np.clip(moments[:, None] + np.arange(-reach, reach), 0, len(told) - 1)
    height = tips_at(model, Told.of(told, windows.ravel()))[0].tip_mm[:, 2].reshape(windows.shape)
    first = (height <= 0).argmax(axis=1)  # 0 where the tip is always on one side
    return np.where(first > 0, np.take_along_axis(windows, first[:, None], axis=1)[:, 0], moments)
