"""The outlines of shape elements, in their own user units."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from planner.drawing.arcs import ellipse_cubics
from planner.drawing.path_data import Curves, parse_path, parse_points
from planner.drawing.style.style import Style
from planner.drawing.style.units import Axis
from planner.drawing.subpath import Subpath, polyline
from planner.drawing.xml_tree import Element


def outline_of(element: Element, style: Style) -> list[Subpath]:
    """The subpaths of a shape element, as it was written: segments of zero length and closing ones included. Empty for
    a shape that is not shown, such as a circle without a radius."""
    return _OUTLINES[element.tag](element, style)


def rectangle(x: float, y: float, width: float, height: float, rx: float = 0.0, ry: float = 0.0) -> Subpath:
    """From the left end of its upper side on, clockwise on the page; the radii are no larger than half a side."""
    right, bottom, quarter = x + width, y + height, math.pi / 2.0
    curves = Curves()
    curves.begin()
    if rx <= 0.0 or ry <= 0.0:
        corners = ((x, y), (right, y), (right, bottom), (x, bottom))
        for start, end in zip(corners, (*corners[1:], corners[0]), strict=True):
            curves.line(*start, *end)
    else:
        bends = (
            ((right - rx, y), (right - rx, y + ry), -quarter, (right, y + ry)),
            ((right, bottom - ry), (right - rx, bottom - ry), 0.0, (right - rx, bottom)),
            ((x + rx, bottom), (x + rx, bottom - ry), quarter, (x, bottom - ry)),
            ((x, y + ry), (x + rx, y + ry), 2.0 * quarter, (x + rx, y)),
        )
        at = (x + rx, y)
        for before, center, start_rad, after in bends:
            curves.line(*at, *before)
            curves.cubics(*before, ellipse_cubics(*center, rx, ry, start_rad, quarter), after)
            at = after
    curves.is_closed[-1] = True
    return curves.subpaths()[0]


def ellipse(x: float, y: float, rx: float, ry: float) -> Subpath:
    """From its rightmost point on, clockwise on the page."""
    curves = Curves()
    curves.begin()
    start = (x + rx, y)
    curves.cubics(*start, ellipse_cubics(x, y, rx, ry, 0.0, 2.0 * math.pi), start)
    curves.is_closed[-1] = True
    return curves.subpaths()[0]


def _path(_: Element, style: Style) -> list[Subpath]:
    return parse_path(style["d"])


def _rect(_: Element, style: Style) -> list[Subpath]:
    width, height = _length(style, "width", "x"), _length(style, "height", "y")
    if width <= 0.0 or height <= 0.0:
        return []
    rx, ry = _radii(style)
    x, y = _length(style, "x", "x"), _length(style, "y", "y")
    return [rectangle(x, y, width, height, min(rx, width / 2.0), min(ry, height / 2.0))]


def _radii(style: Style) -> tuple[float, float]:
    """One that is `auto`, or negative, is as large as the other."""
    rx, ry = style.length("rx", "x"), style.length("ry", "y")
    rx = None if rx is not None and rx < 0.0 else rx
    ry = None if ry is not None and ry < 0.0 else ry
    if rx is None:
        rx = ry or 0.0
    return rx, rx if ry is None else ry


def _circle(_: Element, style: Style) -> list[Subpath]:
    radius = _length(style, "r", "diagonal")
    return _round(style, radius, radius)


def _ellipse(_: Element, style: Style) -> list[Subpath]:
    return _round(style, *_radii(style))


def _round(style: Style, rx: float, ry: float) -> list[Subpath]:
    if rx <= 0.0 or ry <= 0.0:
        return []
    return [ellipse(_length(style, "cx", "x"), _length(style, "cy", "y"), rx, ry)]


def _line(element: Element, style: Style) -> list[Subpath]:
    axes: tuple[tuple[str, Axis], ...] = (("x1", "x"), ("y1", "y"), ("x2", "x"), ("y2", "y"))
    x1, y1, x2, y2 = (style.in_units(element.attributes.get(name, "0"), axis) or 0.0 for name, axis in axes)
    curves = Curves()
    curves.begin()
    curves.line(x1, y1, x2, y2)
    return curves.subpaths()


def _polyline(element: Element, _: Style) -> list[Subpath]:
    points = parse_points(element.attributes.get("points", ""))
    return [polyline(points)] if len(points) else []


def _polygon(element: Element, _: Style) -> list[Subpath]:
    points = parse_points(element.attributes.get("points", ""))
    return [polyline(np.concatenate((points, points[:1])), is_closed=True)] if len(points) else []


def _length(style: Style, name: str, axis: Axis) -> float:
    return style.length(name, axis) or 0.0


_OUTLINES: dict[str, Callable[[Element, Style], list[Subpath]]] = {
    "path": _path,
    "rect": _rect,
    "circle": _circle,
    "ellipse": _ellipse,
    "line": _line,
    "polyline": _polyline,
    "polygon": _polygon,
}
SHAPES = frozenset(_OUTLINES)
