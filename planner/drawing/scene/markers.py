"""Where markers sit on a path, which way they point, and how large they are (SVG 2, section 13.7)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from planner.affine import compose, rotation
from planner.drawing.scene.place import Clipped, Leaf, Place, Window, resource_place
from planner.drawing.scene.viewport import fitted, parse_view_box
from planner.drawing.scene.walk import Tree, attribute_length, hides_overflow
from planner.drawing.subpath import Subpath
from planner.drawing.transforms import IDENTITY, parse_angle, scaling, translation
from planner.drawing.xml_tree import Element

Vector = tuple[float, float]
_NOWHERE = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Vertex:
    """x, y: where a marker sits. angle_deg: the direction of the path there. name: of the property that puts one."""

    x: float
    y: float
    angle_deg: float
    name: str


@dataclass(slots=True)
class _Corner:
    """A vertex with the directions in which the path comes in and goes out; None where it begins or ends."""

    at: Vector
    coming: Vector | None
    going: Vector | None

    @property
    def angle_deg(self) -> float:
        if self.coming is None or self.going is None:
            return _angle_deg(self.going or self.coming or _NOWHERE)
        first, second = _angle_deg(self.coming), _angle_deg(self.going)
        # Straight back it turns to the left.
        turn = (second - first + 180.0) % 360.0 - 180.0
        return first + turn / 2.0


def vertices(subpaths: Sequence[Subpath]) -> list[Vertex]:
    """All vertices in order: the first has the start marker, the last the end marker, the others the middle ones, the
    moves between subpaths included."""
    corners: list[_Corner] = []
    for before, subpath in zip((None, *subpaths[:-1]), subpaths, strict=True):
        found = _corners(subpath)
        corners.extend(found[1:] if before is not None and _goes_on(before, subpath) else found)
    last = len(corners) - 1
    return [
        Vertex(*corner.at, corner.angle_deg, "marker-end" if at == last else "marker-mid" if at else "marker-start")
        for at, corner in enumerate(corners)
    ]


def _goes_on(before: Subpath, subpath: Subpath) -> bool:
    """Whether a subpath begins without a move of its own, after the one before was closed."""
    is_same = bool(np.array_equal(before.beziers[0, 0], subpath.beziers[0, 0]))
    return before.is_closed and is_same and bool(subpath.is_vertex.any())


def _corners(subpath: Subpath) -> list[_Corner]:
    (start, *_), ends = subpath.beziers[0].tolist(), np.flatnonzero(subpath.is_vertex)
    corners = [_Corner((start[0], start[1]), None, None)]
    first = 0
    for end in ends.tolist():
        corners[-1].going = _tangent(subpath.beziers[first].tolist())
        backwards = _tangent(subpath.beziers[end, ::-1].tolist())
        x, y = subpath.beziers[end, 3].tolist()
        corners.append(_Corner((x, y), (0.0 - backwards[0], 0.0 - backwards[1]), None))
        first = end + 1
    if subpath.is_closed:
        _close(corners)
    return corners


def _close(corners: list[_Corner]) -> None:
    """At the end of a closed subpath its start follows, and before its start comes its end. Where `Z` has no way to go,
    as after another one, it goes the way of the start."""
    start = corners[0]
    corners[-1].going = start.going
    for before, corner in zip(corners[-2::-1], corners[:0:-1], strict=True):
        if corner.at != start.at or corner.coming != _NOWHERE:
            break
        corner.coming = before.going = start.going
    start.coming = corners[-1].coming


def _tangent(points: Sequence[Sequence[float]]) -> Vector:
    """The direction in which a cubic starts: towards the first of its points that is elsewhere."""
    x, y = points[0]
    return next(((u - x, v - y) for u, v in points[1:] if (u, v) != (x, y)), _NOWHERE)


def _angle_deg(direction: Vector) -> float:
    return math.degrees(math.atan2(direction[1], direction[0]))


def marker_place(tree: Tree, marker: Element, leaf: Leaf, vertex: Vertex) -> Place | None:
    """The place of what a marker shows at a vertex of a leaf; None where nothing of it can be seen."""
    style, attributes = tree.style_of(marker), marker.attributes
    unit = 1.0
    if attributes.get("markerUnits") != "userSpaceOnUse":
        unit = leaf.style.length("stroke-width", "diagonal") or 0.0
    width = attribute_length(style, attributes.get("markerWidth", "3"), "x", None)
    height = attribute_length(style, attributes.get("markerHeight", "3"), "y", None)
    view_box = parse_view_box(attributes.get("viewBox"))
    if min(unit, width, height) <= 0.0 or (view_box is not None and min(view_box[2:]) == 0.0):
        return None
    turn = rotation(_orientation_deg(attributes.get("orient", "0").strip(), vertex))
    at = compose(translation(vertex.x, vertex.y), compose(turn, scaling(unit, unit)))
    fit = IDENTITY
    if view_box is not None:
        fit = fitted(view_box, (width, height), attributes.get("preserveAspectRatio"))
    ref_x = attribute_length(style, attributes.get("refX", "0"), "x", None)
    ref_y = attribute_length(style, attributes.get("refY", "0"), "y", None)
    x, y = (fit[:, :2] @ (ref_x, ref_y) + fit[:, 2]).tolist()
    frame = compose(leaf.place.to_user, compose(at, translation(-x, -y)))
    viewport = view_box[2:] if view_box is not None else (width, height)
    place = resource_place(marker, style, leaf.place, compose(frame, fit), viewport)
    clips = leaf.place.clips
    if hides_overflow(style):
        clips = (*clips, Window((0.0, 0.0, width, height), frame))
    if style["clip-path"] != "none" or style["mask"] != "none":
        clips = (*clips, Clipped(marker, style, replace(place, clips=clips)))
    return replace(place, opacity=leaf.place.opacity, clips=clips, context=leaf)


def _orientation_deg(orient: str, vertex: Vertex) -> float:
    if orient == "auto":
        return vertex.angle_deg
    if orient == "auto-start-reverse":
        return vertex.angle_deg + (180.0 if vertex.name == "marker-start" else 0.0)
    return math.degrees(parse_angle(orient) or 0.0)
