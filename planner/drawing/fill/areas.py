"""The areas that are filled, as the eye sees them: less what clips, the page and later paint hide."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.affinity import affine_transform
from shapely.geometry.base import BaseGeometry

from planner.affine import inverse, scale_of
from planner.arrays import FloatArray
from planner.drawing.cut.area import go_round
from planner.drawing.cut.region import region
from planner.drawing.options import ReadingOptions
from planner.drawing.page import n_backgrounds
from planner.drawing.scene.shape import Scene

_LEAST_MM2 = 1e-3
_LIGHTEST = 0.97
"""Of lightness: what is lighter is as good as paper."""
_FLATTENING = 1e-6
"""Of the extent of the page."""


@dataclass(frozen=True, eq=False, slots=True)
class Area:
    """shape: a polygon or several, arm mm. layer, colour: of what is painted there."""

    shape: BaseGeometry
    layer: str
    colour: tuple[int, int, int]


def lightness(colour: tuple[int, int, int]) -> float:
    """The share of light that a paper of this colour sends back (relative luminance, IEC 61966-2-1)."""
    linear = [
        value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in np.divide(colour, 255)
    ]
    return float(np.dot(linear, (0.2126, 0.7152, 0.0722)))


def n_areas(scene: Scene) -> int:
    """How many shapes fill an area, other than with the colour of paper; what only figures of eight fill is passed
    over, as it takes long to be sure of."""
    shapes = [
        shape
        for shape in scene.shapes[n_backgrounds(scene) :]
        if shape.fill is not None and lightness(shape.fill.colour) < _LIGHTEST
    ]
    paths = [path for shape in shapes for path in shape.outline]
    owner = np.repeat(np.arange(len(shapes)), [len(shape.outline) for shape in shapes])
    return len(set(owner[go_round(paths)].tolist()))


def areas(scene: Scene, reading: ReadingOptions, svg_to_arm: FloatArray) -> Iterator[Area]:
    """In the order of painting; what has the colour of paper only hides others. svg_to_arm: (2, 3)."""
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
        paint = shapes[index].fill
        if paint is None or lightness(paint.colour) >= _LIGHTEST:
            continue
        above = [
            later
            for later in tree.query(seen, predicate="intersects").tolist()
            if later > number and (cover := shapes[filled[later][1]].fill) is not None and cover.is_opaque
        ]
        if above:
            seen = seen.difference(shapely.union_all([filled[later][0] for later in above]))
        if reading.crop == "page":
            seen = seen.intersection(page)
        placed = _moved(seen, svg_to_arm)
        if placed.area > _LEAST_MM2:
            yield Area(placed, shapes[index].layer, paint.colour)


def _moved(shape: BaseGeometry, affine: FloatArray) -> BaseGeometry:
    return affine_transform(shape, [*affine[:, :2].ravel(), *affine[:, 2]])
