"""Stopping in the middle of a drawing: brake along the planned path, then take the pen straight up.

Braking along the path leaves no ink where none was planned, and lifting from rest keeps the two motions
apart, so that each can be held within the arm's limits.
"""

from __future__ import annotations

import math

import numpy as np

from hardware.tip import tip_at
from hardware.vertical_lift import vertical_lift
from planner.arms.arm import Arm
from planner.arrays import FloatArray

_BRAKING_S = (0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8)
_ALLOWANCE = 1.02
"""By how much a braking sequence may seem to exceed a limit: what interpolation between samples adds."""
_MARGIN = 1.05
_LONGEST_LIFT_S = 1.0
"""No lift is slowed down beyond this: what asks for more is a bend where a joint runs into its limit."""
_LIFTED_MM = 0.01
_DEGREE = 6
"""Of the polynomial in height through the postures of a lift, smooth at any rate."""


def brake(arm: Arm, path: FloatArray, sample: int, rate_hz: float, refine: int) -> FloatArray:
    """Set points (n, n_joints), `refine` for each sample period, that come to rest along `path`.

    path: (n_samples, n_joints) as being played at `rate_hz`; `sample`: the one sent last. The pace along the
    path falls from 1 to 0 as 1 - 3u^2 + 2u^3; the shortest of a few durations that keeps velocities,
    accelerations and jerks within limits is taken, and the longest where the path itself is at its limits.
    """
    period_s = 1.0 / (rate_hz * refine)
    before = sample + np.arange(-3, 1) / refine
    points = np.empty((0, arm.n_joints))
    for duration_s in _BRAKING_S:
        n = math.ceil(duration_s / period_s)
        u = np.arange(1, n + 1) / n
        points = interpolate(path, sample + (u - u**3 + u**4 / 2) * n / refine)
        if slow_down(arm, np.concatenate((interpolate(path, before), points)), period_s) <= _ALLOWANCE:
            break
    return np.clip(points, arm.minimum, arm.maximum)


def lift(arm: Arm, start: FloatArray, rate_hz: float) -> FloatArray:
    """Set points (n, n_joints) at `rate_hz` from rest at `start` straight up to the arm's lift height, and to rest.

    The height follows 10u^3 - 15u^4 + 6u^5, slowed down until the joints are within their limits (for a
    second at most). Empty where the pen is up already, and where the arm cannot rise.
    """
    height_mm = arm.pen.lift_mm - float(tip_at(arm, start).position_mm[2])
    postures = vertical_lift(arm, start, height_mm) if height_mm > _LIFTED_MM else start[None]
    if len(postures) < 2:
        return np.empty((0, arm.n_joints))

    height = np.linspace(0, 1, len(postures))[:, None]
    powers = np.arange(1, min(_DEGREE, len(postures) - 1) + 1)
    coefficients = np.linalg.lstsq(height**powers, postures - start, rcond=None)[0]

    def at(n: int) -> FloatArray:
        u = np.arange(1, n + 1)[:, None] / n
        points: FloatArray = start + (10 * u**3 - 15 * u**4 + 6 * u**5) ** powers @ coefficients
        return points

    n, points, rest = 2, at(2), np.repeat(start[None], 3, axis=0)
    while (n < _LONGEST_LIFT_S * rate_hz
           and (slower := slow_down(arm, np.concatenate((rest, points)), 1 / rate_hz)) > 1):
        n = math.ceil(n * max(slower, _MARGIN))
        points = at(n)
    return np.clip(points, arm.minimum, arm.maximum)


def slow_down(arm: Arm, points: FloatArray, period_s: float) -> float:
    """How many times slower `points` (n, n_joints), `period_s` apart and at rest after the last, would have to be
    played for the joints' average velocities, accelerations and jerks between samples to meet the limits;
    at most 1 where they do."""
    worst = 0.0
    change = np.concatenate((points, np.repeat(points[-1:], 3, axis=0)))
    for order, limit in enumerate((arm.max_velocity, arm.max_acceleration, arm.max_jerk), start=1):
        change = np.diff(change, axis=0) / period_s
        if len(change):
            worst = max(worst, float(np.max(np.abs(change) / limit)) ** (1 / order))
    return worst


def interpolate(samples: FloatArray, at: FloatArray) -> FloatArray:
    """(m, n_joints) values at fractional indices `at` (m,) of `samples` (n, n_joints): the cubic through the
    four samples around, which constant jerk follows exactly. Before the first and after the last it rests."""
    last = len(samples) - 1
    at = np.clip(at, 0.0, last)
    below = np.floor(at).astype(np.int64)
    x = (at - below)[:, None]
    p0, p1, p2, p3 = (samples[np.clip(below + shift, 0, last)] for shift in (-1, 0, 1, 2))
    values: FloatArray = (
        -x * (x - 1) * (x - 2) / 6 * p0 + (x + 1) * (x - 1) * (x - 2) / 2 * p1
        - (x + 1) * x * (x - 2) / 2 * p2 + (x + 1) * x * (x - 1) / 6 * p3)
    return values
