"""What it costs the lifted pen to get from one place to another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray

Embedding = Callable[[FloatArray], FloatArray]
"""From points (n, 2) to vectors (n, k)."""


@dataclass(frozen=True, eq=False, slots=True)
class Metric:
    """The cost of travelling between two points: the distance of their images under `embed`, raised to an exponent.

    exponent: 1 for lengths; 1/3 for the times of jerk-limited moves, among which one long move is sooner done than
    several short ones.
    """

    embed: Embedding
    exponent: float = 1.0

    def distance(self, one: FloatArray, other: FloatArray) -> FloatArray:
        """Costs (n,) of the differences of embedded points (n, k)."""
        difference = np.abs(one - other)
        length: FloatArray = np.sqrt(np.sum(difference * difference, axis=-1))
        return length if self.exponent == 1.0 else length**self.exponent


def _unchanged(points: FloatArray) -> FloatArray:
    return points


STRAIGHT = Metric(_unchanged)
"""The length of the straight line."""
