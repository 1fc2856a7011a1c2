"""The calibration sheet as a PDF at true size."""

from __future__ import annotations

import datetime
import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import IO, cast

import numpy as np

from planner.arrays import FloatArray
from planner.error_model.sheet.layout import BAR_MM, BASE_RING_MM, PaperSize, SheetLayout, sheet_for
from planner.error_model.sheet.marks import Mark, extent_mm, places_mm
from planner.error_model.sheet.tags import tag_modules
from planner.errors import UsageError
from planner.files import written_aside

try:
    from fpdf import FPDF, ViewerPreferences
except ImportError as error:
    raise UsageError("a sheet to print needs the extra 'vision': pip install 'drawing-arm-planner[vision]'") from error

_INK, _QUIET, _FAINT = 0, 95, 185  # greys
_FONT = "Helvetica"
_RINGS_MM = (10.0, 20.0, 30.0, BASE_RING_MM)
_CLEAR_MM = 9.0  # between what is printed and where marks are meant
_BAR_WORDS = f"must be {BAR_MM:g} mm"
_HOW = (
    ("Print at 100 %, true size.", "Lay it flat, tape it down,", "base over the rings."),
    ("Check both bars, then draw.", "Photograph all of it from", "above, sharp, in even light."),
)


def write_sheet(target: Path, arm_name: str, marks: Sequence[Mark], size: PaperSize = PaperSize.A4) -> SheetLayout:
    """Write a sheet to print at true size, for the marks of a pattern; what it is laid out like.

    Nothing is printed where marks and touch-down lines will come. The same marks and arm make the same file.
    Errors: PlanError where the marks do not fit on the paper, UsageError where an extra is missing, OutputError.
    """
    layout = sheet_for(marks, size)
    page = _Page(layout, arm_name)
    page.tags()
    page.bars()
    page.base(float(np.linalg.norm(places_mm(marks), axis=1).min()))
    page.corners(*extent_mm(marks))
    page.words(arm_name)
    with written_aside(target, binary=True) as file:
        cast("IO[bytes]", file).write(bytes(page.pdf.output()))
    return layout


