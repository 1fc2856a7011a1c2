"""The areas that are filled, as the eye sees them: less what clips, the page and later paint hide."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import shapely
from shapely.affinity import affine_transform
from shapely.geometry.base import BaseGeometry

from planner.affine import inverse, scale_of
from planner.arrays import FloatArray
from planner.drawing.cut.region import region
from planner.drawing.options import ReadingOptions
from planner.drawing.page import n_backgrounds
from planner.drawing.scene.shape import Scene

_LEAST_MM2 = 1e-3
_FLATTENING = 1e-6
"""Of the extent of the page."""


@dataclass(frozen=True, eq=False, slots=True)
class Area:
    """shape: a polygon or several, arm mm. layer, colour: of what is painted there."""

    shape: BaseGeometry
    layer: str
    colour: tuple[int, int, int]


def areas(scene: Scene, reading: ReadingOptions, svg_to_arm: FloatArray) -> Iterator[Area]:
    """In the order of painting. svg_to_arm: (2, 3)."""
    shapes = scene.shapes[n_backgrounds(scene) :]
    tolerance = _FLATTENING * max(scene.page_mm) / scale_of(scene.user_to_page)
    filled: list[tuple[BaseGeometry, int]] = []
    for index, shape in enumerate(shapes):
        if shape.fill is None:
            continue
        outline = region(shape.outline, shape.is_even_odd, tolerance)
        filled.append((shapely.intersection_all([outline, *shape.clips]) if shape.clips else outline, index))
    if not filled:
        return
    tree = shapely.STRtree([one for one, _ in filled])
    page = _moved(shapely.box(0.0, 0.0, *scene.page_mm), inverse(scene.user_to_page))
    for number, (seen, index) in enumerate(filled):
        above = [
            later
            for later in tree.query(seen, predicate="intersects").tolist()
            if later > number and (paint := shapes[filled[later][1]].fill) is not None and paint.is_opaque
        ]
        if above:
            seen = seen.difference(shapely.union_all([filled[later][0] for later in above]))
        if reading.crop == "page":
            seen = seen.intersection(page)
        placed = _moved(seen, svg_to_arm)
        paint = shapes[index].fill
        if placed.area > _LEAST_MM2 and paint is not None:
            yield Area(placed, shapes[index].layer, paint.colour)


def _moved(shape: BaseGeometry, affine: FloatArray) -> BaseGeometry:
    return affine_transform(shape, [*affine[:, :2].ravel(), *affine[:, 2]])
