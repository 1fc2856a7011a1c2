"""Polylines laid end to end on one axis of arc length, and distances between them and curves that follow them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.ragged import starts_of, within

_GAP_MM = 1e4
_STEPS = 3
"""Steps along a polyline towards the point that is nearest: each goes as far as its segment says."""
_LONGEST_STEP_MM = 0.5
_BESIDE = 6
"""Pieces of a curve, before and behind the place where it should pass a vertex, that are looked at."""


@dataclass(frozen=True, eq=False, slots=True)
class Polylines:
    """Polylines on one axis of arc length, with a gap between each and the next that keeps them apart.

    points_mm: (n, 2) all points; arc_mm: (n,) where they are on the axis; first, last: (n_lines,) of each polyline.
    """

    points_mm: FloatArray
    arc_mm: FloatArray
    first: IntArray
    last: IntArray

    @staticmethod
    def of(polylines: Sequence[FloatArray]) -> Polylines:
        """Of polylines (n >= 2, 2) with distinct neighbours."""
        counts = np.array([len(points) for points in polylines])
        points = np.concatenate(polylines)
        starts = starts_of(counts)
        steps = np.zeros(len(points))
        steps[1:] = np.hypot(*np.diff(points, axis=0).T)
        steps[starts[1:-1]] = _GAP_MM
        return Polylines(points, np.cumsum(steps), starts[:-1], starts[1:] - 1)

    def subset(self, chosen: BoolArray) -> Polylines:
        """Only the polylines of the mask (n_lines,); arc lengths stay what they are."""
        counts = self.last - self.first + 1
        points = np.repeat(chosen, counts)
        starts = starts_of(counts[chosen])
        return Polylines(self.points_mm[points], self.arc_mm[points], starts[:-1], starts[1:] - 1)

    @property
    def begin_mm(self) -> FloatArray:
        return self.arc_mm[self.first]

    @property
    def end_mm(self) -> FloatArray:
        return self.arc_mm[self.last]

    def at(self, arc_mm: FloatArray) -> FloatArray:
        """(..., 2) points at positions on the axis of arc length."""
        return np.stack([np.interp(arc_mm, self.arc_mm, column) for column in self.points_mm.T], axis=-1)

    @property
    def directions(self) -> FloatArray:
        """(n - 1, 2) unit vectors from each point to the next; those across a gap mean nothing."""
        steps = np.diff(self.points_mm, axis=0)
        unit: FloatArray = steps / np.maximum(np.hypot(*steps.T), 1e-300)[:, None]
        return unit

    @property
    def turns(self) -> FloatArray:
        """(n,) 2 sin(turning angle / 2) at each point, 0 at the ends of polylines."""
        turns = np.zeros(len(self.points_mm))
        turns[1:-1] = np.hypot(*np.diff(self.directions, axis=0).T)
        turns[self.first] = turns[self.last] = 0.0
        return turns

    def segments(self, arc_mm: FloatArray, line: IntArray) -> IntArray:
        """(n,) the segment at each position, by the number of its first point; line: (n,) the polyline that it is
        on."""
        found = np.searchsorted(self.arc_mm, arc_mm, side="right") - 1
        return np.clip(found, self.first[line], self.last[line] - 1)

    def feet(self, points_mm: FloatArray, near_mm: FloatArray, line: IntArray) -> tuple[FloatArray, FloatArray]:
        """Positions (n,) on the axis of points of the polylines that are nearest to points (n, 2), and how far these
        are, found from positions (n,) nearby: the distance is never too small."""
        directions, begin, end = self.directions, self.begin_mm[line], self.end_mm[line]
        arc = np.clip(near_mm, begin, end)
        offset = points_mm - self.at(arc)
        best, least = arc, np.hypot(*offset.T)
        for _ in range(_STEPS):
            step = (offset * directions[self.segments(arc, line)]).sum(axis=1)
            arc = np.clip(arc + np.clip(step, -_LONGEST_STEP_MM, _LONGEST_STEP_MM), begin, end)
            offset = points_mm - self.at(arc)
            distance = np.hypot(*offset.T)
            best, least = np.where(distance < least, arc, best), np.minimum(distance, least)
        return best, least

    def distances(
        self, points_mm: FloatArray, near_mm: FloatArray, line: IntArray, exact_above_mm: float
    ) -> FloatArray:
        """(n,) the same distances; where they are larger than that, of all points not much further along."""
        foot_mm, distance = self.feet(points_mm, near_mm, line)
        for index in np.flatnonzero(distance > exact_above_mm).tolist():
            reach = 2.0 * float(distance[index])
            low, high = np.searchsorted(self.arc_mm, foot_mm[index] + np.array([-reach, reach]))
            low = max(int(low) - 1, int(self.first[line[index]]))
            high = min(int(high) + 1, int(self.last[line[index]]) + 1)
            piece = self.points_mm[low:high]
            distance[index] = min(distance[index], to_segments(points_mm[index], piece[:-1], piece[1:]).min())
        return distance

    def missed(self, curve_mm: FloatArray, arc_mm: FloatArray, line: IntArray) -> tuple[FloatArray, IntArray]:
        """How far each point of the polylines is from curves that follow them, (n,), and the curve point before which
        they pass it.

        curve_mm: (m, 2) points of the curves, one curve after the other; arc_mm: (m,) about where these are on the
        axis; line: (m,) the polyline that each follows.
        """
        place = np.searchsorted(np.maximum.accumulate(arc_mm), self.arc_mm)
        own = np.repeat(np.arange(len(self.first)), self.last - self.first + 1)
        low, high = np.searchsorted(line, own), np.searchsorted(line, own, side="right") - 1
        least = np.full(len(own), np.inf)
        for beside in range(-_BESIDE, _BESIDE):
            begin = np.clip(place + beside, low, high)
            end = np.minimum(begin + 1, high)
            np.minimum(least, to_segments(self.points_mm, curve_mm[begin], curve_mm[end]), out=least)
        return least, np.clip(place, low, high)


def to_segments(points_mm: FloatArray, begins_mm: FloatArray, ends_mm: FloatArray) -> FloatArray:
    """(n,) distance of points to segments, all (n, 2) or broadcast to that."""
    along, offset = ends_mm - begins_mm, points_mm - begins_mm
    share = (offset * along).sum(axis=-1) / np.maximum((along * along).sum(axis=-1), 1e-18)
    off = offset - np.clip(share, 0.0, 1.0)[..., None] * along
    distance: FloatArray = np.hypot(off[..., 0], off[..., 1])
    return distance


def lines_of_cells(n_cells: IntArray, per_cell: int, ends: int) -> IntArray:
    """(total,) the path of each point, where paths have so many points a cell and so many more at their end."""
    counts = per_cell * n_cells + ends
    return np.cumsum(within(counts) == 0) - 1