class _Page:
    """A page that is drawn on in its own millimetres, v up."""

    def __init__(self, layout: SheetLayout, arm_name: str) -> None:
        self.layout = layout
        self.width, self.height = layout.page.extent_mm
        self.pdf = FPDF(unit="mm", format=(self.width, self.height))
        self.pdf.set_creation_date(datetime.datetime(2000, 1, 1, tzinfo=datetime.UTC))
        self.pdf.set_title(f"Calibration sheet {layout.name} of {_latin(arm_name)}")
        self.pdf.viewer_preferences = ViewerPreferences(print_scaling="None")  # readers then offer true size first
        self.pdf.set_auto_page_break(False)
        self.pdf.add_page()

    def tags(self) -> None:
        """Each as one path, which no viewer shows seams in or moves to whole pixels."""
        for place, number in zip(self.layout.tag_places, self.layout.tag_ids, strict=True):
            corners = self.layout.tag_corners_page_mm(place)
            modules = tag_modules(number)
            side = np.ptp(corners[:, 0]) / len(modules)
            with self.pdf.new_path() as path:
                path.style.fill_color = "#000000"
                path.style.stroke_color = None
                for left, top, width, height in _rectangles(modules):
                    path.rectangle(
                        corners[0, 0] + side * left,
                        self.height - corners[0, 1] + side * top,
                        side * width,
                        side * height,
                    )

    def bars(self) -> None:
        """The words stand in the gap between the middle tags."""
        for start, end in (*self.layout.bars_page_mm, *self.layout.ticks_page_mm):
            self._line(start, end, width=0.3)
        (across, along) = self.layout.bars_page_mm.mean(axis=1)
        self._text(across + _at(0.0, 1.0), _BAR_WORDS, 7, align="C")
        with self.pdf.rotation(90, along[0], self.height - along[1]):
            self._text(along + _at(0.0, 1.0), _BAR_WORDS, 7, align="C")

    def base(self, nearest_mm: float) -> None:
        """Rings to centre the base by, its axes, and which way the arm looks; clear of marks, the nearest of which is
        that far from the base's axis."""
        origin = np.array(self.layout.origin_page_mm)
        if origin[1] <= 0:
            self._far_base(origin)
            return
        reach = max(min(BASE_RING_MM + 4.0, nearest_mm - _CLEAR_MM), 3.0)
        self._line(origin - _at(reach, 0.0), origin + _at(reach, 0.0), width=0.2, grey=_QUIET)
        self._line(_at(origin[0], max(origin[1] - reach, 0.0)), origin + _at(0.0, reach), width=0.2, grey=_QUIET)
        if reach < _RINGS_MM[0]:  # no room for more
            return
        for radius in [radius for radius in _RINGS_MM if radius <= reach]:
            self.pdf.set_draw_color(_FAINT)
            self.pdf.set_line_width(0.2)
            self.pdf.circle(origin[0], self.height - origin[1], radius)
            self._text(origin + 0.71 * radius + _at(0.6, 0.0), f"{radius:g}", 5, grey=_QUIET)
        self._arrow(origin + _at(0.0, reach), [0.0, 1.0])
        self._arrow(origin - _at(reach, 0.0), [-1.0, 0.0])
        self._text(origin + _at(1.2, reach - 1.5), "x", 6.5, grey=_QUIET)
        self._text(origin + _at(-reach, 1.5), "y", 6.5, grey=_QUIET)
        self._text(origin + _at(1.0, -2.6), "axis of the base;", 5.5, grey=_QUIET)
        self._text(origin + _at(1.0, -5.0), "the arm looks along x", 5.5, grey=_QUIET)

    def _far_base(self, origin: FloatArray) -> None:
        """The paper lies in front of the base: how far."""
        self._line([origin[0], 0.0], [origin[0], 19.0], width=0.2, grey=_QUIET)
        self._arrow(origin + _at(0.0, 19.0 - origin[1]), [0.0, 1.0])
        for row, words in enumerate(
            (
                "x: the arm looks",
                "this way. The axis",
                f"of its base: {-origin[1]:.1f} mm",
                "below the paper's",
                "edge, on this line",
            )
        ):
            self._text(np.array([origin[0] + 1.8, 18.5 - 2.6 * row]), words, 6, grey=_QUIET, room=15.0)

    def words(self, arm_name: str) -> None:
        """Title and how to use the sheet, in the gaps between the upper tags."""
        top = self.height - 10.5
        gaps = self._upper_gaps()
        room = gaps[0][1] - gaps[0][0]
        self._text(np.array([gaps[0][0], top]), _latin(arm_name), 10, bold=True, room=room)
        self._text(np.array([gaps[0][0], top - 4.6]), f"Calibration sheet {self.layout.name}", 8, room=room)
        self._text(np.array([gaps[0][0], top - 8.6]), self.layout.page.name, 6.5, grey=_QUIET)
        for (left, _), lines in zip(gaps[1:], _HOW, strict=False):
            for row, words in enumerate(lines):
                self._text(np.array([left, top + 0.5 - 3.1 * row]), words, 6.5, grey=_QUIET, room=room)

    def corners(self, low_mm: FloatArray, high_mm: FloatArray) -> None:
        """Corners round where the arm will draw, if it is no farther off than an arm is that was never calibrated."""
        ends = self.layout.to_page_mm(np.array([low_mm - _CLEAR_MM, high_mm + _CLEAR_MM]))
        low, high = self.layout.ink_page_mm
        for u, inwards in zip(np.sort(ends[:, 0]).clip(low[0] + 1, high[0] - 1), (1, -1), strict=True):
            for v, upwards in zip(np.sort(ends[:, 1]).clip(low[1] + 1, high[1] - 1), (1, -1), strict=True):
                self._line([u, v], [u + 3 * inwards, v], width=0.15, grey=_FAINT)
                self._line([u, v], [u, v + 3 * upwards], width=0.15, grey=_FAINT)

    def _upper_gaps(self) -> list[tuple[float, float]]:
        """Where the gaps between the upper tags begin and end, left to right."""
        corners = [self.layout.tag_corners_page_mm(place) for place in self.layout.tag_places]
        upper = sorted((each for each in corners if each[:, 1].max() > self.height - 10.0), key=lambda each: each[0, 0])
        return [(left[:, 0].max() + 3.0, right[:, 0].min() - 3.0) for left, right in pairwise(upper)]

    def _line(
        self, start: Sequence[float] | FloatArray, end: Sequence[float] | FloatArray, *, width: float, grey: int = _INK
    ) -> None:
        self.pdf.set_draw_color(grey)
        self.pdf.set_line_width(width)
        self.pdf.line(start[0], self.height - start[1], end[0], self.height - end[1])

    def _arrow(self, tip: FloatArray, along: Sequence[float]) -> None:
        forward, side = np.array(along), np.array([-along[1], along[0]])
        corners = [tip + 2.2 * forward, tip + 0.8 * side, tip - 0.8 * side]
        self.pdf.set_fill_color(_QUIET)
        self.pdf.polygon([(u, self.height - v) for u, v in corners], style="F")

    def _text(
        self,
        place: FloatArray,
        words: str,
        points: float,
        *,
        align: str = "L",
        bold: bool = False,
        grey: int = _INK,
        room: float = math.inf,
    ) -> None:
        """Words on a line that starts, or has its middle, at a place, smaller where they need more room than there
        is."""
        self.pdf.set_font(_FONT, "B" if bold else "", points)
        self.pdf.set_text_color(grey)
        width = self.pdf.get_string_width(words)
        if width > room:
            self.pdf.set_font_size(points * room / width)
        u = place[0] - (width / 2 if align == "C" else 0.0)
        self.pdf.text(u, self.height - place[1], words)


def _at(u: float, v: float) -> FloatArray:
    return np.array([u, v])


def _rectangles(modules: FloatArray) -> list[tuple[int, int, int, int]]:
    """Left, top, width and height of rectangles that cover the black (0) modules, in modules: runs of each row, those
    that go on in the next row as one."""
    open_runs: dict[tuple[int, int], int] = {}
    found = []
    rows = [*(_runs(row) for row in modules), set()]
    for number, runs in enumerate(rows):
        for run in [run for run in open_runs if run not in runs]:
            top = open_runs.pop(run)
            found.append((run[0], top, run[1] - run[0], number - top))
        for run in runs:
            open_runs.setdefault(run, number)
    return found


def _runs(row: FloatArray) -> set[tuple[int, int]]:
    """First and one past the last index of each stretch of zeros."""
    edges = np.flatnonzero(np.diff(np.concatenate(([1], row, [1]))))
    return {(int(start), int(end)) for start, end in edges.reshape(-1, 2)}


def _latin(words: str) -> str:
    """What the page's font can show of a name."""
    return words.encode("latin-1", errors="replace").decode("latin-1")
