"""Which of many points are nearest to a place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from planner.arrays import FloatArray, IntArray

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

_FEW = 500_000
"""Distances that are computed sooner than the library of trees is imported."""


class NearestPoints:
    """Points (n, dimensions) that are asked for. At first they are looked through one by one, and once that would have
    taken as long as to import trees, in a tree."""

    def __init__(self, points: FloatArray) -> None:
        self.points = points
        self._tree: cKDTree | None = None
        self._looked_at = 0

    def query(self, places: FloatArray, k: int) -> tuple[FloatArray, IntArray]:
        """Distances (m, k) and indices (m, k) of the k points nearest to each place (m, dimensions), the nearest first;
        k is not above n."""
        self._looked_at += len(places) * len(self.points)
        if self._looked_at > _FEW:
            distances, found = self._planted().query(places, k=np.arange(1, k + 1))
            return np.asarray(distances, dtype=np.float64), np.asarray(found, dtype=np.int64)
        apart = np.linalg.norm(places[:, None, :] - self.points, axis=-1)
        nearest: IntArray = np.argsort(apart, axis=1, kind="stable")[:, :k]
        return np.take_along_axis(apart, nearest, axis=1), nearest

    def _planted(self) -> cKDTree:
        if self._tree is None:
            from scipy.spatial import cKDTree

            self._tree = cKDTree(self.points)
        return self._tree
