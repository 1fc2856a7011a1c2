"""Sets of 300 strokes that the order is measured on, here and in benchmarks/tours.py."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.metric import STRAIGHT, Metric

ORIGIN = np.zeros(2)
_COUNT = 300
METRICS = {"length": STRAIGHT, "time": Metric(lambda points: points, exponent=1 / 3)}
"""The way itself, and the time of jerk-limited moves along it."""


def _short() -> list[FloatArray]:
    """Short strokes all over a page of 200 x 140 mm."""
    random = np.random.default_rng(11)
    begin = random.uniform([0.0, 0.0], [200.0, 140.0], (_COUNT, 2))
    return list(np.stack((begin, begin + random.normal(0.0, 4.0, (_COUNT, 2))), axis=1))


def _long() -> list[FloatArray]:
    """Lines from anywhere to anywhere."""
    return list(np.random.default_rng(12).uniform([0.0, 0.0], [200.0, 140.0], (_COUNT, 2, 2)))


def _clustered() -> list[FloatArray]:
    """Fifteen heaps of strokes with empty paper between."""
    random = np.random.default_rng(13)
    heaps = np.repeat(random.uniform([0.0, 0.0], [200.0, 140.0], (15, 2)), _COUNT // 15, axis=0)
    begin = heaps + random.normal(0.0, 5.0, (_COUNT, 2))
    return list(np.stack((begin, begin + random.normal(0.0, 3.0, (_COUNT, 2))), axis=1))


STROKE_SETS = {"short": _short(), "long": _long(), "clustered": _clustered()}
