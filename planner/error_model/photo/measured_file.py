"""`measured.csv`: where marks came, by a photo; a file that can as well be written by hand, with a ruler."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import IO, cast

import numpy as np

from planner.error_model.photo.reading import MeasuredMark
from planner.files import written_aside

COLUMNS = ("mark", "x_mm", "y_mm", "h_mm", "sd_mm")
TOUCH_COLUMNS = ("touch_t_s", "touch_x_mm", "touch_y_mm", "touch_fall_x", "touch_fall_y")


def write_measured(target: Path, measured: Iterable[MeasuredMark]) -> None:
    """A row a mark that was found; h_mm is empty where no height was seen. Where the time of lines is known, where
    their ink begins and how they fall is told as well: a calibration makes more of that. Errors: OutputError.
    """
    found = list(measured)
    lines = [_line(each) for each in found]
    timed = any(lines)
    with written_aside(target) as file:
        rows = csv.writer(cast("IO[str]", file), lineterminator="\n")
        rows.writerow((*COLUMNS, *TOUCH_COLUMNS) if timed else COLUMNS)
        for each, line in zip(found, lines, strict=True):
            height = f"{each.contact.height_mm:.3f}" if each.contact else ""
            cells = (each.mark.number, *(f"{value:.3f}" for value in each.place_mm), height, f"{each.sd_mm:.3f}")
            rows.writerow((*cells, *(line or [""] * len(TOUCH_COLUMNS) * timed)))


def _line(each: MeasuredMark) -> list[str]:
    """Cells of the line beside a mark; none where it was not seen, or its time is not known."""
    meant = each.mark.touch_down
    if each.contact is None or meant is None or meant.t_s is None:
        return []
    along = np.subtract(meant.end_mm, meant.start_mm)
    fall = meant.slope * along / np.linalg.norm(along)
    return [f"{meant.t_s:.6f}", *(f"{value:.3f}" for value in (*each.contact.ends_mm[0], *fall))]
