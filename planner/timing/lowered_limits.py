"""Jerk limits lowered at a point by what the jerk exceeds them by between that point and the next."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.timing.discrete_problem import CellMotion
from planner.timing.timing_problem import FRACTIONS

_LOWERED_BY = 1.2
"""How much a jerk limit is lowered at a point for each unit that the jerk exceeds it by nearby: the more, the less is
left to be slowed down for afterwards."""
_KEPT_SLACK = 0.1
"""Share of a slack that lowering its limit leaves."""

_NEARBY = np.vander(np.add.outer(FRACTIONS[:-1], [1 / 16, 1 / 8, 3 / 16]).ravel(), len(FRACTIONS)) @ np.linalg.inv(
    np.vander(FRACTIONS, len(FRACTIONS))
)
"""(12, 5) values at quarters of the way from each of the points to the next, from those at the points."""


def lowered_limits(motion: CellMotion, before: FloatArray) -> FloatArray:
    """(5, n_joints, cells) share of each jerk limit that is allowed at a point: less by what the jerk nearby exceeds
    the jerk there, the more so the closer that is to the limit, and as far as slack is left. before: the shares so far.
    """
    size = motion.jerk_per_rate * np.sqrt(motion.b)[:, None]
    nearby = np.abs(_NEARBY @ size.reshape(len(FRACTIONS), -1)).reshape(-1, *size.shape[1:])
    np.abs(size, out=size)
    peak = size.copy()
    for side, furthest in ((peak[:-1], 0), (peak[1:], 2)):
        np.maximum(side, nearby[furthest::3], out=side)
        np.maximum(side, nearby[1::3], out=side)
    shares = peak**2
    shares *= shares
    shares *= size - peak
    shares *= _LOWERED_BY
    shares += 1.0
    return np.maximum(shares, size + np.maximum(_KEPT_SLACK * (before - size), 1e-9))
