"""The outlines of dark areas."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.image.seen import SeenPicture
from planner.drawing.image.threshold import blurred, threshold
from planner.drawing.path_work import simplified, without_doubles

_STEPS_PX = 0.7
"""The blur that takes the steps off edges of plain black and white."""
_BLUR = 0.25
"""Of the finest detail."""
_OFF_PX, _OFF = 0.25, 0.125
"""How far points may be left out for: of a pixel, and of the finest detail."""


def traced(picture: SeenPicture, levels: int, least_mm: float) -> list[FloatArray]:
    """Closed lines (n, 2), mm. levels: one for what is dark, or several, evenly spaced. Areas that are smaller across
    than `least_mm` have none, and where several would run side by side, one does."""
    from contourpy import contour_generator

    pixel_mm = picture.pixel_mm
    grey = blurred(picture.darkness, max(_STEPS_PX, _BLUR * least_mm / pixel_mm))
    rows, columns = grey.shape
    generator = contour_generator(np.arange(columns) - 0.5, np.arange(rows) - 0.5, grey)
    at = [threshold(picture.darkness)] if levels == 1 else ((np.arange(levels) + 1.0) / (levels + 1.0)).tolist()
    rings: list[FloatArray] = []
    for level in at:
        for line in generator.lines(level):
            ring: FloatArray = np.asarray(line) @ picture.to_mm[:, :2].T + picture.to_mm[:, 2]
            if len(ring) > 3 and _area(ring) >= np.pi / 4.0 * least_mm**2:
                rings.append(ring)
    rings = simplified(rings, min(_OFF_PX * pixel_mm, _OFF * least_mm))
    return without_doubles(rings, least_mm)[0] if levels > 1 and rings else rings


def _area(ring: FloatArray) -> float:
    x, y = (ring - ring[0]).T
    return float(abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2.0)
