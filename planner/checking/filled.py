"""The area that rings fill, in the check's own way."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray

_NOTHING = 1e-9


def filled(lines: Sequence[FloatArray], is_even_odd: bool) -> BaseGeometry:
    """The area of polylines (n, 2), closed, by the fill rule; empty where there is none.

    All edges together cut the plane into faces; a face is filled by how often the rings turn around a point of it, as
    the angles tell through which they are seen from there.
    """
    rings = [np.concatenate((line, line[:1])) for line in lines if len(line) > 2]
    if len(rings) == 1:
        polygon = shapely.Polygon(rings[0])
        if polygon.is_valid:
            return polygon if polygon.area > _NOTHING * polygon.length**2 else shapely.Polygon()
    faces = shapely.get_parts(shapely.polygonize([shapely.unary_union([shapely.LineString(ring) for ring in rings])]))
    kept = []
    for face in faces:
        if face.area <= _NOTHING * face.length**2:  # a sliver, of which no point is surely inside
            continue
        inner = np.array(face.representative_point().coords[0])
        turns = sum(_turns(ring - inner) for ring in rings)
        if turns % 2 != 0 if is_even_odd else turns != 0:
            kept.append(face)
    return shapely.union_all(kept) if kept else shapely.Polygon()


def _turns(ring: FloatArray) -> int:
    """How often a ring goes round the origin."""
    seen = ring @ np.array([1.0, 1.0j])
    return round(float(np.angle(seen[1:] / seen[:-1]).sum()) / (2.0 * np.pi))
