"""A drawing larger than the canvas, cut into sheets that lie in columns and rows.

The whole lies in a frame like that of the arm's paper, on a sheet as large as it needs. Seams cut it into equal parts,
and each is moved amid the canvas. What lies on a seam belongs to one sheet alone: seams of the cut are a hair beside
those of the paper, so that lines along these, of which there are many in drawings with a middle, are on one side for
sure; and what would be no more than a hair of line stays on the sheet that it comes from.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.drawing.drawing import Drawing
from planner.errors import DoesNotFit, UsageError
from planner.paper_size import PaperSize
from planner.placement.place import Placed, box_size_mm, placed
from planner.polyline_length import polyline_length
from planner.settings import PlanSettings
from planner.tile import MARK_MM, MOST_SHEETS, Tile
from planner.workspace.canvas import Canvas

_BESIDE_MM = 0.01
"""From a seam of the paper to the left or upwards, where lines are cut."""
_HAIR_MM = 0.02
_OUTSIDE_MM = 1.0
"""By so much outer sheets hold more: rounding of the page may leave ink a little outside."""
_SAME_MM = 1e-9
_LEAST_MM = 1.0
"""A whole of a line or a dot is so wide or high."""


@dataclass(frozen=True, eq=False, slots=True)
class Tiling:
    """whole: the sheet that the drawing as a whole lies on. part: where each sheet's part of it goes, on the arm's
    paper. columns, rows: how many sheets."""

    whole: Canvas
    part: Canvas
    columns: int
    rows: int

    def tile(self, column: int, row: int) -> Tile:
        """That sheet, counted from 1. Its marks are at its corners that other sheets share."""
        shift = self._shift_mm(column, row)
        left, right = (self._seams(self.columns, self.part.width_mm)[column - 1 : column + 1]).tolist()
        top, bottom = (self._seams(self.rows, self.part.height_mm)[row - 1 : row + 1]).tolist()
        window = self._to_arm(np.array([(left, top), (right, bottom)])) + shift
        (far, left), (near, right) = window.tolist()
        corners = [
            (across, down)
            for down in (row - 1, row)
            for across in (column - 1, column)
            if 0 < across < self.columns or 0 < down < self.rows
        ]
        size = self.part.width_mm, self.part.height_mm
        marks = [(self._to_arm(np.array(corner) * size) + shift).tolist() for corner in corners]
        return Tile(
            column,
            row,
            self.columns,
            self.rows,
            (float(shift[0]), float(shift[1])),
            (near, far, right, left),
            tuple((x, y) for x, y in marks),
        )

    def cut(self, strokes: Sequence[FloatArray]) -> dict[tuple[int, int], list[FloatArray]]:
        """What each sheet holds of strokes (n, 2) of the whole, arm mm, by column and row, in their order."""
        across, down = (
            self._seams(count, size)[1:-1]
            for count, size in ((self.columns, self.part.width_mm), (self.rows, self.part.height_mm))
        )
        found: dict[tuple[int, int], list[FloatArray]] = defaultdict(list)
        for stroke in strokes:
            for (column, row), piece in _pieces(self._from_arm(stroke), across, down):
                found[column, row].append(self._to_arm(piece) + self._shift_mm(column, row))
        return dict(found)

    def _shift_mm(self, column: int, row: int) -> FloatArray:
        """(2,) from where the whole lies to where it lies for that sheet."""
        return np.array(
            [
                self.part.far_mm - self.whole.far_mm + (row - 1) * self.part.height_mm,
                self.part.left_mm - self.whole.left_mm + (column - 1) * self.part.width_mm,
            ]
        )

    def _seams(self, count: int, size_mm: float) -> FloatArray:
        """(count + 1,) where the sheets of a row or a column begin and end, from the left or from the top."""
        seams = np.arange(count + 1) * size_mm - _BESIDE_MM
        seams[0], seams[-1] = -_OUTSIDE_MM, count * size_mm + _OUTSIDE_MM
        return np.asarray(seams, dtype=np.float64)

    def _to_arm(self, points: FloatArray) -> FloatArray:
        """Points (..., 2) to the right of and below the whole's top left corner, in its frame."""
        return self.whole.to_arm_mm(points)

    def _from_arm(self, points: FloatArray) -> FloatArray:
        return np.column_stack((self.whole.left_mm - points[:, 1], self.whole.far_mm - points[:, 0]))


def placed_whole(drawing: Drawing, canvas: Canvas, settings: PlanSettings) -> tuple[Placed, Tiling]:
    """Where a drawing goes on a paper as large as it needs, or the one that the settings name, and how this is cut into
    sheets that the canvas has room for, with a margin and the register marks around each.

    Errors: UsageError where a margin leaves no room or the sheets are too many, DoesNotFit where ink is beyond the
    paper.
    """
    size_mm = box_size_mm(drawing, settings)
    of_whole = replace(settings, skip_unreachable=False)
    if settings.paper is None:
        width_mm, height_mm = (max(side, _LEAST_MM) for side in size_mm)
        of_whole = replace(of_whole, paper=PaperSize("page", width_mm, height_mm), margin_mm=0.0, fit=False)
    assert of_whole.paper is not None
    paper = of_whole.paper.lying(settings.orientation, size_mm[0] > size_mm[1])
    whole = Canvas(canvas.kind, 0.0, paper.height_mm, 0.0, paper.width_mm)
    try:
        place = placed(drawing, whole, of_whole)
    except DoesNotFit as error:
        what = str(error).partition(": use ")[0]
        raise DoesNotFit(f"{what}: use a larger --paper, a smaller --scale or --place ink") from None
    return place, _tiling(whole, canvas, settings.margin_mm)


