"""Lines along the edge of an area, one inside the other, each by itself or one leading to the next."""

from __future__ import annotations

from itertools import chain
from typing import NamedTuple

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import BoolArray, FloatArray
from planner.errors import PlanError

MOST_RINGS = 100_000
_QUARTER = 16
"""Chords of a rounded corner."""
_SMOOTH = 0.02
"""Of the spacing: what points of a ring may be dropped for."""
_DEPTHS = (0.4, 0.25, 0.1)
"""Of the spacing: how far from the edges of what is left free a line may go along its middle."""
_GRID = 1e-4
"""Of the spacing: what is left free is known to this; on a grid no edges are too near each other to be told apart."""
_LEAST_FREE = 4.0
"""Squares of the spacing: what is left free and smaller is not worth a lift of the pen."""
_LED_WITHIN = 1.5
"""Spacings from a line to the ring around it: one, but for what is dropped of rings and for the ends of middles."""


class Level(NamedTuple):
    """rings: (n, 2) each, closed, all as far from the edge. middles: (n, 2) each, lines along what these and the rings
    of the next level leave free, where the area is too narrow for another ring."""

    rings: list[FloatArray]
    middles: list[FloatArray]

    @property
    def lines(self) -> list[FloatArray]:
        return self.rings + self.middles


def contours(area: BaseGeometry, spacing_mm: float) -> list[Level]:
    """Level by level inwards; the first rings are the edge itself. Errors: PlanError for too many."""
    levels: list[Level] = []
    inner, count = area, 0
    while not inner.is_empty:
        following = inner.buffer(-spacing_mm, quad_segs=_QUARTER).simplify(_SMOOTH * spacing_mm)
        rings = [
            np.asarray(ring.coords)[:, :2]
            for polygon in _polygons(inner)
            for ring in (polygon.exterior, *polygon.interiors)
        ]
        count += len(rings)
        if count > MOST_RINGS:
            raise PlanError(f"a fill would take more than {MOST_RINGS} rings: choose a wider --fill-spacing")
        levels.append(Level(rings, _middles(inner, following, spacing_mm)))
        inner = following
    return levels


def spirals(levels: list[Level], spacing_mm: float) -> list[FloatArray]:
    """The same as few lines: from the innermost on, each leads out to the ring around it."""
    trees = [shapely.STRtree([shapely.LineString(ring) for ring in level.rings]) for level in levels]
    is_used = [np.zeros(len(level.rings), dtype=np.bool_) for level in levels]
    lines = []
    for depth in range(len(levels) - 1, -1, -1):
        lines += [_led_out(middle, depth, levels, trees, is_used, spacing_mm) for middle in levels[depth].middles]
        for index, ring in enumerate(levels[depth].rings):
            if is_used[depth][index]:
                continue
            is_used[depth][index] = True
            if depth:  # it may be left anywhere: where the way out is free
                nearest = trees[depth - 1].nearest(shapely.points(ring))
                ring = _from(ring, shapely.Point(ring[np.argmin(is_used[depth - 1][nearest])]))
            lines.append(_led_out(ring, depth - 1, levels, trees, is_used, spacing_mm))
    return lines


def _led_out(
    innermost: FloatArray,
    depth: int,
    levels: list[Level],
    trees: list[shapely.STRtree],
    is_used: list[BoolArray],
    spacing_mm: float,
) -> FloatArray:
    """From `innermost` out through the rings of `depth` and of those before it that nobody has drawn yet. The way to
    the nearest ring is inside: nothing of the edge is nearer."""
    line = [innermost]
    for level in range(depth, -1, -1):
        end = shapely.Point(line[-1][-1])
        index, distance_mm = trees[level].query_nearest(end, all_matches=False, return_distance=True)
        if not len(index) or distance_mm[0] > _LED_WITHIN * spacing_mm or is_used[level][index[0]]:
            break
        is_used[level][index[0]] = True
        line.append(_from(levels[level].rings[index[0]], end))
    return np.concatenate(line[::-1])


def _from(ring: FloatArray, place: shapely.Point) -> FloatArray:
    """The ring, begun and ended where it is nearest to a place."""
    line = shapely.LineString(ring)
    at = float(line.project(place))
    begins_at = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(ring, axis=0).T))))
    after = int(np.searchsorted(begins_at, at, side="right"))
    begin = np.asarray(line.interpolate(at).coords)[:, :2]
    return np.concatenate((begin, ring[after:-1], ring[: min(after, len(ring) - 1)], begin))


def _middles(area: BaseGeometry, following: BaseGeometry, spacing_mm: float) -> list[FloatArray]:
    """Lines along what the edge of `area` and that of `following`, a level inside it, leave free."""
    grid_mm = _GRID * spacing_mm
    free = shapely.difference(area.buffer(-spacing_mm / 2), following.buffer(spacing_mm / 2), grid_size=grid_mm)
    lines = []
    waiting = _polygons(free)
    while waiting:
        part = waiting.pop()
        line = _middle(part, spacing_mm) if part.area > _LEAST_FREE * spacing_mm**2 else None
        if line is not None:
            lines.append(line)
            drawn = shapely.LineString(line).buffer(spacing_mm / 2)
            waiting += _polygons(shapely.difference(part, drawn, grid_size=grid_mm))
    return lines


def _middle(part: shapely.Polygon, spacing_mm: float) -> FloatArray | None:
    """A line along a narrow part, as far from its edge as its widest place allows; round a part that goes round
    something. None where it is too narrow to be seen."""
    cores = chain.from_iterable(_polygons(part.buffer(-depth * spacing_mm)) for depth in _DEPTHS)
    core = next(cores, None)
    if core is None:
        return None
    ring: FloatArray = np.asarray(core.exterior.simplify(_SMOOTH * spacing_mm).coords)[:, :2]
    if core.interiors:
        return ring
    corners = ring[:-1]
    for _ in range(2):  # to one of its ends, and seen from there to the other
        last = int(np.argmax(np.hypot(*(corners - corners[0]).T)))
        side = corners[: last + 1]
        corners = np.roll(corners, -last, axis=0)
    return side if last else None


def _polygons(area: BaseGeometry) -> list[shapely.Polygon]:
    return [part for part in shapely.get_parts(area) if part.geom_type == "Polygon" and not part.is_empty]
