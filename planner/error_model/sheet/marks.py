"""The marks of a calibration pattern, as they are meant: the value, and the file `marks.csv`.

The frame is the sheet's: x away from the arm, y to its left, in millimetres, the base at the origin.
"""

from __future__ import annotations

import csv
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, cast

import numpy as np

from planner.arrays import FloatArray
from planner.errors import PlannerError
from planner.files import written_aside

COLUMNS = ("mark", "t_s", "x_mm", "y_mm")
TOUCH_COLUMNS = ("touch_x0_mm", "touch_y0_mm", "touch_x1_mm", "touch_y1_mm", "touch_slope")
TOUCH_TIME = "touch_t_s"
_DECIMALS = 3
_FARTHEST_MM = 2000.0
_STEEPEST = 10.0


class MarksFileError(PlannerError):
    """A file of marks that is damaged or not one. `line` counts from 1."""

    def __init__(self, source: str, line: int | None, reason: str) -> None:
        self.source, self.line, self.reason = source, line, reason
        super().__init__(f"{source if line is None else f'{source}, line {line}'}: {reason}")


@dataclass(frozen=True, slots=True)
class TouchDown:
    """A line beside a mark along which the tip comes down evenly, to tell its height by where the ink begins.

    start_mm: where it begins for a tip that is as high as it should be. end_mm: where the line ends. slope: mm of
    height lost for each mm along the line. t_s: when the pen is meant to be at the start, by the record's clock, where
    that is known.
    """

    start_mm: tuple[float, float]
    end_mm: tuple[float, float]
    slope: float
    t_s: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "start_mm", _rounded(self.start_mm))
        object.__setattr__(self, "end_mm", _rounded(self.end_mm))
        if not math.dist(self.start_mm, self.end_mm) > 0:
            raise ValueError("the touch-down line has no length")
        if not 0 < self.slope <= _STEEPEST:
            raise ValueError(f"the touch-down slope {self.slope:g} is not above 0 and at most {_STEEPEST:g}")


@dataclass(frozen=True, slots=True)
class Mark:
    """A dot that is meant at (x, y) mm on the sheet, in the middle of its dwell at t_s by the record's clock.

    modes_mm: how far it is moved in x and y by one standard deviation of each mode of the arm's errors, where known.
    Lengths are kept to a thousandth of a millimetre, as in the file, so that a sheet made from marks and one made from
    the file that tells them are the same sheet.
    """

    number: int
    t_s: float
    place_mm: tuple[float, float]
    touch_down: TouchDown | None = None
    modes_mm: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "place_mm", _rounded(self.place_mm))
        object.__setattr__(self, "modes_mm", tuple(_rounded(mode) for mode in self.modes_mm))
        if not math.isfinite(self.t_s):
            raise ValueError("the time is not a finite number")


def places_mm(marks: Sequence[Mark]) -> FloatArray:
    """(n, 2): where the marks are meant."""
    return np.array([mark.place_mm for mark in marks], dtype=np.float64).reshape(-1, 2)


def extent_mm(marks: Sequence[Mark]) -> tuple[FloatArray, FloatArray]:
    """Least and greatest x and y (2,) of the marks and of their touch-down lines."""
    contacts = [mark.touch_down for mark in marks if mark.touch_down]
    points = np.array(
        [
            *(mark.place_mm for mark in marks),
            *(contact.start_mm for contact in contacts),
            *(contact.end_mm for contact in contacts),
        ]
    )
    return points.min(axis=0), points.max(axis=0)


def write_marks(target: Path, marks: Sequence[Mark]) -> None:
    """Write `marks.csv`; cells of the touch-down stay empty where a mark has none. Errors: OutputError."""
    n_modes = len(marks[0].modes_mm) if marks else 0
    timed = any(mark.touch_down is not None and mark.touch_down.t_s is not None for mark in marks)
    with written_aside(target) as file:
        rows = csv.writer(cast("IO[str]", file), lineterminator="\n")
        rows.writerow(
            (
                *COLUMNS,
                *TOUCH_COLUMNS,
                *[TOUCH_TIME] * timed,
                *(name for pair in _mode_columns(n_modes) for name in pair),
            )
        )
        for mark in marks:
            contact = mark.touch_down
            line = ("",) * 5 if contact is None else (*contact.start_mm, *contact.end_mm, f"{contact.slope:.6g}")
            modes = (value for mode in mark.modes_mm for value in mode)
            time = "" if contact is None or contact.t_s is None else f"{contact.t_s:.6f}"
            rows.writerow((mark.number, f"{mark.t_s:.6f}", *mark.place_mm, *line, *[time] * timed, *modes))


