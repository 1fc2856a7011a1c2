"""What is left of set points after the servos' lag: turning points that are passed quickly are never quite reached."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray


def lagged(told: FloatArray, lag_s: FloatArray, period_s: float) -> FloatArray:
    """First-order lag `y' = (u - y) / lag` of set points (n, n_joints), each held for a period; lag_s: (n_joints,)."""
    share = np.where(lag_s > 0, -np.expm1(-period_s / np.maximum(lag_s, 1e-9)), 1.0)
    followed = np.empty_like(told)
    now = told[0]
    for k, u in enumerate(told):
        now = now + share * (u - now)
        followed[k] = now
    return followed
