"""Stop in the middle of a drawing: brake along the planned path, then take the pen straight up; and go on.

Braking along the path leaves no ink where none was planned, and lifting from rest keeps the two motions
apart, so that each can be held within the arm's limits. Both ends of a stop are at samples of the path, so
that what follows is played from the very samples that were planned.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hardware.motion.minimum_jerk import minimum_jerk
from hardware.motion.tip import tip_at
from hardware.motion.vertical_lift import vertical_lift
from planner.arms.arm import Arm
from planner.arrays import FloatArray

_RAMPS_S = (0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8)
_ALLOWANCE = 1.02
"""By how much a change of pace may seem to exceed a limit: what interpolation between samples adds."""
_MARGIN = 1.05
_LONGEST_LIFT_S = 1.0
"""No lift is slowed down beyond this: what asks for more is a bend where a joint runs into its limit."""
_LOWERED_SLOWER = 3
_LIFTED_MM = 0.01
_DEGREE = 6
"""Of the polynomial in height through the configurations of a lift, smooth at any rate."""


@dataclass(frozen=True, eq=False, slots=True)
class Ramp:
    """A change of pace along a path: set points (n, n_joints) and `at` (n,), the fractional indices that they have
    in the path; the last is that of a sample."""

    points: FloatArray
    at: FloatArray

    @property
    def end(self) -> int:
        """The sample of the path that the ramp ends in."""
        return round(float(self.at[-1]))


def brake(arm: Arm, path: FloatArray, sample: int, rate_hz: float) -> Ramp:
    """From full pace to rest along `path` (n_samples, n_joints), played at `rate_hz`; `sample` is the one sent last.

    The pace falls from 1 to 0 as 1 - 3u^2 + 2u^3; the shortest of a few durations that keeps velocities,
    accelerations and jerks within limits is taken, and the longest where the path itself is at its limits.
    """
    before = interpolate(path, sample + np.arange(-3.0, 1.0))
    for n in _even_lengths(rate_hz):
        u = np.arange(1, n + 1) / n
        ramp = _along(arm, path, sample + n * (u - u**3 + u**4 / 2))
        if slow_down(arm, np.concatenate((before, ramp.points)), 1 / rate_hz) <= _ALLOWANCE:
            break
    return ramp


def set_off(arm: Arm, path: FloatArray, sample: int, rate_hz: float) -> Ramp:
    """From rest at `sample` to full pace along `path`: braking, seen backwards in time."""
    rest = path[sample][None]
    for n in _even_lengths(rate_hz):
        u = np.arange(1, n + 1) / n
        ramp = _along(arm, path, sample + n * (u**3 - u**4 / 2))
        after = interpolate(path, sample + n / 2 + np.arange(1.0, 5.0))
        if slow_down(arm, np.concatenate((rest, ramp.points, after))[::-1], 1 / rate_hz) <= _ALLOWANCE:
            break
    return ramp


def _even_lengths(rate_hz: float) -> Iterator[int]:
    """How many set points a ramp may have: even numbers, for on average a ramp goes at half the pace."""
    return (2 * math.ceil(duration_s * rate_hz / 2) for duration_s in _RAMPS_S)


def _along(arm: Arm, path: FloatArray, at: FloatArray) -> Ramp:
    at = np.clip(at, 0.0, len(path) - 1.0)
    return Ramp(np.clip(interpolate(path, at), arm.minimum, arm.maximum), at)


def lift(arm: Arm, start: FloatArray, rate_hz: float, to_mm: float | None = None) -> FloatArray:
    """Set points (n, n_joints) at `rate_hz` from rest at `start` straight up to rest at the height `to_mm` of the tip,
    the arm's lift height if None.

    The height follows `minimum_jerk`, slowed down until the joints are within their limits (for a
    second at most). Empty where the pen is up already, and where the arm cannot rise.
    """
    height_mm = (arm.pen.lift_mm if to_mm is None else to_mm) - float(tip_at(arm, start).position_mm[2])
    configurations = vertical_lift(arm, start, height_mm) if height_mm > _LIFTED_MM else start[None]
    if len(configurations) < 2:
        return np.empty((0, arm.n_joints))

    height = np.linspace(0, 1, len(configurations))[:, None]
    powers = np.arange(1, min(_DEGREE, len(configurations) - 1) + 1)
    coefficients = np.linalg.lstsq(height**powers, configurations - start, rcond=None)[0]

    def at(n: int) -> FloatArray:
        points: FloatArray = start + minimum_jerk(n) ** powers @ coefficients
        return points

    n, points, rest = 2, at(2), np.repeat(start[None], 3, axis=0)
    while n < _LONGEST_LIFT_S * rate_hz and (slower := slow_down(arm, np.concatenate((rest, points)), 1 / rate_hz)) > 1:
        n = math.ceil(n * max(slower, _MARGIN))
        points = at(n)
    return np.clip(points, arm.minimum, arm.maximum)


def lower(arm: Arm, goal: FloatArray, rate_hz: float) -> FloatArray:
    """Set points (n, n_joints) straight down to `goal`, at a third of the pace of the lift that they undo; the first
    is where the lift ends."""
    points: FloatArray = np.concatenate((goal[None], lift(arm, goal, rate_hz * _LOWERED_SLOWER)))[::-1]
    return points


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
        -x * (x - 1) * (x - 2) / 6 * p0
        + (x + 1) * (x - 1) * (x - 2) / 2 * p1
        - (x + 1) * x * (x - 2) / 2 * p2
        + (x + 1) * x * (x - 1) / 6 * p3
    )
    return values
