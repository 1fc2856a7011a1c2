"""Whether text stands where a browser has it: boxes of glyphs against the ink of lines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from planner.arrays import FloatArray

_LOOSE = 0.35
"""Of the height of the glyphs: faces differ in their widths, heights and bearings."""
_LOOSE_WIDTH = 0.15
"""Of the width of a piece of text, that being the sum of theirs."""
_STRAY = 0.05
"""Share of the ink that may be outside of the boxes, made larger by so much."""


def compare_text(boxes: Sequence[FloatArray], ink: Sequence[FloatArray]) -> str:
    """ "agree", "less" (text without ink), "more" (ink without text), "moved" (both, or another size), or "" where
    there is neither. boxes: corners (n, 2) of glyphs; ink: our lines of text, both in mm."""
    areas = [shapely.Polygon(box) for box in boxes if len(box) > 3]
    areas = [area for area in areas if area.area > 0.0]
    lines = [shapely.LineString(line) if len(line) > 1 else shapely.Point(line[0]) for line in ink if len(line)]
    if not areas:
        return "more" if lines else ""
    if not lines:
        return "less"
    sides = np.array([_longer_side(area) for area in areas])
    heights = np.maximum(sides, np.median(sides))  # a dash or a dot is as small as its text is large
    words = shapely.get_parts(
        shapely.unary_union([area.buffer(0.3 * height) for area, height in zip(areas, heights, strict=True)])
    )
    drawn = shapely.union_all(lines)
    near = shapely.unary_union([area.buffer(_LOOSE * height) for area, height in zip(areas, heights, strict=True)])
    is_more = drawn.difference(near).length > _STRAY * drawn.length
    is_less, is_off = False, False
    for word in words:
        inside = [index for index, area in enumerate(areas) if word.intersects(area)]
        written = np.array(shapely.union_all([areas[index] for index in inside]).bounds)
        here = drawn.intersection(word)
        if here.is_empty:
            is_less = True
            continue
        slack = np.maximum(_LOOSE * heights[inside].max(), _LOOSE_WIDTH * np.tile(written[2:] - written[:2], 2))
        is_off |= bool((np.abs(here.bounds - written) > slack).any())
    if is_off or (is_less and is_more):
        return "moved"
    return "less" if is_less else "more" if is_more else "agree"


def _longer_side(area: shapely.Polygon) -> float:
    corners = shapely.get_coordinates(shapely.oriented_envelope(area))
    return float(np.hypot(*np.diff(corners, axis=0).T).max())
