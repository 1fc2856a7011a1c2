"""Many sequences of different lengths laid end to end in one array, so that work on all of them is one
array operation."""

from __future__ import annotations

import numpy as np

from planner.arrays import IntArray


def starts_of(counts: IntArray) -> IntArray:
    """(n + 1,) where each sequence begins in the joined array; the last entry is the total."""
    starts: IntArray = np.concatenate(([0], np.cumsum(counts)))
    return starts


def within(counts: IntArray) -> IntArray:
    """(total,) position of each element within its own sequence: 0 1 2 0 1 0 1 2 3 ..."""
    starts = starts_of(counts)
    positions: IntArray = np.arange(starts[-1]) - np.repeat(starts[:-1], counts)
    return positions
