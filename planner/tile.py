"""One sheet of a drawing that is cut into several: which one, what of the drawing it holds, and its register marks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray

MARK_MM = 3.0
"""How far a register mark, a cross, goes to each side."""
MOST_SHEETS = 1000


@dataclass(frozen=True, slots=True)
class Tile:
    """A sheet by its place among all of them, columns from the left and rows from the top, both counted from 1.

    shift_mm: arm x and y from where the drawing as a whole lies to where it lies for this sheet. window_mm: near and
    far side (arm x), right and left side (arm y) of what the sheet holds of it; outer sides lie a little outside of the
    drawing. marks_mm: middles (x, y) of the register marks, arm mm.
    """

    column: int
    row: int
    columns: int
    rows: int
    shift_mm: tuple[float, float]
    window_mm: tuple[float, float, float, float]
    marks_mm: tuple[tuple[float, float], ...] = ()

    def __str__(self) -> str:
        return f"{self.column}-{self.row}"

    def mark_lines(self) -> list[FloatArray]:
        """Both strokes (2, 2) of each cross, arm mm."""
        arms = MARK_MM * np.array([[[1.0, 0.0], [-1.0, 0.0]], [[0.0, 1.0], [0.0, -1.0]]])
        return [np.array(middle) + arm for middle in self.marks_mm for arm in arms]
