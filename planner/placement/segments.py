"""Segments of curves: how far points are from them, and which are near to a point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray

_GAP_MM = 1e4


@dataclass(frozen=True, eq=False, slots=True)
class Segments:
    """Segments of curves, found by where they are: few are asked for in a plan, and a library's index takes longer to
    load.

    begins_mm, ends_mm: (n, 2) curve after curve, ordered by across_mm: (n,) the first coordinate of their begins, with
    a gap between the curves; longest_mm: how far a segment may reach.
    """

    begins_mm: FloatArray
    ends_mm: FloatArray
    across_mm: FloatArray
    longest_mm: float

    @staticmethod
    def of(curves_mm: FloatArray, line: IntArray) -> Segments:
        begins, ends = curves_mm[:-1], curves_mm[1:]
        inside = line[:-1] == line[1:]
        begins, ends, across = begins[inside], ends[inside], (begins[:, 0] + _GAP_MM * line[:-1])[inside]
        order = np.argsort(across)
        longest = float(np.hypot(*(ends - begins).T).max(initial=0.0))
        return Segments(begins[order], ends[order], across[order], longest)

    def near(self, point_mm: FloatArray, number: int, reach_mm: float) -> tuple[FloatArray, FloatArray]:
        """All segments of the curve of this number that come so near to a point, and some others."""
        reach_mm += self.longest_mm
        at = float(point_mm[0]) + _GAP_MM * number
        low, high = np.searchsorted(self.across_mm, (at - reach_mm, at + reach_mm)).tolist()
        begins, ends = self.begins_mm[low:high], self.ends_mm[low:high]
        near = np.abs(begins[:, 1] - point_mm[1]) <= reach_mm
        return begins[near], ends[near]


def to_segments(points_mm: FloatArray, begins_mm: FloatArray, ends_mm: FloatArray) -> FloatArray:
    """(n,) distance of points to segments, all (n, 2) or broadcast to that."""
    along, offset = ends_mm - begins_mm, points_mm - begins_mm
    share = (offset * along).sum(axis=-1) / np.maximum((along * along).sum(axis=-1), 1e-18)
    off = offset - np.clip(share, 0.0, 1.0)[..., None] * along
    distance: FloatArray = np.hypot(off[..., 0], off[..., 1])
    return distance
