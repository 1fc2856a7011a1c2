"""Subpaths cut by a region: the parts of them that lie inside, or outside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import BoolArray, FloatArray, IntArray, frozen
from planner.drawing.cubics import at, part
from planner.drawing.cut.crossings import crossings
from planner.drawing.cut.region import FLATTENING
from planner.drawing.subpath import Subpath, joined

_REACH = 1e-9
"""How far past a corner, against the extent of the region, an edge still cuts: rounding must not let a line slip
through where two edges meet."""
_SAME_PARAMETER = 1e-11
_SPANS = 32
"""Curves are tried against edges in spans of this part of the region's extent: the box of a long slanting line holds
edges that it is nowhere near."""
_MOST_SPANS = 128
_PROBES = (0.5, 0.21, 0.77)


def cut(subpath: Subpath, region: BaseGeometry) -> list[Subpath]:
    """The parts of a subpath that lie in a region, as `Cutter.inside` has them; for many subpaths make one Cutter."""
    return Cutter(region).inside([subpath])[0]


class Cutter:
    """A region made ready to cut many subpaths.

    Curves are cut at the exact parameter: the ends of parts lie on the edge of the region. What runs along the edge
    counts as inside. A subpath that is not cut comes back as the same object, a closed one that is stays in one
    piece over its start point, and a dash keeps the gap after it where its end is left.
    """

    def __init__(self, region: BaseGeometry, slack: float | None = None) -> None:
        """slack: how far from the region a line is still along its edge, by default what the chords of the edge may
        miss the curve that they stand for."""
        self._region = region
        shapely.prepare(region)
        self._edges = _edges(region)
        self._tree: shapely.STRtree | None = None
        left, bottom, right, top = region.bounds if not region.is_empty else (0.0, 0.0, 0.0, 0.0)
        self._extent = max(right - left, top - bottom)
        self._slack = 2.0 * FLATTENING * self._extent if slack is None else slack
        self._low, self._high = np.array([left, bottom]) - self._slack, np.array([right, top]) + self._slack

    def inside(self, subpaths: Sequence[Subpath]) -> list[list[Subpath]]:
        """The parts of each subpath that are in the region."""
        return self._parts(subpaths, is_inside=True)

    def outside(self, subpaths: Sequence[Subpath]) -> list[list[Subpath]]:
        """The parts of each subpath that are not."""
        return self._parts(subpaths, is_inside=False)

    def _parts(self, subpaths: Sequence[Subpath], is_inside: bool) -> list[list[Subpath]]:
        if not subpaths:
            return []
        is_covered, is_apart = self._hulls(subpaths)
        is_whole = is_covered if is_inside else is_apart
        parts = [[path] if whole else [] for path, whole in zip(subpaths, is_whole, strict=True)]
        torn = np.flatnonzero(~is_covered & ~is_apart).tolist()
        if torn:
            found = self._torn([subpaths[index] for index in torn], is_inside)
            for index, of_one in zip(torn, found, strict=True):
                parts[index] = of_one
        return parts

    def _hulls(self, subpaths: Sequence[Subpath]) -> tuple[BoolArray, BoolArray]:
        """Which subpaths lie wholly in the region, and which wholly outside, as far as their boxes tell; of dots one of
        the two is true."""
        first = np.cumsum([0, *(len(path.beziers) for path in subpaths[:-1])])
        control = np.concatenate([path.beziers for path in subpaths])
        low, high = (np.minimum.reduceat(control.min(axis=1), first), np.maximum.reduceat(control.max(axis=1), first))
        is_covered = np.zeros(len(subpaths), dtype=np.bool_)
        if self._region.is_empty:
            return is_covered, ~is_covered
        is_apart: BoolArray = np.any((high < self._low) | (low > self._high), axis=1)
        is_dot = np.all(low == high, axis=1)
        is_flat = np.any(low == high, axis=1) & ~is_dot
        hulls = np.empty(len(subpaths), dtype=object)
        hulls[:] = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
        hulls[is_flat] = shapely.linestrings(np.stack((low, high), axis=1)[is_flat])
        hulls[is_dot] = shapely.points(low[is_dot])
        near = np.flatnonzero(~is_apart)
        is_apart[near] = ~shapely.dwithin(self._region, hulls[near], self._slack)
        near = np.flatnonzero(~is_apart)
        is_covered[near] = is_dot[near] | shapely.covers(self._region, hulls[near])
        return is_covered, is_apart

    def _torn(self, subpaths: Sequence[Subpath], is_inside: bool) -> list[list[Subpath]]:
        """The parts of subpaths that may cross the edge."""
        control = np.concatenate([path.beziers for path in subpaths])
        owner = np.repeat(np.arange(len(subpaths)), [len(path.beziers) for path in subpaths])
        curve, start, end = _intervals(len(control), *self._crossings(control))
        kept = self._is_inside(control[curve], start, end) == is_inside
        is_first = np.diff(owner[curve], prepend=-1) != 0
        first = np.flatnonzero(is_first)
        is_whole = np.logical_and.reduceat(kept, first)
        from_start, to_end = kept[first], kept[np.append(first[1:], len(curve)) - 1]
        # A run goes on while intervals are kept; within it, the intervals of one curve are one part.
        begins_run = kept & (is_first | ~np.append(False, kept[:-1]))
        begins_part = kept & (begins_run | (np.diff(curve, prepend=-1) != 0))
        ends_part = kept & np.append(begins_part[1:] | ~kept[1:], True)
        beziers = part(control[curve[begins_part]], start[begins_part], end[ends_part])
        is_vertex = np.concatenate([path.is_vertex for path in subpaths])[curve[ends_part]] | (end[ends_part] < 1.0)
        breaks = np.flatnonzero(begins_run[begins_part])[1:]
        parts: list[list[Subpath]] = [[] for _ in subpaths]
        for index, *run in zip(
            owner[curve[begins_run]].tolist(), np.split(beziers, breaks), np.split(is_vertex, breaks), strict=False
        ):
            parts[index].append(Subpath(frozen(run[0]), False, run[1]))
        for index, path in enumerate(subpaths):
            if is_whole[index]:
                parts[index] = [path]
            elif path.gap is not None and to_end[index]:
                parts[index][-1] = replace(parts[index][-1], gap=path.gap)
            elif path.is_closed and from_start[index] and to_end[index]:
                first_run, *others = parts[index]
                parts[index] = [*others[:-1], joined(others[-1], first_run)]
        return parts

    def _crossings(self, control: FloatArray) -> tuple[IntArray, FloatArray]:
        """Where curves (n, 4, 2) cross the edge: the curve, and the parameter on it."""
        if self._tree is None:
            self._tree = shapely.STRtree(np.asarray(shapely.linestrings(self._edges)))
        size = np.ptp(control, axis=1).max(axis=1)
        spans = np.clip(np.ceil(_SPANS * size / self._extent), 1, _MOST_SPANS).astype(np.int64)
        curve = np.repeat(np.arange(len(control)), spans)
        index = np.arange(len(curve)) - np.repeat(np.cumsum(spans) - spans, spans)
        start, end = index / spans[curve], (index + 1) / spans[curve]
        pieces = part(control[curve], start, end)
        low, high = pieces.min(axis=1) - self._slack, pieces.max(axis=1) + self._slack
        near = np.flatnonzero(np.all((high >= self._low) & (low <= self._high), axis=1))
        boxes = shapely.box(low[near, 0], low[near, 1], high[near, 0], high[near, 1])
        span, edge = self._tree.query(np.asarray(boxes))
        span = near[span]
        pair, t = crossings(control[curve[span]], start[span], end[span], self._edges[edge], _REACH * self._extent)
        return curve[span[pair]], t

    def _is_inside(self, control: FloatArray, start: FloatArray, end: FloatArray) -> BoolArray:
        """(n,) whether the stretches of cubics between parameters, which cross no edge, are in the region."""
        is_inside = np.ones(len(control), dtype=np.bool_)
        for share in _PROBES:
            x, y = at(control, (start + share * (end - start))[:, np.newaxis]).T
            is_in = shapely.contains_xy(self._region, x, y)
            out = np.flatnonzero(~is_in & is_inside)
            is_in[out] = shapely.dwithin(self._region, shapely.points(x[out], y[out]), self._slack)
            is_inside &= is_in
        return is_inside


def _edges(region: BaseGeometry) -> FloatArray:
    """The edges of all rings, (n, 2, 2)."""
    rings = shapely.get_rings(shapely.get_parts(region))
    points, ring = shapely.get_coordinates(rings, return_index=True)
    is_edge = ring[1:] == ring[:-1]
    edges: FloatArray = np.stack((points[:-1], points[1:]), axis=1)[is_edge]
    return edges


def _intervals(n_curves: int, curve: IntArray, t: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """All curves cut at parameters: of each interval the curve, its start and its end, in order."""
    is_amid = (t > _SAME_PARAMETER) & (t < 1.0 - _SAME_PARAMETER)
    curves = np.concatenate((np.arange(n_curves), curve[is_amid]))
    starts = np.concatenate((np.zeros(n_curves), t[is_amid]))
    order = np.lexsort((starts, curves))
    curves, starts = curves[order], starts[order]
    is_new = (np.diff(curves, prepend=-1) != 0) | (np.diff(starts, prepend=-1.0) > _SAME_PARAMETER)
    curves, starts = curves[is_new], starts[is_new]
    is_last = np.append(np.diff(curves) != 0, True)
    ends = np.where(is_last, 1.0, np.append(starts[1:], 1.0))
    return curves, starts, ends
