"""Whether text stands where a browser has it: boxes of glyphs against the ink of lines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from planner.arrays import FloatArray

_LOOSE = 0.35
"""Of the height of the glyphs: faces differ in their widths, heights and bearings."""
_LOOSE_WIDTH = 0.2
"""Of the width of a piece of text, that being its sum."""


def compare_text(boxes: Sequence[FloatArray], ink: Sequence[FloatArray]) -> str:
    """ "agree", "less" (text without ink), "more" (ink without text), "moved" (both, or another size), or "" where
    there is neither. boxes: corners (n, 2) of what is written; ink: our lines of text, all in mm."""
    areas = [shapely.Polygon(box) if len(box) > 3 else shapely.LineString(box) for box in boxes]
    areas = [area.buffer(1e-6) for area in areas if area.length > 0.0]
    lines = [shapely.LineString(line) if len(line) > 1 else shapely.Point(line[0]) for line in ink if len(line)]
    if not areas:
        return "more" if lines else ""
    if not lines:
        return "less"
    words = shapely.get_parts(shapely.unary_union([area.buffer(0.3 * _side(area)) for area in areas]))
    drawn = shapely.union_all(lines)
    is_less, is_more, is_off = False, False, False
    allowed = shapely.unary_union(
        [area.buffer(_LOOSE * _side(area) + _LOOSE_WIDTH * 0.5 * area.length / 4) for area in areas]
    )
    outside = drawn.difference(allowed)
    is_more = outside.length > 0.1 * drawn.length
    for word in words:
        inside = [area for area in areas if word.intersects(area)]
        written = shapely.union_all(inside).bounds
        here = drawn.intersection(word.buffer(0.1 * _side(word)))
        if here.is_empty:
            is_less = True
            continue
        side = max(_side(area) for area in inside)
        slack = np.array([max(_LOOSE * side, _LOOSE_WIDTH * (written[i + 2] - written[i])) for i in (0, 1, 0, 1)])
        is_off |= bool((np.abs(np.subtract(here.bounds, written)) > slack).any())
    if is_off or (is_less and is_more):
        return "moved"
    return "less" if is_less else "more" if is_more else "agree"


def _side(area: shapely.Geometry) -> float:
    """About the height of the glyphs: the shorter side of the box."""
    box = shapely.oriented_envelope(area)
    corners = shapely.get_coordinates(box)
    if len(corners) < 3:
        return float(area.length)
    return float(min(np.hypot(*(corners[1] - corners[0])), np.hypot(*(corners[2] - corners[1]))))
