"""A drawing as polylines on its page, for people and for other programs."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

from planner.affine import scale_of
from planner.arrays import FloatArray
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import flatten_all
from planner.pens import hex_of

_DECIMALS = 6
_PEN_MM = 0.3
_NO_XML = dict.fromkeys(range(32))


@dataclass(frozen=True, eq=False, slots=True)
class PlainLine:
    """points_mm: (n, 2) on the page, y down; a tap has one. width_mm: of the stroke, 0 where it is the edge of a
    fill."""

    points_mm: FloatArray
    layer: str
    colour: str
    width_mm: float


def plain_lines(drawing: Drawing, chord_error_mm: float) -> list[PlainLine]:
    """The outlines in the order of painting. Errors: PlanError where they come to too many points."""
    scale = scale_of(drawing.user_to_page)
    return [
        PlainLine(points, outline.layer, hex_of(outline.colour), scale * outline.width)
        for outline, points in zip(
            drawing.outlines, flatten_all(drawing.outlines, drawing.user_to_page, chord_error_mm), strict=True
        )
    ]


def as_json(drawing: Drawing, lines: Sequence[PlainLine]) -> str:
    """One line of text a line, the same for the same drawing."""
    rows = [
        json.dumps({"points": line.points_mm.round(_DECIMALS).tolist(), "layer": line.layer, "colour": line.colour})
        for line in lines
    ]
    page, skipped = (
        json.dumps([round(length, _DECIMALS) for length in drawing.page_mm]),
        json.dumps(dict(sorted(drawing.skipped.items()))),
    )
    listed = ",\n".join(rows)
    has_page = json.dumps(drawing.has_page)
    return f'{{"page_mm": {page}, "has_page": {has_page},\n"lines": [\n{listed}\n],\n"skipped": {skipped}}}\n'


def as_svg(drawing: Drawing, lines: Sequence[PlainLine]) -> str:
    """An SVG at its true size: a group for each layer, marked as Inkscape does, in the order of their first lines."""
    width, height = (f"{length:.{_DECIMALS}g}" for length in drawing.page_mm)
    parts = [
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
        f' width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}"'
        ' fill="none" stroke-linecap="round" stroke-linejoin="round">\n'
    ]
    layers: dict[str, list[PlainLine]] = {}
    for line in lines:
        layers.setdefault(line.layer, []).append(line)
    for layer, members in layers.items():
        name = quoteattr(layer.translate(_NO_XML))
        parts.append(f'<g inkscape:groupmode="layer" inkscape:label={name}>\n' if layer else "<g>\n")
        for line in members:
            points = " ".join(f"{x:.12g},{y:.12g}" for x, y in (line.points_mm.round(_DECIMALS) + 0.0).tolist())
            shape = f'<path d="M {points} h 0"' if len(line.points_mm) == 1 else f'<polyline points="{points}"'
            parts.append(f'{shape} stroke="{line.colour}" stroke-width="{line.width_mm or _PEN_MM:.4g}"/>\n')
        parts.append("</g>\n")
    return "".join([*parts, "</svg>\n"])
