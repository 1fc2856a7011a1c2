"""Boxes around outlines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.drawing import Outline
from planner.drawing.flatten import extent
from planner.drawing.scene.place import Window
from planner.drawing.subpath import Subpath
from planner.drawing.transforms import IDENTITY, Box

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


def box_of_subpaths(subpaths: Sequence[Subpath]) -> Box | None:
    """What the curves truly reach; None where there are none."""
    drawn = [Outline(subpath.beziers) for subpath in subpaths if subpath.is_vertex.any()]
    if not drawn:
        return None
    low, high = extent(drawn, IDENTITY)
    return float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1])


def moved_box(box: Box, affine: FloatArray) -> Box:
    """The box around the four corners under an affine (2, 3)."""
    corners = corners_of(box, affine)
    (x, y), (right, bottom) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return x, y, right - x, bottom - y


def corners_of(box: Box, affine: FloatArray) -> FloatArray:
    """(4, 2), one after the other around the box, under an affine (2, 3)."""
    x, y, width, height = box
    corners = np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]])
    moved: FloatArray = corners @ affine[:, :2].T + affine[:, 2]
    return moved


def window_region(window: Window) -> BaseGeometry:
    """What a viewport leaves to be seen, in user units."""
    import shapely

    return shapely.Polygon(corners_of(window.box, window.to_user))


def union(boxes: Iterable[Box | None]) -> Box | None:
    """The box around all that there are."""
    found = np.array([box for box in boxes if box is not None])
    if not len(found):
        return None
    x, y = found[:, :2].min(axis=0).tolist()
    right, bottom = (found[:, :2] + found[:, 2:]).max(axis=0).tolist()
    return x, y, right - x, bottom - y
