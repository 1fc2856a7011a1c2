"""Clip paths and masks as regions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from planner.affine import compose
from planner.arrays import FloatArray
from planner.drawing.cut.region import region
from planner.drawing.drawing import Outline
from planner.drawing.flatten import flatten_all
from planner.drawing.scene.basic_shapes import basic_shape
from planner.drawing.scene.boxes import window_region
from planner.drawing.scene.place import NESTING_LIMIT, Clipped, Leaf, Place, Window, resource_place
from planner.drawing.scene.references import by_href, by_url
from planner.drawing.scene.shape import Paint, Shape
from planner.drawing.scene.walk import Tree, attribute_length, box_of, leaves
from planner.drawing.shapes import SHAPES
from planner.drawing.style.colour import parse_url
from planner.drawing.style.style import Style
from planner.drawing.style.units import Axis
from planner.drawing.subpath import Subpath
from planner.drawing.transforms import IDENTITY, Box, local_transform, scaling, translation
from planner.drawing.xml_tree import Element

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

_BLACK = (0, 0, 0)
_STROKE_ERROR = 1e-5
"""Chord error of strokes in masks, against the extent of their lines."""
_CAPS: dict[str, Literal["flat", "round", "square"]] = {"butt": "flat", "round": "round", "square": "square"}
_JOINS: dict[str, Literal["mitre", "round", "bevel"]] = {"miter": "mitre", "round": "round", "bevel": "bevel"}
Shapes = Callable[[Iterable[Leaf]], list[Shape]]
Outlines = Callable[[Leaf], Sequence[Subpath]]


class Clips:
    """The regions of everything that clips. shapes: paints leaves, for masks; outlines: of a shape or a text, for clip
    paths."""

    def __init__(self, tree: Tree, shapes: Shapes, outlines: Outlines) -> None:
        self._tree, self._shapes, self._outlines = tree, shapes, outlines
        self._known: dict[Window | Clipped, tuple[BaseGeometry, ...]] = {}
        self._by_reference: dict[object, BaseGeometry | None] = {}

    def regions(self, clips: Sequence[Window | Clipped]) -> tuple[BaseGeometry, ...]:
        """The regions, in user units, that all of them leave."""
        found: list[BaseGeometry] = []
        for clip in clips:
            if clip not in self._known:
                self._known[clip] = (window_region(clip),) if isinstance(clip, Window) else self._checked(clip)
            found.extend(self._known[clip])
        return tuple(found)

    def _checked(self, clipped: Clipped) -> tuple[BaseGeometry, ...]:
        """Coordinates beyond all measure can be too much for geometry: what they clip is drawn whole, and counted."""
        from shapely.errors import ShapelyError

        try:
            return tuple(self._of_element(clipped))
        except ShapelyError:
            self._tree.work.skipped["clip path that cannot be worked out"] += 1
            return ()

    def _of_element(self, clipped: Clipped) -> Iterable[BaseGeometry]:
        style = clipped.style
        box = _Lazy(lambda: box_of(self._tree, clipped.element, style, clipped.place))
        for found in (
            self._of_clip_path(style["clip-path"], style, clipped.place, box),
            self._of_mask(style["mask"], clipped.place, box),
        ):
            if found is not None:
                yield found

    def _of_clip_path(self, text: str, style: Style, place: Place, box: _Lazy) -> BaseGeometry | None:
        """None where nothing is clipped: for `none`, and for a reference that leads nowhere or to itself."""
        if text == "none":
            return None
        url = parse_url(text)
        if url is None:
            shape = basic_shape(text, style, place.viewport, box)
            return region([path.moved(place.to_user) for path in shape.subpaths], shape.is_even_odd) if shape else None
        clip_path = self._resource(url, "clipPath", place)
        if clip_path is None:
            return None
        is_of_box = clip_path.attributes.get("clipPathUnits") == "objectBoundingBox"
        key = (clip_path, place.to_user.tobytes(), box() if is_of_box else place.viewport)
        if key not in self._by_reference:
            self._by_reference[key] = self._clip_path_region(clip_path, place, box, is_of_box)
        return self._by_reference[key]

    def _clip_path_region(self, clip_path: Element, place: Place, box: _Lazy, is_of_box: bool) -> BaseGeometry:
        import shapely

        style = self._tree.style_of(clip_path)
        to_user = compose(place.to_user, local_transform(style, place.viewport, box))
        viewport = place.viewport
        if is_of_box:
            to_user, viewport = compose(to_user, _of_box(box())), (1.0, 1.0)
        inner = resource_place(clip_path, style, place, to_user, viewport)
        parts = []
        for child in clip_path.children:
            target = by_href(self._tree.document, child) if child.tag == "use" else child
            if target is None or target.tag not in SHAPES | {"text"}:
                continue
            for leaf in leaves(self._tree, [child], inner):
                if leaf.style["visibility"] == "visible":
                    outlines = [path.moved(leaf.place.to_user) for path in self._outlines(leaf)]
                    area = region(finite(outlines), leaf.style["clip-rule"] == "evenodd")
                    parts.append(shapely.intersection_all([area, *self.regions(leaf.place.clips)]))
        whole = shapely.union_all(parts) if parts else shapely.Polygon()
        own = self._of_clip_path(style["clip-path"], style, replace(place, inside=inner.inside), box)
        return whole if own is None else shapely.intersection(whole, own)

    def _of_mask(self, text: str, place: Place, box: _Lazy) -> BaseGeometry | None:
        if text == "none":
            return None
        url = parse_url(text.split(")")[0] + ")")
        mask = self._resource(url, "mask", place) if url is not None else None
        if url is None:
            self._tree.work.skipped["mask layers"] += 1
        return None if mask is None else self._mask_region(mask, place, box)

    def _mask_region(self, mask: Element, place: Place, box: _Lazy) -> BaseGeometry:
        import shapely

        style = self._tree.style_of(mask)
        is_of_box = mask.attributes.get("maskUnits") != "userSpaceOnUse"
        x, y, width, height = box()
        if is_of_box and min(width, height) <= 0.0:
            return shapely.Polygon()
        axes: tuple[tuple[str, Axis, float], ...] = (
            ("x", "x", width),
            ("y", "y", height),
            ("width", "x", width),
            ("height", "y", height),
        )
        left, top, across, down = (
            attribute_length(
                style, mask.attributes.get(name, "-10%" if name in "xy" else "120%"), axis, whole if is_of_box else None
            )
            for name, axis, whole in axes
        )
        if is_of_box:
            left, top = left + x, top + y
        if across <= 0.0 or down <= 0.0:
            return shapely.Polygon()
        to_user, viewport = place.to_user, place.viewport
        if mask.attributes.get("maskContentUnits") == "objectBoundingBox":
            to_user, viewport = compose(to_user, _of_box(box())), (1.0, 1.0)
        inner = resource_place(mask, style, place, to_user, viewport)
        shapes = self._shapes(leaves(self._tree, mask.children, inner))
        area, has_greys = _seen_through(shapes, is_luminance=style["mask-type"] != "alpha")
        if has_greys:
            self._tree.work.skipped["mask with greys"] += 1
        frame = window_region(Window((left, top, across, down), place.to_user))
        return shapely.intersection(area, frame)

    def _resource(self, url: str, tag: str, place: Place) -> Element | None:
        """The element that clips, unless something clips itself by it."""
        if not url.startswith("#"):
            self._tree.work.skipped["external reference"] += 1
        found = by_url(self._tree.document, url, tag)
        if found is None or not self._tree.is_rendered(found):
            return None
        if place.inside is not None and place.inside.holds(found):
            self._tree.work.skipped["reference to itself"] += 1
            return None
        if place.nesting >= NESTING_LIMIT:
            self._tree.work.skipped["references nested too deeply"] += 1
            return None
        return found


class _Lazy:
    """A box that is worked out when it is asked for first."""

    def __init__(self, make: Callable[[], Box]) -> None:
        self._make = make
        self._made: Box | None = None

    def __call__(self) -> Box:
        if self._made is None:
            self._made = self._make()
        return self._made


def finite(subpaths: Iterable[Subpath]) -> list[Subpath]:
    return [path for path in subpaths if np.all(np.abs(path.beziers) < 1e9)]


def _of_box(box: Box) -> FloatArray:
    return compose(translation(*box[:2]), scaling(*box[2:]))


def _seen_through(shapes: Sequence[Shape], is_luminance: bool) -> tuple[BaseGeometry, bool]:
    """Where a mask lets anything through, and whether anywhere it does so in part only."""
    import shapely

    area: BaseGeometry = shapely.Polygon()
    has_greys = False
    for shape in shapes:
        for paint, painted in _painted(shape):
            painted = shapely.intersection_all([painted, *shape.clips])
            if is_luminance and paint.colour == _BLACK:
                if paint.is_opaque:
                    area = shapely.difference(area, painted)
                elif shapely.intersects(area, painted):
                    has_greys = True
                continue
            area = shapely.union(area, painted)
            has_greys = has_greys or not paint.is_opaque or (is_luminance and paint.colour != (255, 255, 255))
    return area, has_greys


def _painted(shape: Shape) -> Iterable[tuple[Paint, BaseGeometry]]:
    import shapely

    if shape.fill is not None:
        yield shape.fill, region(shape.outline, shape.is_even_odd)
    if shape.stroke is not None and shape.lines:
        extent = max(float(np.ptp(path.beziers.reshape(-1, 2), axis=0).max()) for path in shape.lines)
        outlines = [Outline(path.beziers) for path in shape.lines]
        polylines = flatten_all(outlines, IDENTITY, _STROKE_ERROR * (extent + shape.stroke.width))
        yield (
            shape.stroke.paint,
            shapely.union_all(
                [
                    shapely.buffer(
                        _line(polyline, path.is_closed),
                        shape.stroke.width / 2.0,
                        cap_style=_CAPS.get(shape.stroke.cap, "flat"),
                        join_style=_JOINS.get(shape.stroke.join, "mitre"),
                        mitre_limit=max(shape.stroke.miter_limit, 1.0),
                    )
                    for polyline, path in zip(polylines, shape.lines, strict=True)
                ]
            ),
        )


def _line(points: FloatArray, is_closed: bool) -> BaseGeometry:
    import shapely

    if is_closed and len(points) > 3:
        return shapely.LinearRing(points)
    return shapely.LineString(points) if len(points) > 1 else shapely.Point(points[0])
