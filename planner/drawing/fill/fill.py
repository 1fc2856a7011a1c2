"""What a pen draws to fill areas, and to make strokes as wide as they are."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.affine import scale_of
from planner.arrays import FloatArray, frozen
from planner.drawing.drawing import Drawing, Outline
from planner.drawing.fill.areas import areas, lightness
from planner.drawing.fill.contour import contours, spirals
from planner.drawing.fill.hatch import hatched
from planner.drawing.fill_options import FillBy, FillKind, FillOptions, WideStrokes
from planner.drawing.flatten import flatten_all
from planner.drawing.subpath import polyline

_GOLDEN_DEG = 137.50776405003785
"""From one colour's angle to the next: no two are ever near each other for a while."""
_DOUBLE = (FillKind.CROSS, FillKind.ZIGZAG)
"""Fills whose lines cross or meet: of two hatches that each leave a share of the paper free, the square of it stays."""
_WIDER = 1.5
"""How much wider than the pen's line a stroke has to be to be drawn more than once."""
_NO_INSET_MM = 1e-6
_CHORD_MM = 0.01
_CAPS: dict[str, Literal["flat", "round", "square"]] = {"round": "round", "square": "square"}
_JOINS: dict[str, Literal["mitre", "round", "bevel"]] = {"round": "round", "bevel": "bevel"}


def with_fills(drawing: Drawing, options: FillOptions, svg_to_arm: FloatArray) -> Drawing:
    """The drawing with the lines that fill it, for where `svg_to_arm` (2, 3) puts it: behind its own outlines, so that
    those of a colour stand together. Errors: PlanError where they would be too many."""
    lines = fill_lines(drawing, options, svg_to_arm)
    if not lines:
        return drawing
    mm_per_unit = scale_of(svg_to_arm)
    thin = [outline for outline in drawing.outlines if not is_wide(outline, options, mm_per_unit)]
    return replace(drawing, outlines=(*thin, *lines))


def fill_lines(drawing: Drawing, options: FillOptions, svg_to_arm: FloatArray) -> list[Outline]:
    """The lines that fill areas and wide strokes."""
    if drawing.scene is None or not options.draws_anything:
        return []
    back = np.asarray(np.linalg.inv(svg_to_arm[:, :2]), dtype=np.float64)
    found: list[Outline] = []
    if options.kind is not FillKind.NONE:
        angles: dict[tuple[int, int, int], float] = {}
        for area in areas(drawing.scene, drawing.reading, svg_to_arm):
            spacing_mm = _spacing_mm(options, area.colour)
            turned = _GOLDEN_DEG * angles.setdefault(area.colour, len(angles)) if options.by is FillBy.COLOUR else 0.0
            inner = area.shape.buffer(-options.from_edge_mm) if options.from_edge_mm > _NO_INSET_MM else area.shape
            lines = _lines(inner, options.kind, np.radians(options.angle_deg + turned), spacing_mm)
            found += [_outline(line, svg_to_arm, back, area.layer, area.colour) for line in lines]
    mm_per_unit = scale_of(svg_to_arm)
    for outline in drawing.outlines:
        if is_wide(outline, options, mm_per_unit):
            lines = _passes(outline, outline.width * mm_per_unit, options, svg_to_arm)
            found += [_outline(line, svg_to_arm, back, outline.layer, outline.colour) for line in lines]
    return found


def _lines(area: BaseGeometry, kind: FillKind, angle_rad: float, spacing_mm: float) -> list[FloatArray]:
    # The arm's x points away from it and its y to the left: an angle from left to right, seen from behind, turns there.
    angle_rad += np.pi / 2
    if kind in (FillKind.CONTOUR, FillKind.SPIRAL):
        levels = contours(area, spacing_mm)
        if kind is FillKind.SPIRAL:
            return spirals(levels, spacing_mm)
        return [line for level in levels for line in level.lines]
    if kind is FillKind.ZIGZAG:
        return hatched(area, angle_rad, spacing_mm / 2, is_zigzag=True)
    lines = hatched(area, angle_rad, spacing_mm)
    return lines + hatched(area, angle_rad + np.pi / 2, spacing_mm) if kind is FillKind.CROSS else lines


def _spacing_mm(options: FillOptions, colour: tuple[int, int, int]) -> float:
    """Between lines of an area of this colour."""
    if options.by is not FillBy.LIGHTNESS:
        return options.spacing_mm
    light = lightness(colour)
    if options.kind in _DOUBLE:
        light = light**0.5
    return options.spacing_mm / (1.0 - light)


def is_wide(outline: Outline, options: FillOptions, mm_per_unit: float) -> bool:
    """Whether it is drawn as an area instead of along its middle."""
    is_asked = options.wide_strokes is WideStrokes.PASSES
    return is_asked and outline.width * mm_per_unit > _WIDER * options.spacing_mm


def _passes(outline: Outline, width_mm: float, options: FillOptions, svg_to_arm: FloatArray) -> list[FloatArray]:
    """Lines side by side within a wide stroke; its middle where it is too short for them."""
    (line,) = flatten_all([outline], svg_to_arm, _CHORD_MM)
    if len(line) == 1:
        middle: BaseGeometry = shapely.Point(line[0])
    else:
        is_closed = len(line) > 3 and bool(np.all(line[0] == line[-1]))
        middle = shapely.LinearRing(line) if is_closed else shapely.LineString(line)
    covered = middle.buffer(
        width_mm / 2,
        quad_segs=32,
        cap_style=_CAPS.get(outline.cap, "flat"),
        join_style=_JOINS.get(outline.join, "mitre"),
    )
    inner = covered.buffer(-options.spacing_mm / 2, join_style="mitre")
    return spirals(contours(inner, options.spacing_mm), options.spacing_mm) or [line]


def _outline(
    line: FloatArray, svg_to_arm: FloatArray, back: FloatArray, layer: str, colour: tuple[int, int, int]
) -> Outline:
    is_closed = bool(np.all(line[0] == line[-1]))
    path = polyline((line - svg_to_arm[:, 2]) @ back.T, is_closed and len(line) > 2)
    return Outline(frozen(path.beziers), layer, colour)
