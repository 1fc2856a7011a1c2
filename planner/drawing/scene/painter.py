"""From what a walk finds to shapes: paint, strokes, markers, patterns, pictures."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from planner.affine import compose
from planner.arrays import FloatArray
from planner.drawing.path_data import has_foreign_characters, has_unusable_numbers
from planner.drawing.scene.boxes import box_of_subpaths, moved_box
from planner.drawing.scene.clips import Clips
from planner.drawing.scene.images import picture_of
from planner.drawing.scene.lettering import glyphs_of
from planner.drawing.scene.markers import marker_place, vertices
from planner.drawing.scene.paints import paint_of
from planner.drawing.scene.patterns import Tiles, tiled
from planner.drawing.scene.place import NESTING_LIMIT, Leaf, Place, resource_place
from planner.drawing.scene.references import by_url
from planner.drawing.scene.shape import Paint, Shape, Stroke
from planner.drawing.scene.strokes import closed, stroke_lines, without_still_curves
from planner.drawing.scene.walk import Tree, leaves
from planner.drawing.shapes import SHAPES, outline_of, rectangle
from planner.drawing.style.colour import parse_url
from planner.drawing.subpath import Subpath
from planner.drawing.transforms import IDENTITY
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
        self._outline(leaf, outline, outline)
        if leaf.element.tag in _HAS_MARKERS:
            self._markers(leaf, outline)

    def _outlines(self, leaf: Leaf) -> Sequence[Subpath]:
        """The outline of a shape or of a text, its numbers looked at and counted."""
        if leaf.element.tag == "text":
            return [path for run in glyphs_of(self._tree, leaf, is_area=True) for path in run.subpaths]
        if leaf.element.tag == "path":
            data = leaf.style["d"]
            if has_unusable_numbers(data):
                self._tree.work.skipped["path with unusable numbers"] += 1
                return []
            if has_foreign_characters(data):
                self._tree.work.skipped["path with unreadable data"] += 1
        outline = outline_of(leaf.element, leaf.style)
        self._count(outline)
        usable = [path for path in outline if _is_usable(path)]
        if len(usable) < len(outline):
            self._tree.work.skipped["path with unusable numbers"] += len(outline) - len(usable)
        return usable

    def _outline(self, leaf: Leaf, outline: Sequence[Subpath], whole: Sequence[Subpath]) -> None:
        """An outline with fill and stroke; `whole` is what the box of its paints is around."""
        style, place = leaf.style, leaf.place
        fill = None
        if leaf.element.tag != "line":
            fill = paint_of(self._tree, "fill", style, place, lambda: box_of_subpaths(whole))
        stroke = self._stroke(leaf, whole)
        if fill is None and stroke is None:
            return
        if not self._can_be_seen(place):
            return
        clips = self._clips.regions(place.clips)
        drawn = [without_still_curves(path) for path in outline if path.is_vertex.any()]
        if isinstance(fill, Tiles):
            fill = self._tiled(fill, leaf, drawn, clips)
        if stroke is not None:
            lines = stroke_lines(
                leaf.element, style, drawn, fill is not None, lambda: compose(self._tree.px_per_user, place.to_user)
            )
        elif fill is not None:
            lines = [closed(path) for path in drawn if not path.is_dot]
        else:
            return
        moved = self._moved([*drawn, *lines], place.to_user)
        self._shapes.append(
            Shape(
                tuple(moved[path] for path in drawn if path in moved),
                tuple(moved[path] for path in lines if path in moved),
                fill,
                _is_even_odd(leaf),
                stroke,
                clips,
                place.layer,
            )
        )

    def _moved(self, paths: Iterable[Subpath], to_user: FloatArray) -> dict[Subpath, Subpath]:
        """Each path in user units, those left out that end up nowhere."""
        moved = {}
        for path in dict.fromkeys(paths):
            there = path if to_user is IDENTITY else path.moved(to_user)
            if _is_usable(there):
                moved[path] = there
            else:
                self._tree.work.skipped["path with unusable numbers"] += 1
        return moved

    def _can_be_seen(self, place: Place) -> bool:
        """Whether transforms neither squeeze everything to a line nor carry it off."""
        scale = _scale(place.to_user)
        if not scale < LARGEST_COORDINATE:
            self._tree.work.skipped["path with unusable numbers"] += 1
            return False
        return scale > 0.0

    def _stroke(self, leaf: Leaf, whole: Sequence[Subpath]) -> Stroke | None:
        width = leaf.style.length("stroke-width", "diagonal") or 0.0
        if width <= 0.0:
            return None
        paint = paint_of(self._tree, "stroke", leaf.style, leaf.place, lambda: box_of_subpaths(whole))
        if paint is None:
            return None
        to_user = leaf.place.to_user
        if leaf.style["vector-effect"] == "non-scaling-stroke":
            width /= _scale(self._tree.px_per_user)
        else:
            width *= _scale(to_user)
        style = leaf.style
        return Stroke(
            _BLACK if isinstance(paint, Tiles) else paint,
            width,
            style["stroke-linecap"],
            style["stroke-linejoin"],
            style.number("stroke-miterlimit"),
        )

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
                place = marker_place(self._tree, markers[vertex.name], leaf, vertex)
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
        return self._tree.is_rendered(resource)

    def _tiled(
        self, tiles: Tiles, leaf: Leaf, outline: Sequence[Subpath], clips: tuple[BaseGeometry, ...]
    ) -> Paint | None:
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
        whole = region(list(self._moved(outline, place.to_user).values()), _is_even_odd(leaf))
        self._shapes.extend(tiled(content, tiles, moves, (whole, *clips)))
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
        if picture.pixels is None:
            self._tree.work.skipped[picture.kind] += 1
            return
        rows, columns = picture.pixels.darkness.shape
        frame = tuple(self._moved([rectangle(0.0, 0.0, columns, rows)], picture.pixels.to_user).values())
        if frame and self._can_be_seen(leaf.place):
            clips = self._clips.regions(picture.clips)
            self._shapes.append(Shape(frame, (), None, False, None, clips, leaf.place.layer, picture.pixels))

    def _text(self, leaf: Leaf) -> None:
        runs = glyphs_of(self._tree, leaf, is_area=self._is_mask)
        whole = [path for run in runs for path in run.subpaths]
        self._count(whole)
        for run in runs:
            part = replace(leaf, style=run.style)
            if run.is_single_line:
                self._single_lines(part, run.subpaths, whole)
            else:
                self._outline(part, run.subpaths, whole)

    def _single_lines(self, leaf: Leaf, lines: Sequence[Subpath], whole: Sequence[Subpath]) -> None:
        """Letters without an inside: a pen writes them wherever either of their paints can be seen."""
        stroke = self._stroke(leaf, whole)
        fill = paint_of(self._tree, "fill", leaf.style, leaf.place, lambda: box_of_subpaths(whole))
        paint = stroke.paint if fill is None and stroke is not None else fill
        if paint is None:
            return
        if not self._can_be_seen(leaf.place):
            return
        moved = tuple(self._moved(lines, leaf.place.to_user).values())
        pen = Stroke(paint if isinstance(paint, Paint) else _BLACK, 0.0)
        clips = self._clips.regions(leaf.place.clips)
        self._shapes.append(Shape((), moved, None, False, pen, clips, leaf.place.layer))

    def _count(self, paths: Sequence[Subpath]) -> None:
        self._tree.work.subpaths(len(paths), sum(len(path.beziers) for path in paths))


def _is_usable(path: Subpath) -> bool:
    return bool(max(path.beziers.max(), -path.beziers.min()) < LARGEST_COORDINATE)


def _is_even_odd(leaf: Leaf) -> bool:
    return leaf.element.tag != "text" and leaf.style["fill-rule"] == "evenodd"


def _scale(affine: FloatArray) -> float:
    """By how much lengths grow in the mean."""
    if affine is IDENTITY:
        return 1.0
    (a, c, _), (b, d, _) = affine.tolist()
    return math.sqrt(abs(a * d - b * c))
