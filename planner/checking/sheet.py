"""What one sheet holds of the lines of a drawing that is cut into several, and its register marks."""

from __future__ import annotations

from collections.abc import Sequence

import shapely

from planner.arrays import FloatArray
from planner.checking.wanted import CRUMB_MM, WantedLines, as_lines, cut_lines
from planner.tile import Tile


def on_the_sheet(lines: WantedLines, tile: Tile, chord_mm: float) -> WantedLines:
    """Of lines that are off their curves by up to `chord_mm`. What is so near to a seam that it may be on either side
    is allowed, and not required: its sheet is told by the window alone."""
    near, far, right, left = tile.window_mm
    window = shapely.box(near, right, far, left)
    unsure_mm = 2.0 * chord_mm
    marks = tile.mark_lines()
    allowed = _within(lines.allowed, window.buffer(unsure_mm + CRUMB_MM, join_style="mitre"), 0.0)
    required = _within(lines.required, window.buffer(-unsure_mm, join_style="mitre"), CRUMB_MM)
    return WantedLines([*allowed, *marks], [*required, *marks])


def _within(lines: Sequence[FloatArray], window: shapely.Polygon, crumb_mm: float) -> list[FloatArray]:
    shapes = as_lines(lines)
    is_whole = shapely.covers(window, shapes).tolist()
    left = cut_lines(shapes, is_whole, lambda parts: shapely.intersection(parts, window), crumb_mm)
    return [shapely.get_coordinates(line) for line in left]
