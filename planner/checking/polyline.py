"""Lines as points close to each other, and the distance of points to them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from planner.arrays import BoolArray, FloatArray, IntArray

NEAR_MM = 1.0
_FEW = 25
_NEAREST = 4
_POINTS_AT_ONCE = 100_000


@dataclass(frozen=True, eq=False, slots=True)
class DenseLines:
    """Polylines cut fine.

    points_mm: (n, 2) all points, line after line. joined: (n,) the line goes on to the next point.
    source: (n,) index of the original point at or before each.
    """

    points_mm: FloatArray
    joined: BoolArray
    source: IntArray

    def length_at_points_mm(self) -> FloatArray:
        """(n,) the share of the total length around each point."""
        step = np.zeros(len(self.points_mm))
        step[:-1] = np.linalg.norm(np.diff(self.points_mm, axis=0), axis=1) * self.joined[:-1]
        share: FloatArray = (step + np.concatenate(([0.0], step[:-1]))) / 2
        return share

    def distance_mm(self, points_mm: FloatArray) -> FloatArray:
        """(k,) distance of points (k, 2) to the lines; needs at least one point to measure to.

        Taken to the pieces beside the nearest points: of one alone, where a line ends on its beginning or runs beside
        itself, another piece may be nearer by much of the spacing. Figures err on the large side only. Beyond
        NEAR_MM the nearest point is sought among few, and the figure can be too large by half their distance.
        """
        tree = cKDTree(self.points_mm)
        is_first = np.concatenate(([True], ~self.joined[:-1]))
        few = np.flatnonzero(is_first | ~self.joined | (np.arange(len(self.points_mm)) % _FEW == 0))
        coarse = cKDTree(self.points_mm[few])
        distance = np.empty(len(points_mm))
        for start in range(0, len(points_mm), _POINTS_AT_ONCE):
            block = points_mm[start : start + _POINTS_AT_ONCE]
            near = tree.query(block, k=_NEAREST, distance_upper_bound=NEAR_MM)
            gap, found = np.array(near[0]), np.array(near[1], dtype=np.int64)
            far = np.isinf(gap[:, 0])  # a search for neighbours that are far away is slow in a large tree
            found[far, 0] = few[coarse.query(block[far])[1]]
            found = np.where(np.isinf(gap) | far[:, None], found[:, :1], found)
            distance[start : start + _POINTS_AT_ONCE] = np.min(
                [self._beside(block, nearest) for nearest in found.T], axis=0
            )
        return distance

    def _beside(self, points_mm: FloatArray, nearest: IntArray) -> FloatArray:
        """(k,) distance of points (k, 2) to the pieces on both sides of the points of these indices (k,)."""
        before = np.maximum(nearest - 1, 0)
        before = np.where(self.joined[before], before, nearest)
        after = np.where(self.joined[nearest], nearest + 1, nearest)
        beside: FloatArray = np.minimum(
            _to_segments(points_mm, self.points_mm[before], self.points_mm[nearest]),
            _to_segments(points_mm, self.points_mm[nearest], self.points_mm[after]),
        )
        return beside


def joined_lines(lines: Sequence[FloatArray]) -> tuple[FloatArray, BoolArray]:
    """Lines (n, 2) end to end, as `dense_lines` takes them: points, and whether each goes on to the next one."""
    points = np.concatenate(lines)
    joined = np.ones(len(points), dtype=bool)
    joined[np.cumsum([len(line) for line in lines]) - 1] = False
    return points, joined


def dense_lines(points_mm: FloatArray, joined: BoolArray, spacing_mm: float) -> DenseLines:
    """Cut polylines into pieces of `spacing_mm` at most.

    points_mm: (n, 2). joined: (n,) a point goes on to the next one, False for the last. Points that
    follow within a twentieth of the spacing are left out, the ends of lines aside.
    """
    length = np.zeros(len(points_mm))
    length[:-1] = np.linalg.norm(np.diff(points_mm, axis=0), axis=1) * joined[:-1]
    cell = np.floor(np.cumsum(np.concatenate(([0.0], length[:-1]))) / (spacing_mm / 20))
    is_first = np.concatenate(([True], ~joined[:-1]))
    kept = np.flatnonzero(is_first | ~joined | (np.diff(cell, prepend=-1.0) > 0))
    points_mm, joined = points_mm[kept], joined[kept]
    gap = np.zeros_like(points_mm)
    gap[:-1] = np.diff(points_mm, axis=0) * joined[:-1, np.newaxis]
    count = np.maximum(np.ceil(np.linalg.norm(gap, axis=1) / spacing_mm).astype(np.int64), 1)
    origin = np.repeat(np.arange(len(points_mm)), count)
    first = np.cumsum(count) - count
    fraction = (np.arange(len(origin)) - first[origin]) / count[origin]
    return DenseLines(points_mm[origin] + fraction[:, np.newaxis] * gap[origin], joined[origin], kept[origin])


def _to_segments(points: FloatArray, begins: FloatArray, ends: FloatArray) -> FloatArray:
    """(k,) distance of each point to its own segment; all (k, 2)."""
    along = ends - begins
    square = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", points - begins, along) / np.where(square > 0, square, 1.0)
    foot = begins + np.clip(share, 0.0, 1.0)[:, np.newaxis] * along
    distance: FloatArray = np.linalg.norm(points - foot, axis=1)
    return distance
