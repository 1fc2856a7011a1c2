"""Where the paper lies, and how much of it is drawn on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.errors import UsageError
from planner.paper_size import Orientation, PaperSize
from planner.workspace.canvas import Canvas


@dataclass(frozen=True, eq=False, slots=True)
class Board:
    """rectangle: of the canvas, what the paper leaves; ink may be on it but for its margin. sheet: the rectangle of
    paper, in arm mm, and size: what it is called; None where nobody said which paper there is."""

    rectangle: Canvas
    margin_mm: float
    sheet: Canvas | None
    size: PaperSize | None

    @property
    def room_mm(self) -> tuple[float, float]:
        """Width and height within the margin."""
        return self.rectangle.width_mm - 2 * self.margin_mm, self.rectangle.height_mm - 2 * self.margin_mm

    def where(self) -> str:
        """Where to lay the paper, in words."""
        sheet = self.sheet or self.rectangle
        what = f"lay the {self.size} sheet" if self.size else "lay paper"
        corners = ", ".join(f"({x:.0f}, {y:.0f})" for x, y in np.round(sheet.corners_arm_mm) + 0.0)  # no -0
        middle = (sheet.left_mm + sheet.right_mm) / 2
        beside = (
            "in the middle" if abs(middle) < 0.5 else f"{abs(middle):.0f} mm to the {'left' if middle > 0 else 'right'}"
        )
        return (
            f"{what} {sheet.near_mm:.0f} to {sheet.far_mm:.0f} mm before the base's axis, {sheet.width_mm:.0f} mm wide,"
            f" {beside}; corners at {corners}"
        )


def board_of(
    canvas: Canvas, paper: PaperSize | None, orientation: Orientation, margin_mm: float, drawing_is_wide: bool
) -> Board:
    """The whole canvas, or a sheet that lies amid the canvas, never nearer to the base, and what of that is canvas.

    Errors: UsageError where the margin leaves nothing.
    """
    sheet = size = None
    rectangle = canvas
    if paper is not None:
        size = paper.lying(orientation, drawing_is_wide)
        sheet = _amid(canvas, size)
        rectangle = replace(
            canvas,
            near_mm=max(canvas.near_mm, sheet.near_mm),
            far_mm=min(canvas.far_mm, sheet.far_mm),
            right_mm=max(canvas.right_mm, sheet.right_mm),
            left_mm=min(canvas.left_mm, sheet.left_mm),
        )
    board = Board(rectangle, margin_mm, sheet, size)
    if min(board.room_mm) <= 0:
        raise UsageError(
            f"a margin of {margin_mm:g} mm leaves nothing of the {'paper' if paper else 'canvas'} of"
            f" {rectangle.width_mm:.1f} x {rectangle.height_mm:.1f} mm: choose a smaller --margin"
        )
    return board


def _amid(canvas: Canvas, size: PaperSize) -> Canvas:
    """The rectangle of a sheet. One that is higher than the canvas begins where that does: the base is in its way."""
    near_mm = canvas.near_mm + max(canvas.height_mm - size.height_mm, 0.0) / 2
    middle_mm = (canvas.right_mm + canvas.left_mm) / 2
    return replace(
        canvas,
        near_mm=near_mm,
        far_mm=near_mm + size.height_mm,
        right_mm=middle_mm - size.width_mm / 2,
        left_mm=middle_mm + size.width_mm / 2,
    )
