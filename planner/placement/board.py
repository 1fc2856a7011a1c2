"""Where the paper lies, and how much of it is drawn on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.errors import UsageError
from planner.paper_size import Orientation, PaperSize
from planner.workspace.canvas import Canvas

_STRAIGHT_RAD = float(np.radians(5.0))
"""Up to so far turned, a paper lies level and straight before the base."""


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

    def where(self, paper: PaperPose) -> str:
        """Where to lay the paper, in words: before the base's axis where it lies level and straight before it, in the
        base frame elsewhere."""
        sheet = self.sheet or self.rectangle
        what = f"the {self.size} sheet" if self.size else "paper"
        corners_mm = np.column_stack((sheet.corners_arm_mm, np.zeros(4)))
        if np.trace(paper.T_base_paper[:3, :3]) < 1.0 + 2.0 * np.cos(_STRAIGHT_RAD):
            put = "lay" if paper.normal[2] > np.cos(_STRAIGHT_RAD) else "put up"
            return (
                f"{put} {what} of {sheet.width_mm:.0f} x {sheet.height_mm:.0f} mm; corners at"
                f" {_in_words(paper.to_base(corners_mm))} in the base frame, first its top left and top right"
            )
        x, y, _ = paper.T_paper_base[:3, 3].tolist()
        corners = _in_words(paper.to_base(corners_mm)[:, :2])
        middle = (sheet.left_mm + sheet.right_mm) / 2 - y
        beside = (
            "in the middle" if abs(middle) < 0.5 else f"{abs(middle):.0f} mm to the {'left' if middle > 0 else 'right'}"
        )
        return (
            f"lay {what} {sheet.near_mm - x:.0f} to {sheet.far_mm - x:.0f} mm before the base's axis,"
            f" {sheet.width_mm:.0f} mm wide, {beside}; corners at {corners}"
        )


def _in_words(places_mm: FloatArray) -> str:
    rounded = np.round(places_mm) + 0.0  # no -0
    return ", ".join("(" + ", ".join(f"{value:.0f}" for value in place) + ")" for place in rounded.tolist())


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
