"""Copies of a drawing in rows and columns."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.arrays import FloatArray, frozen
from planner.drawing.drawing import Drawing, Outline
from planner.drawing.path_data import CURVE_LIMIT
from planner.errors import DrawingError


@dataclass(frozen=True, slots=True)
class Copies:
    """columns, rows: how many, the first at the top left. step_x_mm, step_y_mm: from one to the next, to the right and
    down on the paper."""

    columns: int
    rows: int
    step_x_mm: float
    step_y_mm: float

    @property
    def count(self) -> int:
        return self.columns * self.rows

    @property
    def steps_mm(self) -> FloatArray:
        """(count, 2) from the first to each copy, arm mm, row by row: to the right is -y of the arm, down is -x."""
        row, column = np.divmod(np.arange(self.count), self.columns)
        return np.column_stack((-row * self.step_y_mm, -column * self.step_x_mm))

    def of(self, drawing: Drawing, svg_to_arm: FloatArray) -> Drawing:
        """The drawing with all copies, row by row, for the map (2, 3) that places the first. Errors: DrawingError where
        they are too many."""
        if self.count == 1:
            return drawing
        if self.count * sum(len(outline.beziers) for outline in drawing.outlines) > CURVE_LIMIT:
            raise DrawingError(drawing.source, f"its {self.count} copies have more than {CURVE_LIMIT} lines and curves")
        steps = self.steps_mm @ np.linalg.inv(svg_to_arm[:, :2]).T
        outlines = tuple(_moved(outline, step) for step in steps for outline in drawing.outlines)
        return replace(drawing, outlines=outlines, scene=None)


def _moved(outline: Outline, by: FloatArray) -> Outline:
    gap = None if outline.gap is None else frozen(outline.gap + by)
    return replace(outline, beziers=frozen(outline.beziers + by), gap=gap)
