"""The page: what lies beyond it, and paint that is nothing but paper."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.affine import inverse
from planner.arrays import FloatArray
from planner.drawing.cut.area import signed_areas
from planner.drawing.scene.shape import Scene, Shape
from planner.drawing.subpath import Subpath

_AS_LARGE = 1e-3
_ON_PAGE = 1e-6
"""Against the extent of the page: what is off it by less is on it."""


def n_backgrounds(scene: Scene) -> int:
    """How many shapes, painted before all others, are rectangles without a stroke that cover the page: paper, not
    lines. None where there is nothing else."""
    count = 0
    while count < len(scene.shapes) and _covers_the_page(scene.shapes[count], scene):
        count += 1
    return count if any(shape.shows for shape in scene.shapes[count:]) else 0


def _covers_the_page(shape: Shape, scene: Scene) -> bool:
    if shape.fill is None or shape.stroke is not None or len(shape.outline) != 1:
        return False
    outline = shape.outline[0].moved(scene.user_to_page)
    low, high = outline.beziers.min(axis=(0, 1)), outline.beziers.max(axis=(0, 1))
    slack = _AS_LARGE * max(scene.page_mm)
    is_large = bool(np.all(low <= slack) and np.all(high >= np.array(scene.page_mm) - slack))
    # What fills its box is a rectangle.
    return (
        is_large
        and abs(float(signed_areas([outline])[0])) >= (1.0 - 1e-6) * float(np.prod(high - low))
        and _shows_all(shape, scene)
    )


def _shows_all(shape: Shape, scene: Scene) -> bool:
    """Whether the shape's clips leave all of the page to be seen."""
    if not shape.clips:
        return True
    import shapely

    page = shapely.Polygon(_page_corners(scene, -_AS_LARGE))
    return all(shapely.covers(clip, page) for clip in shape.clips)


def cut_to_the_page(lines: Sequence[Sequence[Subpath]], scene: Scene) -> tuple[list[list[Subpath]], int]:
    """The parts of lines of each thing that are on the page, and how many things lost any."""
    paths = [path for of_one in lines for path in of_one]
    if not paths:
        return [list(of_one) for of_one in lines], 0
    first = np.cumsum([0, *(len(path.beziers) for path in paths[:-1])])
    page = np.concatenate([path.beziers for path in paths]) @ scene.user_to_page[:, :2].T + scene.user_to_page[:, 2]
    low = np.minimum.reduceat(page.min(axis=1), first)
    high = np.maximum.reduceat(page.max(axis=1), first)
    slack = _ON_PAGE * max(scene.page_mm)
    beyond = np.flatnonzero(np.any((low < -slack) | (high > np.array(scene.page_mm) + slack), axis=1)).tolist()
    if not beyond:
        return [list(of_one) for of_one in lines], 0
    import shapely

    from planner.drawing.cut.cut import Cutter

    parts: dict[int, list[Subpath]] = dict(
        zip(
            beyond,
            Cutter(shapely.Polygon(_page_corners(scene))).inside([paths[index] for index in beyond]),
            strict=True,
        )
    )
    index = iter(range(len(paths)))
    left = [[part for path in of_one for part in parts.get(next(index), [path])] for of_one in lines]
    return left, sum(after != list(before) for before, after in zip(lines, left, strict=True))


def _page_corners(scene: Scene, margin: float = 0.0) -> FloatArray:
    """(4, 2) in user units; margin: how much further out, against the extent of the page."""
    (width, height), out = scene.page_mm, margin * max(scene.page_mm)
    corners = np.array([(-out, -out), (width + out, -out), (width + out, height + out), (-out, height + out)])
    back = inverse(scene.user_to_page)
    user: FloatArray = corners @ back[:, :2].T + back[:, 2]
    return user
