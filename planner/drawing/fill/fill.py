"""What a pen draws to fill areas, and to make strokes as wide as they are."""

from __future__ import annotations

from dataclasses import replace

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
_WIDER = 1.5
"""How much wider than the pen's line a stroke has to be to be drawn more than once."""
_CHORD_MM = 0.01


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
            inner = area.shape.buffer(-options.from_edge_mm) if options.from_edge_mm else area.shape
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
            return spirals(levels, area, spacing_mm)
        return [ring for rings in levels for ring in rings]
    if kind is FillKind.ZIGZAG:
        return hatched(area, angle_rad, spacing_mm / 2, is_zigzag=True)
    lines = hatched(area, angle_rad, spacing_mm)
    return lines + hatched(area, angle_rad + np.pi / 2, spacing_mm) if kind is FillKind.CROSS else lines


def _spacing_mm(options: FillOptions, colour: tuple[int, int, int]) -> float:
    """Between lines of an area of this colour."""
    return options.spacing_mm / (1.0 - lightness(colour)) if options.by is FillBy.LIGHTNESS else options.spacing_mm


def is_wide(outline: Outline, options: FillOptions, mm_per_unit: float) -> bool:
    """Whether it is drawn as an area instead of along its middle."""
    is_asked = options.wide_strokes is WideStrokes.PASSES
    return is_asked and outline.width * mm_per_unit > _WIDER * options.spacing_mm


def _passes(outline: Outline, width_mm: float, options: FillOptions, svg_to_arm: FloatArray) -> list[FloatArray]:
    """Rings within a wide stroke, evenly spaced between its edge and its middle, and the middle."""
    (line,) = flatten_all([outline], svg_to_arm, _CHORD_MM)
    half_mm = (width_mm - options.spacing_mm) / 2
    n_rings = int(np.ceil(half_mm / options.spacing_mm))
    middle = shapely.LineString(line) if len(line) > 1 else shapely.Point(line[0])
    rings: list[FloatArray] = []
    for number in range(n_rings):
        covered = middle.buffer(half_mm * (1.0 - number / n_rings), quad_segs=32)
        parts = [covered.exterior, *covered.interiors] if covered.geom_type == "Polygon" else []
        rings += [np.asarray(part.coords)[:, :2] for part in parts]
    return [*rings, line]


def _outline(
    line: FloatArray, svg_to_arm: FloatArray, back: FloatArray, layer: str, colour: tuple[int, int, int]
) -> Outline:
    is_closed = bool(np.all(line[0] == line[-1]))
    path = polyline((line - svg_to_arm[:, 2]) @ back.T, is_closed and len(line) > 2)
    return Outline(frozen(path.beziers), layer, colour)
