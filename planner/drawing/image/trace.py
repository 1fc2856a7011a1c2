"""The outlines of dark areas."""

from __future__ import annotations

import numpy as np
import shapely

from planner.arrays import FloatArray
from planner.drawing.image.seen import SeenPicture
from planner.drawing.image.threshold import blurred, threshold
from planner.drawing.path_work import simplified

_STEPS_PX = 0.7
"""The blur that takes the steps off edges of plain black and white."""
_BLUR = 0.25
"""Of the finest detail."""
_OFF_PX, _OFF = 0.25, 0.125
"""How far points may be left out for: of a pixel, and of the finest detail."""

_SHORT = 4.0


def traced(picture: SeenPicture, levels: int, least_mm: float) -> list[FloatArray]:
    """Closed lines (n, 2), mm. levels: one for what is dark, or several, evenly spaced. Areas that are smaller across
    than `least_mm` have none, and where several would run side by side, one does."""
    from contourpy import contour_generator

    pixel_mm = picture.pixel_mm
    grey = blurred(picture.darkness, max(_STEPS_PX, _BLUR * least_mm / pixel_mm))
    rows, columns = grey.shape
    generator = contour_generator(np.arange(columns) - 0.5, np.arange(rows) - 0.5, grey)
    at = [threshold(picture.darkness)] if levels == 1 else ((np.arange(levels) + 1.0) / (levels + 1.0)).tolist()
    found: list[FloatArray] = []
    for level in at:
        moved = [np.asarray(ring) @ picture.to_mm[:, :2].T + picture.to_mm[:, 2] for ring in generator.lines(level)]
        rings = [ring for ring in moved if len(ring) > 3 and _area(ring) >= np.pi / 4.0 * least_mm**2]
        rings = simplified(rings, min(_OFF_PX * pixel_mm, _OFF * least_mm))
        found += _beside(rings, found, least_mm)
    return found


def _beside(rings: list[FloatArray], others: list[FloatArray], least_mm: float) -> list[FloatArray]:
    """What of rings is further than `least_mm` from other lines, and not itself as short."""
    if not rings or not others:
        return rings
    near = shapely.buffer(shapely.multilinestrings([shapely.LineString(line) for line in others]), least_mm)
    shapely.prepare(near)
    found = []
    for ring in rings:
        line = shapely.LineString(ring)
        parts = [line] if near.disjoint(line) else shapely.get_parts(shapely.line_merge(line.difference(near)))
        found += [np.asarray(part.coords) for part in parts if part.length > _SHORT * least_mm]
    return found


def _area(ring: FloatArray) -> float:
    x, y = (ring - ring[0]).T
    return float(abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2.0)
