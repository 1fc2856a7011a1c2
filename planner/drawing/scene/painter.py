"""From what a walk finds to shapes: paint, strokes, markers, patterns, pictures."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from planner.affine import compose, rotation
from planner.arrays import FloatArray
from planner.drawing.path_data import has_foreign_characters, has_unusable_numbers
from planner.drawing.scene.boxes import box_of_subpaths, corners_of, moved_box
from planner.drawing.scene.clips import Clips, resource_place, window_region
from planner.drawing.scene.images import picture_of
from planner.drawing.scene.markers import Vertex, vertices
from planner.drawing.scene.paints import AnyPaint, paint_of
from planner.drawing.scene.patterns import Tiles
from planner.drawing.scene.place import NESTING_LIMIT, Clipped, Leaf, Place, Window
from planner.drawing.scene.references import by_url
from planner.drawing.scene.shape import Paint, Shape, Stroke
from planner.drawing.scene.strokes import closed, is_dot, stroke_lines, without_still_curves
from planner.drawing.scene.viewport import fitted, parse_view_box
from planner.drawing.scene.walk import Tree, attribute_length, hides_overflow, leaves
from planner.drawing.shapes import SHAPES, outline_of, rectangle
from planner.drawing.style.colour import parse_url
from planner.drawing.style.style import Style
from planner.drawing.subpath import Subpath
from planner.drawing.transforms import IDENTITY, parse_angle, scaling, translation
from planner.drawing.xml_tree import Element

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

LARGEST_COORDINATE = 1e9
"""Beyond this a coordinate is a mistake."""
TILED_LIMIT = 50_000
"""Subpaths of all tiles of one pattern on one shape."""
_HAS_MARKERS = frozenset({"path", "line", "polyline", "polygon"})
_BLACK = Paint((0, 0, 0), False)
_GREY = Paint((128, 128, 128), False)


class Painter:
    """Paints what is shown in one document. is_mask: whether pictures are painted as greys, which is what they are to a
    mask, and not as missing."""

    def __init__(self, tree: Tree, is_mask: bool = False) -> None:
        self._tree, self._is_mask = tree, is_mask
        self._clips = Clips(tree, lambda found: Painter(tree, is_mask=True).shapes(found), self._outlines)
        self._shapes: list[Shape] = []

    def shapes(self, found: Iterable[Leaf]) -> list[Shape]:
        """Everything that leaves show, in the order in which it is painted."""
        before, self._shapes = self._shapes, []
        for leaf in found:
            if leaf.place.opacity > 0.0:
                self._paint(leaf)
        self._shapes, painted = before, self._shapes
        return painted

    def _paint(self, leaf: Leaf) -> None:
        tag = leaf.element.tag
        if tag in SHAPES:
            if leaf.style["visibility"] == "visible":
                self._shape(leaf)
        elif tag == "image":
            self._image(leaf)
        elif tag == "text":
            self._text(leaf)
        elif leaf.style["visibility"] == "visible":
            self._tree.work.skipped["foreignObject"] += 1

    def _shape(self, leaf: Leaf) -> None:
        outline = self._outlines(leaf)
        if not outline:
            return
        self._outline(leaf, outline)
        if leaf.element.tag in _HAS_MARKERS:
            self._markers(leaf, outline)

    def _outlines(self, leaf: Leaf) -> Sequence[Subpath]:
        """The outline of a shape, its numbers looked at and counted."""
        if leaf.element.tag == "text":
            return []
        if leaf.element.tag == "path":
            data = leaf.style["d"]
            if has_unusable_numbers(data):
                self._tree.work.skipped["path with unusable numbers"] += 1
                return []
            if has_foreign_characters(data):
                self._tree.work.skipped["path with unreadable data"] += 1
        outline = outline_of(leaf.element, leaf.style)
        self._tree.work.subpaths(len(outline), sum(len(path.beziers) for path in outline))
        return outline

    def _outline(self, leaf: Leaf, outline: Sequence[Subpath]) -> None:
        style, place = leaf.style, leaf.place

        def box() -> tuple[float, float, float, float] | None:
            return box_of_subpaths(outline)

        fill = paint_of(self._tree, "fill", style, place, box) if leaf.element.tag != "line" else None
        stroke = self._stroke(leaf, box)
        if fill is None and stroke is None:
            return
        clips = self._clips.regions(place.clips)
        drawn = [without_still_curves(path) for path in outline if path.is_vertex.any()]
        if isinstance(fill, Tiles):
            fill = self._tiled(fill, leaf, drawn, clips)
        if stroke is not None:
            to_px = compose(self._tree.px_per_user, place.to_user)
            lines = stroke_lines(leaf.element, style, drawn, fill is not None, to_px)
        elif fill is not None:
            lines = [closed(path) for path in drawn if not is_dot(path)]
        else:
            return
        moved = self._moved([*drawn, *lines], place.to_user)
        self._shapes.append(
            Shape(
                tuple(moved[path] for path in drawn if path in moved),
                tuple(moved[path] for path in lines if path in moved),
                fill,
                style["fill-rule"] == "evenodd",
                stroke,
                clips,
                place.layer,
            )
        )

    def _moved(self, paths: Iterable[Subpath], to_user: FloatArray) -> dict[Subpath, Subpath]:
        """Each path in user units, those left out that end up nowhere."""
        is_squeezed = abs(np.linalg.det(to_user[:, :2])) == 0.0
        moved = {}
        for path in dict.fromkeys(paths) if not is_squeezed else ():
            there = path if to_user is IDENTITY else path.moved(to_user)
            if np.all(np.abs(there.beziers) < LARGEST_COORDINATE):
                moved[path] = there
            else:
                self._tree.work.skipped["path with unusable numbers"] += 1
        return moved

    def _stroke(self, leaf: Leaf, box: object) -> Stroke | None:
        width = leaf.style.length("stroke-width", "diagonal") or 0.0
        paint = paint_of(self._tree, "stroke", leaf.style, leaf.place, box) if width > 0.0 else None
        if paint is None:
            return None
        to_user = leaf.place.to_user
        if leaf.style["vector-effect"] == "non-scaling-stroke":
            width /= _scale(self._tree.px_per_user)
        else:
            width *= _scale(to_user)
        return Stroke(_BLACK if isinstance(paint, Tiles) else paint, width)

    def _markers(self, leaf: Leaf, outline: Sequence[Subpath]) -> None:
        style = leaf.style
        markers = {}
        for name in ("marker-start", "marker-mid", "marker-end"):
            url = parse_url(style[name]) if style[name] != "none" else None
            marker = by_url(self._tree.document, url, "marker") if url is not None else None
            if marker is not None and self._may_show(marker, leaf.place):
                markers[name] = marker
        if not markers:
            return
        for vertex in vertices(outline):
            if vertex.name in markers:
                place = self._marker_place(markers[vertex.name], leaf, vertex)
                if place is not None:
                    self._shapes.extend(self.shapes(leaves(self._tree, markers[vertex.name].children, place)))

    def _may_show(self, resource: Element, place: Place) -> bool:
        """Whether a marker or a pattern can be shown in a place: not inside of itself."""
        if place.inside is not None and place.inside.holds(resource):
            self._tree.work.skipped["reference to itself"] += 1
            return False
        if place.nesting >= NESTING_LIMIT:
            self._tree.work.skipped["references nested too deeply"] += 1
            return False
        return True

    def _marker_place(self, marker: Element, leaf: Leaf, vertex: Vertex) -> Place | None:
        """The place of what a marker shows at a vertex; None where nothing of it can be seen."""
        style = self._tree.style_of(marker)
        attributes = marker.attributes
        unit = 1.0
        if attributes.get("markerUnits") != "userSpaceOnUse":
            unit = leaf.style.length("stroke-width", "diagonal") or 0.0
        width = attribute_length(style, attributes.get("markerWidth", "3"), "x", None)
        height = attribute_length(style, attributes.get("markerHeight", "3"), "y", None)
        view_box = parse_view_box(attributes.get("viewBox"))
        if min(unit, width, height) <= 0.0 or (view_box is not None and min(view_box[2:]) == 0.0):
            return None
        orient = attributes.get("orient", "0").strip()
        if orient in ("auto", "auto-start-reverse"):
            is_turned = orient != "auto" and vertex.name == "marker-start"
            angle_deg = vertex.angle_deg + (180.0 if is_turned else 0.0)
        else:
            angle_deg = math.degrees(parse_angle(orient) or 0.0)
        at = compose(translation(vertex.x, vertex.y), compose(rotation(angle_deg), scaling(unit, unit)))
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
        place = replace(place, opacity=leaf.place.opacity, clips=clips, context=leaf)
        if style["clip-path"] != "none" or style["mask"] != "none":
            place = replace(place, clips=(*clips, Clipped(marker, style, place)))
        return place

    def _tiled(self, tiles: Tiles, leaf: Leaf, outline: Sequence[Subpath], clips: tuple[BaseGeometry, ...]) -> AnyPaint:
        """Paint the tiles of a fill; what remains to be painted of it, where they are too many to be drawn."""
        from planner.drawing.cut.region import region

        place = leaf.place
        box = box_of_subpaths(outline)
        if box is None or not self._may_show(tiles.content, place):
            return None
        moves = tiles.over(moved_box(box, place.to_user))
        style = self._tree.style_of(tiles.content)
        inner = resource_place(tiles.content, style, place, compose(tiles.to_user, tiles.to_tile), tiles.viewport)
        inner = replace(inner, opacity=place.opacity)
        content = self.shapes(leaves(self._tree, tiles.content.children, inner))
        n_subpaths = sum(len(shape.lines) for shape in content)
        if moves is None or len(moves) * n_subpaths > TILED_LIMIT:
            self._tree.work.skipped["pattern of too many tiles"] += 1
            return _BLACK
        self._tree.work.subpaths(n_subpaths * len(moves), 0)
        whole = region(list(self._moved(outline, place.to_user).values()), leaf.style["fill-rule"] == "evenodd")
        frame = window_region(Window(tiles.tile, tiles.to_user))
        is_held = [_is_within(shape, tiles) for shape in content]
        for move in moves:
            for shape, held in zip(content, is_held, strict=True):
                own = shape.clips if held else (*shape.clips, frame)
                self._shapes.append(
                    Shape(
                        tuple(path.moved(move) for path in shape.outline),
                        tuple(path.moved(move) for path in shape.lines),
                        shape.fill,
                        shape.is_even_odd,
                        shape.stroke,
                        (*(_moved_region(clip, move) for clip in own), whole, *clips),
                        place.layer,
                    )
                )
        return None

    def _image(self, leaf: Leaf) -> None:
        if leaf.style["visibility"] != "visible":
            return
        picture = picture_of(self._tree, leaf)
        if picture is None:
            return
        if picture.tree is not None and picture.found is not None:
            self._shapes.extend(Painter(picture.tree, self._is_mask).shapes(picture.found))
            return
        if self._is_mask and picture.box is not None:
            path = rectangle(*picture.box).moved(leaf.place.to_user)
            clips = self._clips.regions(leaf.place.clips)
            self._shapes.append(Shape((path,), (), _GREY, False, None, clips, leaf.place.layer))
            return
        self._tree.work.skipped[picture.kind] += 1

    def _text(self, leaf: Leaf) -> None:
        if any(element.text.strip() for element in leaf.element.descendants()):
            self._tree.work.skipped["text"] += 1


def _scale(affine: FloatArray) -> float:
    return math.sqrt(abs(float(np.linalg.det(affine[:, :2]))))


def _is_within(shape: Shape, tiles: Tiles) -> bool:
    """Whether all that a shape draws lies in the tile."""
    from planner.affine import inverse

    x, y, width, height = tiles.tile
    slack = 1e-9 * max(width, height)
    back = inverse(tiles.to_user)
    for path in shape.lines:
        points = path.beziers @ back[:, :2].T + back[:, 2]
        low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
        if np.any(low < np.array((x, y)) - slack) or np.any(high > np.array((x + width, y + height)) + slack):
            return False
    return True


def _moved_region(clip: BaseGeometry, move: FloatArray) -> BaseGeometry:
    import shapely

    return shapely.transform(clip, lambda points: points + move[:, 2])
