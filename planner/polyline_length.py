"""The length of a polyline."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray


def polyline_length(points: FloatArray) -> float:
    """Of the way through points (n, 2); 0 for a single one."""
    return float(np.hypot(*np.diff(points, axis=0).T).sum())
