"""The map from set points of a run to samples of its trajectory, in pauses and ramps as well.

The map is a list of pieces, each a polyline through knots (set points sent, sample). A piece holds from its first knot
on and replaces what earlier pieces say from there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.trajectory import TRAVELLING

Piece = Sequence[tuple[int, float]]

_ON_THE_LINE = 1e-6
_DECIMALS = 4
_ROUNDING = 1e-3
"""More than the decimals leave: a sample that was reached counts as reached."""


def piece(first: int, samples: FloatArray) -> list[tuple[int, float]]:
    """The knots where set points from number `first` (counted from 1) on are at `samples` (n,), n at least 1."""
    bends = np.abs(np.diff(samples, 2)) > _ON_THE_LINE
    knots = np.flatnonzero(np.concatenate(([True], bends, [True]))[: len(samples)])
    return [(first + int(knot), round(float(samples[knot]), _DECIMALS)) for knot in knots]


def sample_after(pieces: Sequence[Piece], reached: int) -> float | None:
    """The sample after `reached` set points, None where no piece covers it."""
    for one in reversed(pieces):
        if one[0][0] <= max(reached, 1):  # before its first set point the arm is where that one is
            counts, samples = zip(*one, strict=True)
            return float(np.interp(reached, counts, samples))
    return None


def next_to_draw(stroke: IntArray, sample: float) -> tuple[int, int | None]:
    """What is left of a drawing whose samples have these `stroke` labels when the arm has come to `sample`: the stroke
    to go on with, and the sample in its midst to go on from, None for its beginning."""
    here = int(np.clip(sample + _ROUNDING, 0, len(stroke) - 1))
    if stroke[here] != TRAVELLING and (stroke[here + 1 : here + 2] == stroke[here]).any():
        begun = here > 0 and stroke[here - 1] == stroke[here]
        return int(stroke[here]), here if begun else None
    later = stroke[here + 1 :][stroke[here + 1 :] != TRAVELLING]
    return (int(later[0]) if len(later) else int(stroke.max()) + 1), None