def read_marks(source: Path) -> tuple[Mark, ...]:
    """The marks that a file tells, in its order. Columns may come in any order; those that are not known are passed
    over. Errors: MarksFileError, naming line and reason."""
    try:
        with source.open(encoding="utf-8-sig", newline="") as file:
            rows = [(number, row) for number, row in enumerate(csv.reader(file), 1) if "".join(row).strip()]
    except OSError as error:
        raise MarksFileError(str(source), None, f"cannot be read: {error.strerror or error}") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise MarksFileError(
            str(source), None, "it is no text file of marks as `plan pattern --marks` writes it"
        ) from error
    header = [name.strip() for name in rows[0][1]] if rows else []
    missing = [name for name in COLUMNS if name not in header]
    if missing:
        raise MarksFileError(
            str(source),
            rows[0][0] if rows else None,
            f"no column {', '.join(missing)}; it has to be a file of marks as `plan pattern --marks` writes it",
        )
    n_modes = next(k for k in range(len(header) + 1) if not set(_mode_columns(k + 1)[k]) <= set(header))
    marks = [_mark(str(source), line, dict(zip(header, row, strict=False)), n_modes) for line, row in rows[1:]]
    if not marks:
        raise MarksFileError(str(source), None, "it tells of no marks")
    number, times = Counter(mark.number for mark in marks).most_common(1)[0]
    if times > 1:
        raise MarksFileError(str(source), None, f"mark {number} stands in it {times} times")
    return tuple(marks)


def _mode_columns(count: int) -> list[tuple[str, str]]:
    return [(f"mode{k}_x_mm", f"mode{k}_y_mm") for k in range(1, count + 1)]


def _mark(source: str, line: int, cells: dict[str, str], n_modes: int) -> Mark:
    try:
        contact = [cells.get(name, "").strip() for name in TOUCH_COLUMNS]
        told = [bool(cell) for cell in contact]
        if any(told) and not all(told):
            raise ValueError("of the five touch-down columns some are empty; fill in all of them, or none")
        x0, y0, x1, y1, slope = (_number(name, cells) if all(told) else 1.0 for name in TOUCH_COLUMNS)
        time = _number(TOUCH_TIME, cells) if cells.get(TOUCH_TIME, "").strip() else None
        number = _number("mark", cells)
        if number != int(number) or number < 0:
            raise ValueError(f"mark '{cells['mark']}' is not a whole number from 0")
        return Mark(
            int(number),
            _number("t_s", cells),
            (_number("x_mm", cells), _number("y_mm", cells)),
            TouchDown((x0, y0), (x1, y1), slope, time) if all(told) else None,
            tuple((_number(x, cells), _number(y, cells)) for x, y in _mode_columns(n_modes)),
        )
    except ValueError as error:
        raise MarksFileError(source, line, str(error)) from error


def _number(name: str, cells: dict[str, str]) -> float:
    text = cells.get(name, "").strip()
    try:
        value = float(text)
    except ValueError:
        raise ValueError(f"{name} '{text}' is not a number") from None
    if not math.isfinite(value):
        raise ValueError(f"{name} '{text}' is not a finite number")
    return value


def _rounded(point_mm: tuple[float, float]) -> tuple[float, float]:
    if not all(math.isfinite(value) and abs(value) <= _FARTHEST_MM for value in point_mm):
        raise ValueError(f"({point_mm[0]:g}, {point_mm[1]:g}) mm is no place on a sheet")
    return cast("tuple[float, float]", tuple(round(float(value), _DECIMALS) + 0.0 for value in point_mm))
