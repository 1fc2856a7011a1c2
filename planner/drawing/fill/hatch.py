"""Parallel lines across an area, joined at their ends wherever the way between them stays inside."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import BoolArray, FloatArray
from planner.errors import PlanError

MOST_LINES = 400_000
_JOINED_WITHIN = 3.0
"""Spacings that the way between the ends of two neighbours may be long."""
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
    ends = [np.asarray(part.coords)[[0, -1], :2] for part in parts]
    segments = [
        (int(at), np.sort(end[:, 0])) for at, end in zip(row, ends, strict=True) if np.ptp(end[:, 0]) > _LEAST_MM
    ]
    inside = level.buffer(_GRAZE * spacing_mm)  # ends lie on the edge, but for rounding
    shapely.prepare(inside)
    chains = chained(segments, heights, inside.covers, spacing_mm, is_zigzag)
    return [chain @ turn for chain in chains]


def chained(
    segments: list[tuple[int, FloatArray]],
    heights: FloatArray,
    may_draw: Callable[[shapely.LineString], bool],
    spacing_mm: float,
    is_zigzag: bool = False,
) -> list[FloatArray]:
    """Segments, each the row that it is on and where it begins and ends, joined to and fro, each to the nearest of the
    next row that it can be joined to by a line that may be drawn. heights: of the rows."""
    by_row: dict[int, list[int]] = {}
    for index, (row, _) in enumerate(segments):
        by_row.setdefault(row, []).append(index)
    is_used = np.zeros(len(segments), dtype=np.bool_)
    chains = []
    for first in range(len(segments)):
        if is_used[first]:
            continue
        is_used[first] = True
        row, (left, right) = segments[first]
        points = [(left, heights[row])] if is_zigzag else [(left, heights[row]), (right, heights[row])]
        side, current = 1, first
        if is_zigzag:
            side = 0
        while True:
            following = _next(
                segments, by_row, current, points[-1], heights, may_draw, spacing_mm, is_used, side, is_zigzag
            )
            if following is None:
                break
            is_used[following] = True
            row, span = segments[following]
            if is_zigzag:
                side = 1 - side
                points.append((span[side], heights[row]))
            else:
                points += [(span[side], heights[row]), (span[1 - side], heights[row])]
                side = 1 - side
            current = following
        if is_zigzag and len(points) == 1:  # a segment by itself
            row, (left, right) = segments[first]
            points = [(left, heights[row]), (right, heights[row])]
        chains.append(np.array(points))
    return chains


def _next(
    segments: list[tuple[int, FloatArray]],
    by_row: dict[int, list[int]],
    current: int,
    place: tuple[float, float],
    heights: FloatArray,
    may_draw: Callable[[shapely.LineString], bool],
    spacing_mm: float,
    is_used: BoolArray,
    side: int,
    is_zigzag: bool,
) -> int | None:
    row, _ = segments[current]
    best = None
    for index in by_row.get(row + 1, ()):
        if is_used[index]:
            continue
        to = segments[index][1][1 - side if is_zigzag else side]
        way = shapely.LineString((place, (to, heights[row + 1])))
        short = way.length <= _JOINED_WITHIN * spacing_mm or is_zigzag
        if short and (best is None or way.length < best[0]) and may_draw(way):
            best = (way.length, index)
    return None if best is None else best[1]
