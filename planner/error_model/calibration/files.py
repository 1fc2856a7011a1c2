"""What a calibration reads: the record of what servos were told, and the marks that were measured."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.errors import CalibrationError

_TOUCH = ("touch_t_s", "touch_x_mm", "touch_y_mm", "touch_fall_x", "touch_fall_y")
RULER_SD_MM = 0.2
"""Of a measured place, where the file says nothing of it."""


@dataclass(frozen=True, eq=False, slots=True)
class Record:
    """times_s, stroke: (n,); meant_mm: (n, 2) on the paper; told: (n, n_joints) us or counts."""

    times_s: FloatArray
    stroke: IntArray
    meant_mm: FloatArray
    told: FloatArray

    @property
    def period_s(self) -> float:
        return float(self.times_s[-1] - self.times_s[0]) / max(len(self.times_s) - 1, 1)


@dataclass(frozen=True, eq=False, slots=True)
class Touches:
    """Lines along which the pen came down. times_s: (t,) a moment of each by the record's clock, near its touch-down.
    begins_mm: (t, 2) where its ink begins. falls: (t, 2) mm of height that it was meant to lose a mm along x and y.
    marks: (t,) which mark each is beside."""

    times_s: FloatArray
    begins_mm: FloatArray
    falls: FloatArray
    marks: IntArray


@dataclass(frozen=True, eq=False, slots=True)
class Measured:
    """marks: (m,) their numbers, which are those of strokes of the record; tips_mm: (m, 3) x, y, h, NaN where not seen;
    sd_mm: (m,). touches: lines along which the pen came down."""

    marks: IntArray
    tips_mm: FloatArray
    sd_mm: FloatArray
    touches: Touches


def read_record(source: Path, arm: Arm) -> Record:
    """What `plan run --record` wrote. Errors: CalibrationError naming file, line and what is wrong."""
    unit = "counts" if all(joint.servo is None for joint in arm.joints) else "us"
    columns = ["t_s", "stroke", "x_mm", "y_mm", *(f"{joint.name}_{unit}" for joint in arm.joints)]
    names, rows, lines = cells_of(source)
    if names != columns:
        raise CalibrationError(
            str(source), f"has the columns {','.join(names)}; a record of arm '{arm.name}' has {','.join(columns)}"
        )
    table = np.array([[number_of(source, line, cell) for cell in row] for row, line in zip(rows, lines, strict=True)])
    if len(table) < 2 or np.any(np.diff(table[:, 0]) <= 0):
        raise CalibrationError(str(source), "its times do not go up: is it a record of plan run?")
    return Record(table[:, 0], table[:, 1].astype(np.int64), table[:, 2:4], table[:, 4:])


def read_marks(source: Path) -> Measured:
    """What `plan measure` or a ruler found: `mark,x_mm,y_mm`, where known `h_mm` and `sd_mm`, and the line beside the
    mark: `touch_t_s,touch_x_mm,touch_y_mm,touch_fall_x,touch_fall_y`. Empty cells: not seen.
    Errors: CalibrationError."""
    names, rows, lines = cells_of(source)
    for needed in ("mark", "x_mm", "y_mm"):
        if needed not in names:
            raise CalibrationError(
                str(source), f"has no column {needed}; wanted mark,x_mm,y_mm and, where known, h_mm,sd_mm"
            )
    place = {name: names.index(name) for name in names}

    def value(row: list[str], line: int, name: str) -> float:
        cell = row[place[name]].strip() if name in place else ""
        return number_of(source, line, cell) if cell else math.nan

    marks, tips, sds, touches = [], [], [], []
    for row, line in zip(rows, lines, strict=True):
        mark, sd = value(row, line, "mark"), value(row, line, "sd_mm")
        if mark != math.floor(mark):
            raise CalibrationError(str(source), f"line {line}: mark is no whole number")
        if sd <= 0:
            raise CalibrationError(str(source), f"line {line}: sd_mm {sd:g} is not above 0")
        marks.append(int(mark))
        sds.append(RULER_SD_MM if math.isnan(sd) else sd)
        tip = [value(row, line, name) for name in ("x_mm", "y_mm", "h_mm")]
        touch = [value(row, line, name) for name in _TOUCH]
        if not any(map(math.isnan, touch)):
            touches.append((mark, *touch))
            tip[2] = math.nan  # the line tells it, and at its own moment
        tips.append(tip if not any(map(math.isnan, tip[:2])) else [math.nan] * 3)
    twice = [mark for mark in set(marks) if marks.count(mark) > 1]
    if twice:
        raise CalibrationError(str(source), f"mark {min(twice)} is there twice")
    return Measured(
        np.array(marks, dtype=np.int64),
        np.array(tips).reshape(-1, 3),
        np.array(sds),
        _touches(np.array(touches).reshape(-1, 1 + len(_TOUCH))),
    )


def _touches(rows: FloatArray) -> Touches:
    return Touches(rows[:, 1], rows[:, 2:4], rows[:, 4:], rows[:, 0].astype(np.int64))


def cells_of(source: Path) -> tuple[list[str], list[list[str]], list[int]]:
    """Column names, rows of as many cells, and their line numbers; comments and empty lines are passed over."""
    try:
        with source.open(encoding="utf-8-sig", newline="") as file:
            kept = [
                (number, line) for number, line in enumerate(file, start=1) if line.strip() and not line.startswith("#")
            ]
    except (OSError, UnicodeDecodeError) as error:
        raise CalibrationError(str(source), f"cannot be read: {getattr(error, 'strerror', None) or error}") from error
    if not kept:
        raise CalibrationError(str(source), "is empty")
    names, *rows = csv.reader(line for _, line in kept)
    lines = [number for number, _ in kept[1:]]
    for row, line in zip(rows, lines, strict=True):
        if len(row) != len(names):
            raise CalibrationError(str(source), f"line {line}: has {len(row)} cell(s); wanted {len(names)}")
    return [name.strip() for name in names], rows, lines


def number_of(source: Path, line: int, cell: str) -> float:
    try:
        number = float(cell)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise CalibrationError(str(source), f"line {line}: '{cell[:30]}' is not a finite number")
    return number
