"""Polylines laid end to end on one axis of arc length, and distances between them and curves that follow them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.placement.segments import Segments, to_segments
from planner.ragged import starts_of, within

_GAP_MM = 1e4
_STEPS = 3
"""Steps along a polyline towards the point that is nearest: each goes as far as its segment says."""
_LONGEST_STEP_MM = 0.5
_AT_ONCE = 100_000
"""Segments about that are measured together."""
_OWN_PASS = 4.0
"""Times the distance from which on figures are exact: a curve passes a vertex with points that have their feet so near
to it."""
_BESIDE = np.arange(-32, 33) / 16
"""Where line beside a vertex is looked at, in such distances."""
_STRIDES = (1, 2, 4, 8, 16, 32, 16, 8, 4, 2, 1)
"""How many points of a curve are gone at a time in search of the one nearest to a vertex: few first, so that none leads
to another stretch of the curve while this one is nearer."""


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
    ) -> tuple[FloatArray, FloatArray]:
        """Feet and distances as `feet` has them, but exact above a distance."""
        foot_mm, distance = self.feet(points_mm, near_mm, line)
        far = np.flatnonzero(distance > exact_above_mm)
        if not len(far):
            return foot_mm, distance
        reach, of = 2.0 * distance[far], line[far]
        low = np.maximum(np.searchsorted(self.arc_mm, foot_mm[far] - reach) - 1, self.first[of])
        counts = np.minimum(np.searchsorted(self.arc_mm, foot_mm[far] + reach), self.last[of]) - low
        cuts = np.flatnonzero(np.diff(np.cumsum(counts) // _AT_ONCE)) + 1
        for some, begin, n_segments in zip(*(np.split(each, cuts) for each in (far, low, counts)), strict=True):
            segment = np.repeat(begin, n_segments) + within(n_segments)
            point = np.repeat(points_mm[some], n_segments, axis=0)
            gap = to_segments(point, self.points_mm[segment], self.points_mm[segment + 1])
            distance[some] = np.minimum(distance[some], np.minimum.reduceat(gap, starts_of(n_segments)[:-1]))
        return foot_mm, distance

    def deviations(
        self, curves_mm: FloatArray, near_mm: FloatArray, line: IntArray, exact_above_mm: float
    ) -> FloatArray:
        """(n,) how far curves are from the polylines that they follow at each of their points, and each point of the
        polylines from the curves, told where they pass it; never too small, and exact above a distance.

        curves_mm: (n, 2) curve after curve; near_mm: (n,) about where these points belong on the axis; line: (n,) the
        polyline that each follows.
        """
        foot_mm, deviation = self.distances(curves_mm, near_mm, line, exact_above_mm)
        place, missed = self._passed(curves_mm, foot_mm, line, exact_above_mm)
        np.maximum.at(deviation, place, missed)
        return deviation

    def _passed(
        self, curves_mm: FloatArray, foot_mm: FloatArray, line: IntArray, exact_above_mm: float
    ) -> tuple[IntArray, FloatArray]:
        """The point of a curve that passes each point of the polylines, and how far curve and point are apart.

        A polyline that passes a place twice has its points measured from the curve's own pass each time. Where that is
        far away, another pass may be near enough: then it counts, for the point and for the line beside it, which it
        may leave sooner than the own pass comes back.
        """
        counts = self.last - self.first + 1
        begins = np.searchsorted(line, np.arange(len(counts)))
        begin, end = np.repeat(begins, counts), np.repeat(np.append(begins[1:], len(line)) - 1, counts)
        reached = np.maximum.accumulate(foot_mm)
        place = np.clip(np.searchsorted(reached, self.arc_mm), begin, end)
        reach_mm = _OWN_PASS * exact_above_mm
        low = np.maximum(np.searchsorted(reached, self.arc_mm - reach_mm) - 1, begin)
        high = np.minimum(np.searchsorted(reached, self.arc_mm + reach_mm), end)
        place, missed = _nearest(self.points_mm, curves_mm, place, low, high)
        far = np.flatnonzero(missed > exact_above_mm)
        if len(far):
            of = np.repeat(np.arange(len(counts)), counts)[far]
            beside_mm = self.arc_mm[far, None] + exact_above_mm * _BESIDE
            beside_mm = np.clip(beside_mm, self.begin_mm[of, None], self.end_mm[of, None])
            around = Segments.of(curves_mm, line)
            for index, number, line_mm in zip(far.tolist(), of.tolist(), self.at(beside_mm), strict=True):
                segments = around.near(self.points_mm[index], number, 3.0 * exact_above_mm)
                at_point = float(to_segments(self.points_mm[index], *segments).min(initial=missed[index]))
                if at_point <= exact_above_mm:
                    at_point = float(to_segments(line_mm[:, None], *segments).min(axis=1).max())
                missed[index] = at_point
        return place, missed


def _nearest(
    points_mm: FloatArray, curve_mm: FloatArray, place: IntArray, low: IntArray, high: IntArray
) -> tuple[IntArray, FloatArray]:
    """The point of a curve (n, 2) that is nearest to each of some points (k, 2), and how far the curve is from these;
    sought from some place (k,) on between two others."""
    least = np.hypot(*(curve_mm[place] - points_mm).T)
    for stride in _STRIDES:
        middle = place
        for step in (-stride, stride):
            tried = np.clip(middle + step, low, high)
            gap = np.hypot(*(curve_mm[tried] - points_mm).T)
            place, least = np.where(gap < least, tried, place), np.minimum(gap, least)
    for begin, end in ((np.maximum(place - 1, low), place), (place, np.minimum(place + 1, high))):
        np.minimum(least, to_segments(points_mm, curve_mm[begin], curve_mm[end]), out=least)
    return place, least


def lines_of_parts(n_parts: IntArray, per_part: int) -> IntArray:
    """(total,) the curve that each point is of, where curves have so many points a part and one more at their end."""
    return np.repeat(np.arange(len(n_parts)), per_part * n_parts + 1)


def largest_of_parts(values: FloatArray, n_parts: IntArray, per_part: int) -> FloatArray:
    """(total parts,) the largest of values at such points, of the part that they are in."""
    ends = per_part * np.cumsum(n_parts) + np.arange(len(n_parts))
    inside = values.copy()
    inside[ends - 1] = np.maximum(values[ends - 1], values[ends])
    largest: FloatArray = np.delete(inside, ends).reshape(-1, per_part).max(axis=1)
    return largest
