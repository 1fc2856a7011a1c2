"""Gaps of dashes that are too short for a pen: it would lift and lower, and leave no gap to see."""

from __future__ import annotations

from collections.abc import Sequence

from planner.arrays import FloatArray
from planner.drawing.drawing import Outline
from planner.drawing.flatten import flatten_all
from planner.polyline_length import polyline_length

SHORTEST_GAP_MM = 0.5
"""About as wide as a pen's line."""
_LENGTH_MM = SHORTEST_GAP_MM * (1.0 - 1e-4)  # one of just that length is a gap, whatever rounding says
_CHORD_ERROR_MM = 1e-4


def gaps_to_draw(outlines: Sequence[Outline], svg_to_arm: FloatArray) -> list[Outline]:
    """The gaps between dashes that are shorter than that where `svg_to_arm` (2, 3) puts them, as outlines. A gap of
    which the next dash is not there, or not from its start, stays one: something else has cut it off."""
    starts = {outline.beziers[0, 0].tobytes() for outline in outlines}
    gaps = [
        Outline(outline.gap, outline.layer, outline.colour, outline.width)
        for outline in outlines
        if outline.gap is not None and outline.gap[-1, 3].tobytes() in starts
    ]
    lines = flatten_all(gaps, svg_to_arm, _CHORD_ERROR_MM)
    return [gap for gap, line in zip(gaps, lines, strict=True) if polyline_length(line) < _LENGTH_MM]
