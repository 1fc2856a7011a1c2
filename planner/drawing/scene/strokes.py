"""What a pen draws of an outline."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from planner.affine import inverse
from planner.arrays import FloatArray, frozen
from planner.drawing.style.style import Style
from planner.drawing.subpath import Subpath, polyline
from planner.drawing.xml_tree import Element


def without_still_curves(subpath: Subpath) -> Subpath:
    """Without curves of no length; one that has no length at all is one curve."""
    has_length = (subpath.beziers[:, 1:] != subpath.beziers[:, :1]).any(axis=(1, 2))
    if has_length.all():
        return subpath
    kept = has_length if np.any(has_length) else np.arange(len(has_length)) == 0
    return Subpath(frozen(subpath.beziers[kept]), subpath.is_closed, subpath.is_vertex[kept])


def closed(subpath: Subpath) -> Subpath:
    """The same with the edge that a fill gives it."""
    if not _is_open(subpath):
        return subpath
    edge = polyline(np.stack((subpath.beziers[-1, 3], subpath.beziers[0, 0])))
    return Subpath(
        frozen(np.concatenate((subpath.beziers, edge.beziers))), True, np.append(subpath.is_vertex, edge.is_vertex)
    )


def stroke_lines(
    element: Element, style: Style, outline: Sequence[Subpath], has_fill: bool, to_px: Callable[[], FloatArray]
) -> list[Subpath]:
    """The lines of a visible stroke, and the edges that close open subpaths where there is a fill too. `to_px` gives
    the way (2, 3) to CSS pixels on the page, which the dashes of a stroke that does not scale are measured in."""
    outline = [path for path in outline if not path.is_dot or style["stroke-linecap"] != "butt"]
    array = dash_array(style)
    if not array:
        are_fills = _are_open_fills(outline, has_fill)
        return [closed(path) if is_fill else path for path, is_fill in zip(outline, are_fills, strict=True)]
    from planner.drawing.cut.dash import dashed

    offset = style.length("stroke-dashoffset", "diagonal") or 0.0
    path_length = _number(element.attributes.get("pathLength"))
    if style["vector-effect"] == "non-scaling-stroke":
        forth = to_px()
        dashes = dashed([path.moved(forth) for path in outline], array, offset, path_length)
        lines = [dash.moved(inverse(forth)) for dash in dashes]
    else:
        lines = dashed(outline, array, offset, path_length)
    edges = [
        polyline(np.stack((path.beziers[-1, 3], path.beziers[0, 0])))
        for path, is_fill in zip(outline, _are_open_fills(outline, has_fill), strict=True)
        if is_fill
    ]
    return [*lines, *edges]


def dash_array(style: Style) -> list[float]:
    """Empty for a solid line."""
    text = style["stroke-dasharray"]
    if text == "none":
        return []
    lengths = [style.in_units(word, "diagonal") for word in text.replace(",", " ").split()]
    return [length for length in lengths if length is not None] if None not in lengths else []


def _are_open_fills(outline: Sequence[Subpath], has_fill: bool) -> Sequence[bool]:
    """Whether the fill of each subpath has an edge that the subpath has not, and covers anything."""
    asked = [has_fill and _is_open(path) and not _is_line(path) for path in outline]
    if not any(asked):
        return asked
    from planner.drawing.cut.area import have_area

    found = iter(have_area([path for path, is_asked in zip(outline, asked, strict=True) if is_asked]).tolist())
    return [is_asked and next(found) for is_asked in asked]


def _is_open(path: Subpath) -> bool:
    return not path.is_closed and path.beziers[0, 0].tolist() != path.beziers[-1, 3].tolist()


def _is_line(path: Subpath) -> bool:
    """Whether it is one straight line as path data make them."""
    if len(path.beziers) > 1:
        return False
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = path.beziers[0].tolist()
    across, down = (x3 - x0) / 3.0, (y3 - y0) / 3.0
    return (x1, y1, x2, y2) == (x0 + across, y0 + down, x3 - across, y3 - down)


def _number(text: str | None) -> float | None:
    try:
        value = float(text) if text is not None else -1.0
    except ValueError:
        return None
    return value if value >= 0.0 else None
