"""A drawing that is larger than the canvas: cut into sheets, and a plan for each that has ink on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import frozen
from planner.counted import clock, counted
from planner.drawing.source import DrawingSource
from planner.drawing.svg import read_drawing
from planner.errors import PlanError
from planner.execution.context import PlanContext
from planner.execution.workers import ALONE, Workers, executor_of
from planner.motion.crossed_gaps import Gaps
from planner.pen_drawing import PenDrawing, lift_mm
from planner.pipeline import Plan, canvas_for, planned, taken, told_of, worth_hiring
from planner.placement.board import Board
from planner.placement.place import Placed
from planner.placement.tiling import Tiling, placed_whole
from planner.progress import Report, of_all_stages
from planner.settings import PlanSettings
from planner.tile import Tile

_SHOWN = 12
"""Names of empty sheets that are listed."""


@dataclass(frozen=True, eq=False, slots=True)
class Sheet:
    """A sheet with ink on it, and its plan."""

    tile: Tile
    plan: Plan


@dataclass(frozen=True, eq=False, slots=True)
class TiledPlan:
    """tiling: all sheets. sheets: those with ink, row by row. place: of the drawing as a whole. notes: what is to be
    said of that. where: to lay each sheet, in words."""

    tiling: Tiling
    sheets: tuple[Sheet, ...]
    place: Placed
    notes: tuple[str, ...]
    where: str

    @property
    def warnings(self) -> list[str]:
        """Those of the whole, and those of single sheets."""
        of_sheets = [(sheet.tile, note) for sheet in self.sheets for note in sheet.plan.summary.warnings]
        return [*self.notes, *(f"sheet {tile}: {note}" for tile, note in of_sheets if note not in self.notes)]

    def lines(self) -> list[str]:
        """A few lines to read."""
        tiling, width, height = self.tiling, self.tiling.part.width_mm, self.tiling.part.height_mm
        inked = {str(sheet.tile) for sheet in self.sheets}
        names = [f"{column}-{row}" for row in range(1, tiling.rows + 1) for column in range(1, tiling.columns + 1)]
        empty = [name for name in names if name not in inked]
        shown = ", ".join(empty[:_SHOWN]) + (" ..." if len(empty) > _SHOWN else "")
        seconds = sum(sheet.plan.summary.duration_s for sheet in self.sheets)
        several = len(names) > 1
        return [
            f"{tiling.whole.width_mm:.1f} x {tiling.whole.height_mm:.1f} mm in {counted(tiling.columns, 'column')} and"
            f" {counted(tiling.rows, 'row')}, of {width:.1f} x {height:.1f} mm each: {counted(len(inked), 'sheet')},"
            f" together {clock(seconds)}; drawn at {self.place.scale:.3g} times its size on the page",
            *([f"nothing is on {shown}, which {'is' if len(empty) == 1 else 'are'} left out"] if empty else []),
            *(self._line(sheet) for sheet in self.sheets),
            f"for each sheet, {self.where}",
            *(["lay the sheets together so that the crosses of neighbours lie on each other"] if several else []),
            *(f"hint: {hint}" for hint in self.place.notes[:1]),
            *([] if several else ["hint: one sheet is enough; without --tile it is an ordinary plan"]),
        ]

    def _line(self, sheet: Sheet) -> str:
        tile, summary = sheet.tile, sheet.plan.summary
        width, height = self.tiling.part.width_mm, self.tiling.part.height_mm
        return (
            f"sheet {tile}: {(tile.column - 1) * width:.1f} to {tile.column * width:.1f} mm from the left,"
            f" {(tile.row - 1) * height:.1f} to {tile.row * height:.1f} mm from the top;"
            f" {counted(summary.n_strokes, 'stroke')}, takes {clock(summary.duration_s)}"
        )


def plan_tiles(
    drawing_file: DrawingSource,
    settings: PlanSettings,
    report: Report,
    workers: Workers = ALONE,
    arm: Arm | None = None,
) -> TiledPlan:
    """Plan each sheet of a drawing that is cut into as many as it needs. report: told of all sheets together. arm: None
    for the one that the settings name. Errors: PlannerError, before any result exists."""
    report("reading", 0, 1)
    context = PlanContext.of(arm or load_arm(settings.arm, cache=settings.cache), settings)
    lift_mm(context.model.arm, settings)  # said before the work begins
    with executor_of(worth_hiring(workers, drawing_file), context.make_ready) as executor:
        drawing = read_drawing(drawing_file, partial(report, "reading"), options=settings.reading)
        report("placing", 0, 1)
        canvas = canvas_for(context)
        whole, tiling = placed_whole(drawing, canvas, settings)
        whole, pens = taken(whole, context, report)
        board = Board(canvas, settings.margin_mm, None, None)
        by_sheet = _by_sheet(tiling, pens)
        sheets = []
        for index, (tile, drawings) in enumerate(by_sheet):

            def told(stage: str, done: int, total: int, tile: Tile = tile, index: int = index) -> None:
                part, all_of_it = of_all_stages(stage, done, total)
                report(f"sheet {tile}: {stage}", index * all_of_it + part, len(by_sheet) * all_of_it)

            place = _on_sheet(whole, tile, tiling, board)
            try:
                plan = planned(executor, context, drawing, drawing_file.name, place, drawings, told)
            except PlanError as error:
                raise PlanError(f"sheet {tile}: {error}") from error
            sheets.append(Sheet(tile, plan))
    return TiledPlan(
        tiling, tuple(sheets), whole, tuple(told_of(whole.drawing, pens)), board.where(context.model.arm.paper)
    )


def _by_sheet(tiling: Tiling, pens: Sequence[PenDrawing]) -> list[tuple[Tile, list[PenDrawing]]]:
    """The sheets with ink, row by row, and what each pen draws of it; the first of them draws the marks."""
    strokes = [tiling.cut(pen.strokes) for pen in pens]
    dropped = [tiling.cut(pen.dropped) for pen in pens]
    gaps = [None if pen.gaps is None else tiling.cut(pen.gaps.strokes) for pen in pens]
    cells = sorted({cell for cut in strokes for cell in cut}, key=lambda cell: (cell[1], cell[0]))
    if not cells:
        raise PlanError("nothing of the drawing is left to draw")
    found = []
    for cell in cells:
        tile = tiling.tile(*cell)
        drawings = [
            PenDrawing(
                pen.group,
                pen.context,
                own.get(cell, []),
                dropped=less.get(cell, []),
                gaps=None if apart is None else Gaps(apart.get(cell, [])),
            )
            for pen, own, less, apart in zip(pens, strokes, dropped, gaps, strict=True)
        ]
        first = next(drawing for drawing in drawings if drawing.strokes)
        first.strokes = [*tile.mark_lines(), *first.strokes]
        found.append((tile, drawings))
    return found


def _on_sheet(whole: Placed, tile: Tile, tiling: Tiling, board: Board) -> Placed:
    """Where the drawing lies for one sheet."""
    canvas = board.rectangle
    sides = canvas.near_mm, canvas.far_mm, canvas.right_mm, canvas.left_mm
    return replace(
        whole,
        svg_to_arm=frozen(whole.svg_to_arm + np.column_stack((np.zeros((2, 2)), tile.shift_mm))),
        told=replace(whole.told, canvas_mm=sides, margin_mm=board.margin_mm, tile=tile),
        size_mm=(tiling.part.width_mm, tiling.part.height_mm),
        canvas=canvas,
        board=board,
        notes=(),
    )
