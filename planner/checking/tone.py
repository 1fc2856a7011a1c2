"""Whether the ink on a picture is as dense as the picture is dark, patch by patch, in the check's own way.

The lines of a picture are held against the pen path like all others. That says nothing about whether they show it: here
pixels are counted, without lines: the share of each patch of paper that lies within half a pen's line of the pen path,
against the light that the pixels there take away.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from scipy.spatial import cKDTree
from shapely.geometry.base import BaseGeometry

from planner.affine import compose, inverse
from planner.arrays import FloatArray
from planner.checking.check_result import Finding
from planner.checking.polyline import DenseLines
from planner.drawing.drawing import Drawing
from planner.drawing.image_options import ImageStyle
from planner.drawing.scene.shape import Shape
from planner.head import ALL, NO_WORK, NOTHING_LEFT_OUT
from planner.trajectory import Trajectory

_LINES_ACROSS = 16
"""Of a patch: fewer lines are too few to carry a tone."""
_SAMPLES = 40
_MOST_PATCHES = 400
_TOLERANCE, _OF_ONE = 0.06, 0.06
"""Root of the mean squared error over very many patches, and how much more that of one may be."""
_DARKEST = 0.96
"""What dots and scribbles cover where it is black."""
_TONES = (ImageStyle.HATCH, ImageStyle.SCRIBBLE, ImageStyle.STIPPLE)


def tone_findings(
    trajectory: Trajectory, drawing: Drawing, pen: DenseLines, other_ink: Sequence[FloatArray]
) -> list[Finding]:
    """pen: the path of the pen on the paper, dense. other_ink: lines (n, 2) of what is no picture: patches that these
    cross are passed over, as are those that are not wholly seen. Nothing where there is none, where the style carries
    no tones, and where the header tells that something was left out or changed."""
    options = drawing.reading.image
    is_whole = trajectory.left_out == NOTHING_LEFT_OUT and trajectory.chosen == ALL and trajectory.path_work == NO_WORK
    if drawing.scene is None or options.style not in _TONES or not is_whole:
        return []
    shapes = drawing.scene.shapes
    side_mm = _LINES_ACROSS * options.least_mm
    lines = shapely.STRtree([shapely.LineString(line) for line in other_ink if len(line) > 1])
    ink = cKDTree(pen.points_mm)
    errors: list[FloatArray] = []
    for index, shape in enumerate(shapes):
        if shape.pixels is None:
            continue
        seen = _seen(shape, trajectory.svg_to_arm)
        if (tile := trajectory.placement.tile) is not None:
            near, far, right, left = tile.window_mm
            seen = shapely.intersection(seen, shapely.box(near, right, far, left))
        above = [_frame(later, trajectory.svg_to_arm) for later in shapes[index + 1 :] if later.outline]
        patches = _patches(seen.buffer(-options.line_mm), side_mm, above, lines)
        if not len(patches):
            continue
        step = (np.arange(_SAMPLES) + 0.5) / _SAMPLES * side_mm
        grid = np.stack(np.meshgrid(step, step), axis=-1).reshape(-1, 2)
        places = patches[:, None] + grid
        tone = options.ink * _tone(shape, trajectory.svg_to_arm, places.reshape(-1, 2)).reshape(places.shape[:2])
        distance, _ = ink.query(places.reshape(-1, 2), distance_upper_bound=options.line_mm)
        covered = np.asarray(distance <= options.line_mm / 2.0).reshape(places.shape[:2])
        wanted = tone.mean(axis=1) if options.style is ImageStyle.HATCH else np.minimum(tone.mean(axis=1), _DARKEST)
        errors.append(covered.mean(axis=1) - wanted)
    if not errors:
        return []
    every = np.concatenate(errors)
    off = float(np.sqrt(np.mean(every**2)))
    remark = (
        f"of ink off the tone, over {len(every)} patches of {side_mm:g} mm, {100.0 * every.mean():+.1f} % in the mean"
    )
    limit = _TOLERANCE + _OF_ONE / float(np.sqrt(len(every)))
    return [Finding("tone of pictures", off <= limit, 100.0 * off, 100.0 * limit, "%", remark=remark)]


def _frame(shape: Shape, affine: FloatArray) -> BaseGeometry:
    """A box around the outline of a shape, arm mm."""
    points = np.concatenate([path.beziers.reshape(-1, 2) for path in shape.outline]) @ affine[:, :2].T + affine[:, 2]
    frame: BaseGeometry = shapely.box(*points.min(axis=0), *points.max(axis=0))
    return frame


def _seen(shape: Shape, affine: FloatArray) -> BaseGeometry:
    """The part of a picture that its clips leave, arm mm."""
    corners = shape.outline[0].beziers[:, 0]
    whole = shapely.intersection_all([shapely.Polygon(corners), *shape.clips])
    moved: BaseGeometry = shapely.transform(whole, lambda points: points @ affine[:, :2].T + affine[:, 2])
    return moved


def _patches(seen: BaseGeometry, side_mm: float, above: Sequence[BaseGeometry], lines: shapely.STRtree) -> FloatArray:
    """(n, 2) the low corners of squares that are wholly seen, with no other ink on them."""
    if seen.is_empty:
        return np.empty((0, 2))
    left, low, right, high = seen.bounds
    x, y = (np.arange(begin, end - side_mm, side_mm) for begin, end in ((left, right), (low, high)))
    corners = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    if not len(corners):
        return np.empty((0, 2))
    squares = shapely.box(*corners.T, *(corners + side_mm).T)
    is_free = shapely.covers(seen, squares)
    is_free[lines.query(squares, predicate="intersects")[0]] = False
    if above:
        is_free[shapely.STRtree(above).query(squares, predicate="intersects")[0]] = False
    free: FloatArray = corners[is_free]
    return free[:: -(-len(free) // _MOST_PATCHES)] if len(free) else free


def _tone(shape: Shape, affine: FloatArray, places_mm: FloatArray) -> FloatArray:
    """(n,) the share of light that is missing at places, by the pixels that they are on."""
    assert shape.pixels is not None
    back = inverse(compose(affine, shape.pixels.to_user))
    column, row = np.floor(back[:, :2] @ places_mm.T + back[:, 2:]).astype(np.int64)
    darkness = shape.pixels.darkness
    rows, columns = darkness.shape
    value = 1.0 - shape.pixels.opacity * darkness[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)]
    light: FloatArray = np.where(value > 0.04045, ((value + 0.055) / 1.055) ** 2.4, value / 12.92)
    return 1.0 - light
