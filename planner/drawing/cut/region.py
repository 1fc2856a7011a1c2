"""The filled area of subpaths, by fill rule."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.drawing.cubics import at, chord_counts, chord_ends
from planner.drawing.subpath import Subpath

FLATTENING = 1e-6
"""Chord error of the edges, against the extent of the area: two ten-thousandths of a millimetre on a page of 200 mm."""
_GRID = 1e-10
"""Where edges cross, their meeting points fall on a grid as fine as this against the extent. Fixed precision is what
keeps the overlay from failing where edges nearly coincide."""
_MOST_CHORDS = 4096
"""Of a curve: handles of absurd length are no reason to run out of memory."""
_FEW_RINGS = 8


def region(subpaths: Sequence[Subpath], is_even_odd: bool, tolerance: float = 0.0) -> BaseGeometry:
    """The area that a fill of `subpaths` covers, open ones closed: a polygon, several, or an empty one, always valid.
    Curves become chords, which miss them by less than a millionth of the extent, or than `tolerance` where that is
    more. Coordinates are finite."""
    rings = _rings(subpaths, tolerance)
    if not rings:
        return shapely.Polygon()
    is_plain = len(rings) == 1 or (is_even_odd and len(rings) <= _FEW_RINGS)
    if is_plain:
        polygons: list[BaseGeometry] = [shapely.Polygon(ring) for ring in rings]
        if np.all(shapely.is_valid(polygons)):
            return _polygonal(reduce(shapely.symmetric_difference, polygons))
    return _faces(rings, is_even_odd)


def _rings(subpaths: Sequence[Subpath], tolerance: float) -> list[FloatArray]:
    """Closed polylines (n, 2), n at least 4, of the subpaths that have an area to them."""
    curved = [path.beziers for path in subpaths if len(path.beziers)]
    if not curved:
        return []
    control = np.concatenate(curved)
    extent = float(np.ptp(control.reshape(-1, 2), axis=0).max())
    if extent == 0.0:
        return []
    counts = np.minimum(chord_counts(control, max(tolerance, FLATTENING * extent)), _MOST_CHORDS).astype(np.int64)
    curve, t = chord_ends(counts)
    ends = at(control[curve], t[:, np.newaxis])
    is_last = t == 1.0
    ends[is_last] = control[curve[is_last], 3]
    n_points = np.add.reduceat(counts, np.cumsum([0, *map(len, curved[:-1])]))
    rings = []
    for beziers, points in zip(curved, np.split(ends, np.cumsum(n_points)[:-1]), strict=True):
        ring = np.concatenate((beziers[:1, 0], points, beziers[:1, 0]))
        ring = ring[np.append(True, np.any(ring[1:] != ring[:-1], axis=1))]
        if len(ring) >= 4:
            rings.append(ring)
    return rings


def _faces(rings: Sequence[FloatArray], is_even_odd: bool) -> BaseGeometry:
    """The union of the faces of the arrangement of all edges that the fill rule takes."""
    points = np.concatenate(rings)
    grid = _GRID * float(np.ptp(points, axis=0).max())
    nodes = shapely.unary_union([shapely.LineString(ring) for ring in rings], grid_size=grid)
    faces = shapely.get_parts(shapely.polygonize([nodes]))
    if not len(faces):
        return shapely.Polygon()
    winding = _winding_numbers(shapely.get_coordinates(shapely.point_on_surface(faces)), rings)
    is_filled: BoolArray = winding % 2 != 0 if is_even_odd else winding != 0
    return _polygonal(shapely.coverage_union_all(faces[is_filled]))


def _winding_numbers(points: FloatArray, rings: Sequence[FloatArray]) -> IntArray:
    """(n,) how often the rings run around each of the points (n, 2): the edges that cross the ray to the right of it,
    those that go up less those that go down."""
    begins = np.concatenate([ring[:-1] for ring in rings])
    ends = np.concatenate([ring[1:] for ring in rings])
    edges = shapely.STRtree(np.asarray(shapely.linestrings(np.stack((begins, ends), axis=1))))
    right = max(float(begins[:, 0].max()), float(points[:, 0].max()))
    rays = np.stack((points, np.column_stack((np.full(len(points), right), points[:, 1]))), axis=1)
    point, edge = edges.query(np.asarray(shapely.linestrings(rays)))
    (x, y), (x0, y0), (x1, y1) = points[point].T, begins[edge].T, ends[edge].T
    is_up, is_down = (y0 <= y) & (y1 > y), (y1 <= y) & (y0 > y)
    # Which side of an edge that goes up the point is on; the left one has the edge on its right.
    side = (x1 - x0) * (y - y0) - (x - x0) * (y1 - y0)
    crossings = (is_up & (side > 0.0)).astype(np.int64) - (is_down & (side < 0.0))
    return np.bincount(point, weights=crossings, minlength=len(points)).astype(np.int64)


def _polygonal(geometry: BaseGeometry) -> BaseGeometry:
    """Without the lines and points that an overlay may leave; prepared for many questions."""
    areas = [part for part in shapely.get_parts(geometry) if shapely.get_dimensions(part) == 2 and not part.is_empty]
    result = areas[0] if len(areas) == 1 else shapely.MultiPolygon(areas) if areas else shapely.Polygon()
    shapely.prepare(result)
    return result