def held_by(tile: Tile, strokes: Sequence[FloatArray]) -> list[FloatArray]:
    """What a sheet holds of strokes (n, 2), arm mm, that lie as for it."""
    near, far, right, left = tile.window_mm
    pieces = (_pieces(stroke, np.array([near, far]), np.array([right, left])) for stroke in strokes)
    return [piece for some in pieces for cell, piece in some if cell == (2, 2)]


def _tiling(whole: Canvas, canvas: Canvas, margin_mm: float) -> Tiling:
    room = np.array([canvas.width_mm, canvas.height_mm]) - 2.0 * (margin_mm + MARK_MM)
    if (room <= 0.0).any():
        raise UsageError(
            f"a margin of {margin_mm:g} mm, and {MARK_MM:g} mm for register marks, leave nothing of the canvas of"
            f" {canvas.width_mm:.1f} x {canvas.height_mm:.1f} mm: choose a smaller --margin"
        )
    size = np.array([whole.width_mm, whole.height_mm])
    columns, rows = np.ceil(size / room - 1e-9).astype(int).tolist()
    if columns * rows > MOST_SHEETS:
        raise UsageError(
            f"{size[0]:.0f} x {size[1]:.0f} mm take {columns} x {rows} sheets, and {MOST_SHEETS} are the most: choose a"
            " smaller --scale, --paper or --margin"
        )
    width, height = (size / (columns, rows)).tolist()
    middle_x, middle_y = (canvas.near_mm + canvas.far_mm) / 2, (canvas.right_mm + canvas.left_mm) / 2
    part = Canvas(canvas.kind, middle_x - height / 2, middle_x + height / 2, middle_y - width / 2, middle_y + width / 2)
    return Tiling(whole, part, columns, rows)


def _pieces(points: FloatArray, across: FloatArray, down: FloatArray) -> Iterator[tuple[tuple[int, int], FloatArray]]:
    """The pieces of a stroke (n, 2), and the column and the row that each is in. across, down: the inner seams."""
    cut = _with_crossings(points, (across, down))
    middles = (cut[:-1] + cut[1:]) / 2 if len(cut) > 1 else cut
    cells = np.column_stack(
        [np.searchsorted(seams, middles[:, k], side="right") for k, seams in enumerate((across, down))]
    )
    if len(cut) == 1 or (cells == cells[0]).all():
        yield _cell(cells[0]), points
        return
    _without_hairs(cells, cut)
    runs = _runs(cells)
    found = [(_cell(cells[first]), cut[first : last + 1]) for first, last in runs]
    is_closed = np.array_equal(points[0], points[-1])
    if is_closed and len(found) > 1 and found[0][0] == found[-1][0]:
        (cell, start), (_, end) = found[0], found.pop()
        found[0] = cell, np.concatenate((end, start[1:]))
    yield from found


def _cell(cell: IntArray) -> tuple[int, int]:
    return int(cell[0]) + 1, int(cell[1]) + 1


def _with_crossings(points: FloatArray, seams: tuple[FloatArray, FloatArray]) -> FloatArray:
    """The stroke with a point wherever it crosses a seam."""
    segments: list[IntArray] = []
    shares: list[FloatArray] = []
    for k, places in enumerate(seams):
        low, high = points[:, k].min(), points[:, k].max()
        for seam in places[(places > low) & (places < high)]:
            off = points[:, k] - seam
            crossing = np.flatnonzero(off[:-1] * off[1:] < 0.0)
            segments.append(crossing)
            shares.append(off[crossing] / (off[crossing] - off[crossing + 1]))
    if not segments:
        return points
    segment, share = np.concatenate(segments), np.concatenate(shares)
    in_order = np.lexsort((share, segment))
    segment, share = segment[in_order], share[in_order]
    places = points[segment] + share[:, None] * (points[segment + 1] - points[segment])
    cut = np.insert(points, segment + 1, places, axis=0)
    is_new: BoolArray = np.hypot(*np.diff(cut, axis=0).T) > _SAME_MM
    cut = cut[np.concatenate(([True], is_new))]
    cut[-1] = points[-1]  # which closes it, if it is closed
    return cut


def _without_hairs(cells: IntArray, points: FloatArray) -> None:
    """Have runs of segments that are hardly as long as a hair in the cell of the run before, or behind the first."""
    runs = _runs(cells)
    short = [polyline_length(points[first : last + 1]) < _HAIR_MM for first, last in runs]
    long = [index for index, is_short in enumerate(short) if not is_short]
    for index, (first, last) in enumerate(runs):
        if short[index] and long:
            before = [one for one in long if one < index]
            cells[first:last] = cells[runs[before[-1] if before else long[0]][0]]


def _runs(cells: IntArray) -> list[tuple[int, int]]:
    """Of segments in one cell: the first point and the last."""
    breaks = np.flatnonzero((np.diff(cells, axis=0) != 0).any(axis=1)) + 1
    return list(pairwise([0, *breaks.tolist(), len(cells)]))
