"""Lines along the edge of an area, one inside the other, each by itself or one leading to the next."""

from __future__ import annotations

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray
from planner.errors import PlanError

MOST_RINGS = 100_000
_QUARTER = 16
"""Chords of a rounded corner."""
_GRAZE_MM = 1e-6
_SMOOTH = 0.02
"""Of the spacing: what points of a ring may be dropped for."""


def contours(area: BaseGeometry, spacing_mm: float) -> list[list[FloatArray]]:
    """Rings (n, 2) closed, level by level inwards; the first are the edge itself. Errors: PlanError for too many."""
    levels: list[list[FloatArray]] = []
    inner, count = area, 0
    while not inner.is_empty:
        rings = [
            np.asarray(ring.coords)[:, :2]
            for polygon in shapely.get_parts(inner)
            if polygon.geom_type == "Polygon"
            for ring in (polygon.exterior, *polygon.interiors)
        ]
        count += len(rings)
        if count > MOST_RINGS:
            raise PlanError(f"a fill would take more than {MOST_RINGS} rings: choose a wider --fill-spacing")
        levels.append(rings)
        inner = inner.buffer(-spacing_mm, quad_segs=_QUARTER).simplify(_SMOOTH * spacing_mm)
    return levels


def spirals(levels: list[list[FloatArray]], area: BaseGeometry, spacing_mm: float) -> list[FloatArray]:
    """The same rings as few lines: each leads on to the nearest of the next level where the way there stays inside."""
    inside = area.buffer(_GRAZE_MM)  # ends lie on the edge, but for rounding
    shapely.prepare(inside)
    left = [list(rings) for rings in levels]
    lines = []
    for level, rings in enumerate(left):
        for ring in rings:
            line = [ring]
            for deeper in left[level + 1 :]:
                found = _nearest(line[-1][-1], deeper, inside, spacing_mm)
                if found is None:
                    break
                index, at = found
                inner = deeper.pop(index)
                line.append(np.concatenate((inner[at:-1], inner[: at + 1])))
            lines.append(np.concatenate(line))
    return lines


def _nearest(
    place: FloatArray, rings: list[FloatArray], inside: BaseGeometry, spacing_mm: float
) -> tuple[int, int] | None:
    """Which ring, and where on it, the line is led to; None where none is near enough inside."""
    best = None
    for index, ring in enumerate(rings):
        distance_mm = np.hypot(*(ring[:-1] - place).T)
        at = int(np.argmin(distance_mm))
        if distance_mm[at] <= 3.0 * spacing_mm and (best is None or distance_mm[at] < best[0]):
            best = (float(distance_mm[at]), index, at)
    if best is None:
        return None
    _, index, at = best
    return (index, at) if inside.covers(shapely.LineString((place, rings[index][at]))) else None
