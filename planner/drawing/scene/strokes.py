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
    start, end = subpath.beziers[0, 0], subpath.beziers[-1, 3]
    if subpath.is_closed or np.array_equal(start, end):
        return subpath
    edge = polyline(np.stack((end, start)))
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
        return [closed(path) if fills else path for path, fills in zip(outline, _fill(outline, has_fill), strict=True)]
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
        for path, fills in zip(outline, _fill(outline, has_fill), strict=True)
        if fills and closed(path) is not path
    ]
    return [*lines, *edges]


def dash_array(style: Style) -> list[float]:
    """Empty for a solid line."""
    text = style["stroke-dasharray"]
    if text == "none":
        return []
    lengths = [style.in_units(word, "diagonal") for word in text.replace(",", " ").split()]
    return [length for length in lengths if length is not None] if None not in lengths else []


def _fill(outline: Sequence[Subpath], has_fill: bool) -> Sequence[bool]:
    """Whether the fill of each subpath can be seen."""
    if not has_fill or not outline:
        return [False] * len(outline)
    from planner.drawing.cut.area import have_area

    found: Sequence[bool] = have_area(outline).tolist()
    return found


def _number(text: str | None) -> float | None:
    try:
        value = float(text) if text is not None else -1.0
    except ValueError:
        return None
    return value if value >= 0.0 else None
