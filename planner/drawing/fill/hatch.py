"""Parallel lines across an area, joined along its edge, or across it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray, IntArray
from planner.drawing.fill.edge import Edge
from planner.errors import PlanError

MOST_LINES = 400_000
_JOINED_WITHIN = 12.0
"""Spacings that the way along the edge between two neighbours may be long."""
_LEAST_MM = 1e-6
_GRAZE = 1e-6


def hatched(area: BaseGeometry, angle_rad: float, spacing_mm: float, *, is_zigzag: bool = False) -> list[FloatArray]:
    """Lines (n, 2), mm, across an area in mm: as dense as the spacing says, on a grid that all areas share. is_zigzag:
    from one side of a line to the other side of the next, instead of along both. Errors: PlanError where they would be
    too many."""
    if area.is_empty:
        return []
    turn = np.array([[np.cos(angle_rad), np.sin(angle_rad)], [-np.sin(angle_rad), np.cos(angle_rad)]])
    level = shapely.transform(area, lambda points: points @ turn.T)
    left, low, right, high = level.bounds
    rows = np.arange(np.ceil(low / spacing_mm - 0.5), np.floor(high / spacing_mm - 0.5) + 1)
    if len(rows) > MOST_LINES:
        raise PlanError(f"a fill would take more than {MOST_LINES} lines: choose a wider --fill-spacing")
    heights = (rows + 0.5) * spacing_mm
    across = shapely.linestrings(
        np.stack((np.full((len(rows), 2), (left - 1.0, right + 1.0)), np.repeat(heights[:, None], 2, axis=1)), axis=2)
    )
    shapely.prepare(level)
    parts, row = shapely.get_parts(shapely.intersection(across, level), return_index=True)
    there = ~shapely.is_empty(parts)  # rows that miss the area
    parts, row = parts[there], row[there]
    ends = np.array([np.sort(np.asarray(part.coords)[[0, -1], 0]) for part in parts]).reshape(-1, 2)
    is_line = np.ptp(ends, axis=1) > _LEAST_MM
    spans = _Spans(row[is_line], ends[is_line], heights[row[is_line]])
    chains = _zigzags(spans, level, spacing_mm) if is_zigzag else _meanders(spans, level, spacing_mm)
    return [chain @ turn for chain in chains]


@dataclass(frozen=True, eq=False, slots=True)
class _Spans:
    """What of each row is in the area. row: (n,) ascending; x: (n, 2) left and right end; y: (n,)."""

    row: IntArray
    x: FloatArray
    y: FloatArray

    @property
    def ends(self) -> FloatArray:
        """(2 n, 2) left and right end of one after the other."""
        return np.column_stack((self.x.ravel(), np.repeat(self.y, 2)))

    def of_next_row(self, span: int) -> range:
        """Those of the row after that of a span."""
        return range(*np.searchsorted(self.row, (self.row[span] + 1, self.row[span] + 2)).tolist())


def _meanders(spans: _Spans, area: BaseGeometry, spacing_mm: float) -> list[FloatArray]:
    """Spans drawn to and fro, each led along the edge to the nearest of the next row."""
    ends = spans.ends
    edge = Edge(area, ends)
    is_used = np.zeros(len(spans.row), dtype=np.bool_)
    chains = []
    for first in range(len(spans.row)):
        if is_used[first]:
            continue
        is_used[first] = True
        points, last = [ends[2 * first : 2 * first + 2]], 2 * first + 1
        while True:
            beside = [2 * span + last % 2 for span in spans.of_next_row(last // 2) if not is_used[span]]
            if not beside:
                break
            lengths = [edge.length(last, end) for end in beside]
            nearest = int(np.argmin(lengths))
            if lengths[nearest] > _JOINED_WITHIN * spacing_mm:
                break
            end = beside[nearest]
            is_used[end // 2] = True
            points += [edge.way(last, end), ends[[end, end ^ 1]]]
            last = end ^ 1
        chains.append(np.concatenate(points))
    return chains


def _zigzags(spans: _Spans, area: BaseGeometry, spacing_mm: float) -> list[FloatArray]:
    """Lines from one end of a span to the other end of one of the next row, where the way there stays inside."""
    ends = spans.ends
    inside = area.buffer(_GRAZE * spacing_mm)  # ends lie on the edge, but for rounding
    shapely.prepare(inside)
    is_used = np.zeros(len(spans.row), dtype=np.bool_)
    chains = []
    for first in range(len(spans.row)):
        if is_used[first]:
            continue
        is_used[first] = True
        found = [2 * first]
        while True:
            across = [2 * span + 1 - found[-1] % 2 for span in spans.of_next_row(found[-1] // 2) if not is_used[span]]
            ways = shapely.linestrings([ends[[found[-1], end]] for end in across]) if across else np.empty(0)
            clear = shapely.covers(inside, ways)
            if not clear.any():
                break
            found.append(across[int(np.argmin(np.where(clear, shapely.length(ways), np.inf)))])
            is_used[found[-1] // 2] = True
        if len(found) == 1:  # a span by itself
            found.append(2 * first + 1)
        chains.append(ends[found])
    return chains
