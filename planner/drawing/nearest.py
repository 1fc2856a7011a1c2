"""Which of many points are nearest to a place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from planner.arrays import FloatArray, IntArray

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

_FEW = 300


class NearestPoints:
    """Points (n, dimensions) that are asked for. Few are looked through one by one: a tree takes longer to import."""

    def __init__(self, points: FloatArray) -> None:
        self.points = points
        self._tree: cKDTree | None = None
        if len(points) > _FEW:
            from scipy.spatial import cKDTree

            self._tree = cKDTree(points)

    def query(self, places: FloatArray, k: int) -> tuple[FloatArray, IntArray]:
        """Distances (m, k) and indices (m, k) of the k points nearest to each place (m, dimensions), the nearest first;
        k is not above n."""
        if self._tree is not None:
            distances, found = self._tree.query(places, k=np.arange(1, k + 1))
            return np.asarray(distances, dtype=np.float64), np.asarray(found, dtype=np.int64)
        apart = np.linalg.norm(places[:, None, :] - self.points, axis=-1)
        nearest: IntArray = np.argsort(apart, axis=1, kind="stable")[:, :k]
        return np.take_along_axis(apart, nearest, axis=1), nearest
