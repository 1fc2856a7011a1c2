"""The pictures that are seen, and which part of each: less what clips, the page and later paint hide."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.affine import compose, inverse, scale_of
from planner.arrays import FloatArray
from planner.drawing.cut.region import region
from planner.drawing.options import ReadingOptions
from planner.drawing.raster import Darkness
from planner.drawing.scene.shape import Scene, Shape

_FLATTENING = 1e-6
"""Of the extent of the page."""


@dataclass(frozen=True, eq=False, slots=True)
class SeenPicture:
    """darkness: (rows, columns), of its opacity. to_mm: (2, 3) from columns and rows, counted from the outer corner of
    the first pixel. shape: the part that is seen, in the same mm. layer: its name."""

    darkness: Darkness
    to_mm: FloatArray
    shape: BaseGeometry
    layer: str

    @property
    def pixel_mm(self) -> float:
        """The side of a pixel, in the mean of all directions."""
        return scale_of(self.to_mm)


def seen_pictures(scene: Scene, reading: ReadingOptions, user_to_mm: FloatArray) -> Iterator[SeenPicture]:
    """In the order of painting, where `user_to_mm` (2, 3) puts them."""
    shapes = scene.shapes
    tolerance = _FLATTENING * max(scene.page_mm) / scale_of(scene.user_to_page)
    for index, shape in enumerate(shapes):
        if shape.pixels is None:
            continue
        seen = shapely.intersection_all([region(shape.outline, False, tolerance), *shape.clips])
        above = [_cover(later, tolerance) for later in shapes[index + 1 :] if _may_hide(later, seen)]
        if above:
            seen = seen.difference(shapely.union_all(above))
        if reading.crop == "page":
            page = shapely.box(0.0, 0.0, *scene.page_mm)
            seen = seen.intersection(_moved(page, inverse(scene.user_to_page)))
        placed = _moved(seen, user_to_mm)
        if placed.area > 0.0:
            pixels = shape.pixels
            darkness = pixels.darkness if pixels.opacity >= 1.0 else pixels.darkness * np.float32(pixels.opacity)
            yield SeenPicture(darkness, compose(user_to_mm, pixels.to_user), placed, shape.layer)


def _may_hide(shape: Shape, seen: BaseGeometry) -> bool:
    if shape.fill is None or not shape.fill.is_opaque or not shape.outline:
        return False
    low = np.min([path.beziers.min(axis=(0, 1)) for path in shape.outline], axis=0)
    high = np.max([path.beziers.max(axis=(0, 1)) for path in shape.outline], axis=0)
    return bool(shapely.box(*low, *high).intersects(seen))


def _cover(shape: Shape, tolerance: float) -> BaseGeometry:
    return shapely.intersection_all([region(shape.outline, shape.is_even_odd, tolerance), *shape.clips])


def _moved(shape: BaseGeometry, affine: FloatArray) -> BaseGeometry:
    moved: BaseGeometry = shapely.transform(shape, lambda points: points @ affine[:, :2].T + affine[:, 2])
    return moved
