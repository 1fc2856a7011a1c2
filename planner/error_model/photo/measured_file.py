"""`measured.csv`: where marks came, by a photo; a file that can as well be written by hand, with a ruler."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import IO, cast

from planner.error_model.photo.reading import MeasuredMark
from planner.trajectory import written_aside

COLUMNS = ("mark", "x_mm", "y_mm", "h_mm", "sd_mm")


def write_measured(target: Path, measured: Iterable[MeasuredMark]) -> None:
    """A row a mark that was found; h_mm is empty where no height was seen. Errors: OutputError."""
    with written_aside(target) as file:
        rows = csv.writer(cast("IO[str]", file), lineterminator="\n")
        rows.writerow(COLUMNS)
        for each in measured:
            height = f"{each.contact.height_mm:.3f}" if each.contact else ""
            rows.writerow((each.mark.number, *(f"{value:.3f}" for value in each.place_mm), height, f"{each.sd_mm:.3f}"))
