"""How like what was to be drawn is what was drawn: distances from each to the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.checking.polyline import DenseLines, dense_lines, joined_lines

_SPACING_MM = 0.05
_MOST_POINTS = 1_000_000


@dataclass(frozen=True, slots=True)
class DrawingErrors:
    """Distance in mm, both ways, of points evenly spaced along what was drawn and along what was wanted: root mean
    square, what 95 of 100 stay within, and the largest."""

    rms_mm: float
    most_mm: float
    largest_mm: float

    def text(self) -> str:
        if not np.isfinite(self.rms_mm):
            return "nothing: the pen left no ink where ink was wanted"
        return (
            f"off by {self.rms_mm:.3f} mm rms, {self.most_mm:.3f} mm for 95 %, {self.largest_mm:.3f} mm at the largest"
        )


def drawing_error(drawn: Sequence[FloatArray], wanted: Sequence[FloatArray]) -> DrawingErrors:
    """Compare two lists of lines (n, 2) in mm; infinitely unlike where one of them is empty."""
    if not drawn or not wanted:
        return DrawingErrors(np.inf, np.inf, np.inf)
    a, b = _sampled(drawn), _sampled(wanted)
    distance_mm = np.concatenate((a.distance_mm(b.points_mm), b.distance_mm(a.points_mm)))
    return DrawingErrors(
        float(np.sqrt(np.mean(distance_mm**2))), float(np.percentile(distance_mm, 95)), float(distance_mm.max())
    )


def _sampled(lines: Sequence[FloatArray]) -> DenseLines:
    """Points evenly spaced along the lines."""
    length_mm = sum(float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()) for line in lines)
    return dense_lines(*joined_lines(lines), max(_SPACING_MM, length_mm / _MOST_POINTS))
