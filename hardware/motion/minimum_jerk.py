"""From rest to rest by the polynomial of least jerk (Flash and Hogan, 1985): s(u) = 10u^3 - 15u^4 + 6u^5."""

from __future__ import annotations

import math

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray

_PEAKS = (15 / 8, 10 / math.sqrt(3), 60.0)
"""Of the first three derivatives of s, for u from 0 to 1."""


def minimum_jerk(n: int) -> FloatArray:
    """(n, 1) progress at n set points evenly spaced in time, the start left out: the last is 1."""
    u = np.arange(1, n + 1)[:, None] / n
    progress: FloatArray = 10 * u**3 - 15 * u**4 + 6 * u**5
    return progress


def least_duration_s(arm: Arm, distance: FloatArray) -> float:
    """The shortest time in which all joints can go `distance` (n_joints,), rad or mm, within their limits."""
    velocity, acceleration, jerk = _PEAKS
    return float(
        np.max(
            (
                velocity * distance / arm.max_velocity,
                np.sqrt(acceleration * distance / arm.max_acceleration),
                np.cbrt(jerk * distance / arm.max_jerk),
            )
        )
    )
