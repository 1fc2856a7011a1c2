"""Ways along the edge of an area, from one place on it to another."""

from __future__ import annotations

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray


class Edge:
    """The rings that bound an area, and places on them."""

    def __init__(self, area: BaseGeometry, places: FloatArray) -> None:
        """places: (n, 2), on the edge but for rounding."""
        rings = shapely.get_rings(shapely.get_parts(area))
        points = shapely.points(places)
        self._ring_of = np.asarray(shapely.STRtree(rings).nearest(points), dtype=np.int64)
        self._at: FloatArray = shapely.line_locate_point(rings[self._ring_of], points)
        self._corners = [np.asarray(ring.coords)[:, :2] for ring in rings]
        self._corners_at = [
            np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T)))) for corners in self._corners
        ]

    def length(self, one: int, other: int) -> float:
        """Of the shorter way between two places, by their numbers; infinite where none is."""
        if self._ring_of[one] != self._ring_of[other]:
            return np.inf
        ahead = abs(float(self._at[other] - self._at[one]))
        return min(ahead, float(self._corners_at[self._ring_of[one]][-1]) - ahead)

    def way(self, one: int, other: int) -> FloatArray:
        """(k, 2) the corners on that way, both places left out."""
        ring = self._ring_of[one]
        corners, corners_at = self._corners[ring][:-1], self._corners_at[ring]
        begin, end = sorted((float(self._at[one]), float(self._at[other])))
        first, last = np.searchsorted(corners_at[:-1], (begin, end), side="right")
        if end - begin <= corners_at[-1] / 2:
            found = corners[first:last]
        else:  # backwards, over where the ring begins
            found = np.concatenate((corners[last:], corners[:first]))[::-1]
        way: FloatArray = found if self._at[one] <= self._at[other] else found[::-1]
        return way
