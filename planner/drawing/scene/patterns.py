"""How the tiles of a `pattern` lie, and what they show."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from planner.affine import compose, inverse
from planner.arrays import FloatArray
from planner.drawing.scene.boxes import moved_box, window_region
from planner.drawing.scene.place import Place, Window
from planner.drawing.scene.references import chain, inherited_attribute
from planner.drawing.scene.shape import Shape
from planner.drawing.scene.viewport import fitted, parse_view_box
from planner.drawing.scene.walk import Tree, attribute_length
from planner.drawing.style.style import Style
from planner.drawing.style.units import Axis
from planner.drawing.transforms import IDENTITY, Box, local_transform, scaling, translation
from planner.drawing.xml_tree import Element

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

_FARTHEST_TILE = 2.0**53
"""From here on there are no whole numbers between which a tile could lie."""
TILE_LIMIT = 10_000
"""Tiles of one pattern on one shape: more of them are a grey to the eye."""


@dataclass(frozen=True, eq=False, slots=True)
class Tiles:
    """content: the element whose children a tile shows. tile: its box in the units of the pattern; to_user: from these
    (2, 3). to_tile: (2, 3), from the units of the content to those of the pattern, in the tile that stands at the
    box. viewport: what percentages in the content are of."""

    content: Element
    tile: Box
    to_user: FloatArray
    to_tile: FloatArray
    viewport: tuple[float, float]

    def over(self, box: Box) -> list[FloatArray] | None:
        """The moves (2, 3), in user units, that bring the tile to where it covers a box in user units; None where they
        are too many."""
        x, y, width, height = moved_box(box, inverse(self.to_user))
        left, top, step_x, step_y = self.tile
        ends = ((x - left) / step_x, (x + width - left) / step_x, (y - top) / step_y, (y + height - top) / step_y)
        if not max(map(abs, ends)) < _FARTHEST_TILE:
            return None
        columns, rows = (range(math.floor(begin), math.ceil(end)) for begin, end in (ends[:2], ends[2:]))
        if len(columns) * len(rows) > TILE_LIMIT:
            return None
        linear = self.to_user[:, :2]
        return [translation(*(linear @ (column * step_x, row * step_y)).tolist()) for row in rows for column in columns]


def tiles_of(tree: Tree, pattern: Element, style: Style, place: Place, box: Box) -> Tiles | None:
    """Those of an element with a style, a place, and a box around it. None for a pattern that shows nothing: without
    children, or with tiles of no size."""
    patterns = chain(tree.document, pattern, "pattern")
    content = next((pattern for pattern in patterns if pattern.children), None)
    if content is None:
        return None

    def attribute(name: str) -> str | None:
        return inherited_attribute(patterns, name)

    x, y, box_width, box_height = box
    is_of_box = attribute("patternUnits") != "userSpaceOnUse"
    if is_of_box and min(box_width, box_height) <= 0.0:
        return None
    axes: tuple[tuple[str, Axis, float], ...] = (
        ("x", "x", box_width),
        ("y", "y", box_height),
        ("width", "x", box_width),
        ("height", "y", box_height),
    )
    left, top, width, height = (
        attribute_length(style, attribute(name), axis, whole if is_of_box else None) for name, axis, whole in axes
    )
    if is_of_box:
        left, top = left + x, top + y
    transform = _transform(tree, patterns, place, box)
    to_user = compose(place.to_user, transform)
    if width <= 0.0 or height <= 0.0 or not np.isfinite(to_user).all() or np.linalg.det(to_user[:, :2]) == 0.0:
        return None
    view_box = parse_view_box(attribute("viewBox"))
    to_tile = translation(left, top)
    viewport = place.viewport
    if view_box is not None:
        if min(view_box[2:]) == 0.0:
            return None
        to_tile = compose(to_tile, fitted(view_box, (width, height), attribute("preserveAspectRatio")))
        viewport = view_box[2:]
    elif attribute("patternContentUnits") == "objectBoundingBox":
        to_tile = compose(to_tile, scaling(box_width, box_height))
    return Tiles(content, (left, top, width, height), to_user, to_tile, viewport)


def _transform(tree: Tree, patterns: list[Element], place: Place, box: Box) -> FloatArray:
    """`patternTransform`, or what CSS says in its place."""
    for pattern in patterns:
        style = tree.style_of(pattern)
        if "patternTransform" in pattern.attributes or style["transform"] != "none":
            return local_transform(style, place.viewport, lambda: box)
    return IDENTITY


def tiled(
    content: Sequence[Shape], tiles: Tiles, moves: Sequence[FloatArray], clips: tuple[BaseGeometry, ...]
) -> Iterator[Shape]:
    """What one tile shows, at every place of the tile, within all of some regions."""
    frame = window_region(Window(tiles.tile, tiles.to_user))
    back = inverse(tiles.to_user)
    own = [shape.clips if _is_within(shape, back, tiles.tile) else (*shape.clips, frame) for shape in content]
    for move in moves:
        for shape, regions in zip(content, own, strict=True):
            yield replace(
                shape,
                outline=tuple(path.moved(move) for path in shape.outline),
                lines=tuple(path.moved(move) for path in shape.lines),
                clips=(*clips, *(_moved(region, move) for region in regions)),
                pixels=shape.pixels and replace(shape.pixels, to_user=compose(move, shape.pixels.to_user)),
            )


def _is_within(shape: Shape, to_pattern: FloatArray, tile: Box) -> bool:
    """Whether all that a shape draws lies in the tile."""
    x, y, width, height = tile
    slack = 1e-9 * max(width, height)
    for path in (*shape.lines, *(shape.outline if shape.pixels else ())):
        points = path.beziers @ to_pattern[:, :2].T + to_pattern[:, 2]
        low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
        if np.any(low < np.array((x, y)) - slack) or np.any(high > np.array((x + width, y + height)) + slack):
            return False
    return True


def _moved(region: BaseGeometry, move: FloatArray) -> BaseGeometry:
    import shapely

    return shapely.transform(region, lambda points: points + move[:, 2])
