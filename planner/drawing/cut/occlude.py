"""What the eye does not see: lines under areas that are painted over them later."""

from __future__ import annotations

from collections.abc import Sequence

import shapely
from shapely.geometry.base import BaseGeometry

from planner.drawing.cut.cut import Cutter
from planner.drawing.subpath import Subpath


def occluded(
    lines: Sequence[Sequence[Subpath]], covers: Sequence[BaseGeometry | None], tolerance: float
) -> list[list[Subpath]]:
    """The lines of each of n things, in the order of painting, less what is under a cover painted after it.

    covers: the area, if any, that each of the things hides of all before it. tolerance: what the edges of covers may
    miss their curves by. A line along the edge of a cover is hidden by it: the edge is a line itself, drawn once.

    The lines of the lower half are cut by the union of the covers of the upper half, then each half is done by itself:
    every line is cut no more than log2(n) times, however many things lie on it.
    """
    left = [list(of_one) for of_one in lines]
    _hide(left, [shapely.Polygon() if cover is None else cover for cover in covers], 0, len(left), 2.0 * tolerance)
    return left


def _hide(
    left: list[list[Subpath]], covers: Sequence[BaseGeometry], first: int, last: int, slack: float
) -> BaseGeometry:
    """Cut the lines of the things from first to before last by each other's covers; the union of these."""
    if last - first <= 1:
        return covers[first] if first < last else shapely.Polygon()
    middle = (first + last) // 2
    above = _hide(left, covers, middle, last, slack)
    if not above.is_empty:
        parts = iter(Cutter(above, slack).outside([path for of_one in left[first:middle] for path in of_one]))
        for index in range(first, middle):
            left[index] = [part for _ in left[index] for part in next(parts)]
    below = _hide(left, covers, first, middle, slack)
    # The union of all is asked for by nobody.
    return above if first == 0 else shapely.union(below, above)
