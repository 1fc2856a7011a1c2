"""Lines on rows, joined where the short way from one to the next may be drawn."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import shapely

from planner.arrays import FloatArray

_LONGEST = 3.0
"""Of a way between rows, in line widths."""


def chained(
    segments: Sequence[tuple[int, FloatArray]],
    heights: FloatArray,
    may_draw: Callable[[shapely.LineString], bool],
    line_mm: float,
) -> list[FloatArray]:
    """Segments, each the row that it is on and where it begins and ends (2,), drawn to and fro (n, 2), each led on to
    the nearest of the next row. heights: of the rows."""
    by_row: dict[int, list[int]] = {}
    for index, (row, _) in enumerate(segments):
        by_row.setdefault(row, []).append(index)
    is_left = np.ones(len(segments), dtype=np.bool_)

    def following(row: int, place: tuple[float, float], side: int) -> int | None:
        """The segment of the next row that the pen goes on with from `place`, entering it at that side."""
        best = None
        for index in by_row.get(row + 1, ()):
            if not is_left[index]:
                continue
            way = shapely.LineString((place, (segments[index][1][side], heights[row + 1])))
            if way.length <= _LONGEST * line_mm and (best is None or way.length < best[0]) and may_draw(way):
                best = (way.length, index)
        return None if best is None else best[1]

    chains = []
    for first in range(len(segments)):
        if not is_left[first]:
            continue
        side, points = 0, list[tuple[float, float]]()
        current: int | None = first
        while current is not None:
            is_left[current] = False
            row, span = segments[current]
            points += [(float(span[side]), float(heights[row])), (float(span[1 - side]), float(heights[row]))]
            side = 1 - side
            current = following(row, points[-1], side)
        chains.append(np.array(points))
    return chains
