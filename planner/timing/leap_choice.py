"""How high a hop goes, and how it shares the joints' limits between height and place.

The pen may move over the paper only while it is above the clearance, so a hop lasts as long as the way up to the
clearance, the stay above it, and the way down from it. A higher top passes the clearance sooner but stays above
it longer; a larger share for the height leaves less for the move over the paper. Both are chosen by formulas of
jerk-limited motion that leave acceleration limits of the height out: they only rank, the motions themselves are
made afterwards and kept within all limits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.timing.limits import Limits

_LOWEST_TOP = 1.15
"""Lowest travel height, in clearances: the highest sample of a hop must still be above the clearance."""
_SHARES = np.linspace(0.25, 1.0, 16)
_N_TOPS = 24
_DEPTH_ROUNDS = 6
_LEAST_REST = 1e-3
"""Share of its limits that a joint keeps for the move over the paper at least, lest that take for ever."""
_NEVER_STEEP = 1e-9
_TURN = 1.0 + np.sqrt(2.0)
"""Duration of braking against that of speeding up where both have the same jerk and braking ends in the turn."""
_TURN_HEIGHT = 1 / 6 + _TURN / 2 + _TURN ** 2 / 2 - _TURN ** 3 / 6
"""Height of such a rise in units of jerk times the cube of the time of speeding up."""


@dataclass(frozen=True, eq=False, slots=True)
class Slopes:
    """(n_hops, n_joints) largest |dq| per mm of height near both ends, and per unit of the way on the way."""

    lifting: FloatArray
    lowering: FloatArray
    along: FloatArray


def coordinate_limits(slope: FloatArray, limits: Limits) -> Limits:
    """Limits (...,) of a coordinate to which all joints move in proportion: `dq = slope * dx`, slope
    (..., n_joints)."""
    steep = np.maximum(slope, _NEVER_STEEP)
    return Limits(*((limit / steep).min(axis=-1) for limit in (limits.velocity, limits.acceleration, limits.jerk)))


def rest_of(slopes: Slopes, limits: Limits, share: FloatArray) -> Limits:
    """What a height that takes a share (n_hops,) of acceleration and jerk leaves of them, (n_hops, n_joints)."""
    rest = []
    for order in ("acceleration", "jerk"):
        limit = getattr(limits, order)
        taken = np.maximum(*(slope * getattr(coordinate_limits(slope, limits), order)[:, None]
                             for slope in (slopes.lifting, slopes.lowering)))
        rest.append(np.maximum(limit - share[:, None] * taken, _LEAST_REST * limit))
    return Limits(np.broadcast_to(limits.velocity, rest[0].shape), *rest)


def shares_and_tops(slopes: Slopes, limits: Limits, clearance_mm: float, lift_mm: float, lowering_mm_s: float
                    ) -> tuple[FloatArray, FloatArray]:
    """(n_hops,) share of the limits for the height, and travel height in mm, of the hops that end soonest."""
    tops = np.geomspace(min(_LOWEST_TOP * clearance_mm, lift_mm), lift_mm, _N_TOPS)
    up_jerk, down_jerk = (coordinate_limits(slope, limits).jerk for slope in (slopes.lifting, slopes.lowering))
    best_s = np.full(len(up_jerk), np.inf)
    share, top = np.ones(len(up_jerk)), np.full(len(up_jerk), lift_mm)
    for tried in _SHARES.tolist():
        left = rest_of(slopes, limits, np.full(len(up_jerk), tried))
        over = rest_to_rest_s(coordinate_limits(slopes.along, left))[:, None]
        up_s, above_up_s = _rise_s(tops, clearance_mm, tried * up_jerk[:, None], np.inf)
        down_s, above_down_s = _rise_s(tops, clearance_mm, tried * down_jerk[:, None], lowering_mm_s)
        whole_s = up_s + down_s + np.maximum(over, above_up_s + above_down_s)
        at = whole_s.argmin(axis=1)
        found_s = whole_s[np.arange(len(at)), at]
        better = found_s < best_s
        best_s[better], share[better], top[better] = found_s[better], tried, tops[at][better]
    return share, top


def rest_to_rest_s(limits: Limits) -> FloatArray:
    """(...,) duration of the fastest move by 1 from rest to rest within velocity, acceleration and jerk limits."""
    v, a, j = limits.velocity, limits.acceleration, limits.jerk
    a = np.minimum(a, np.sqrt(v * j))  # beyond that the speed is reached before the acceleration
    speed_up = v / a + a / j
    jerk_alone = np.cbrt(32.0 / j)
    with_acceleration = a / j + np.sqrt((a / j) ** 2 + 4.0 / a)
    slow = np.where(2 * a ** 3 / j ** 2 >= 1.0, jerk_alone, with_acceleration)
    duration: FloatArray = np.where(v * speed_up <= 1.0, speed_up + 1.0 / v, slow)
    return duration


def _rise_s(tops: FloatArray, clearance_mm: float, jerk: FloatArray, speed: float) -> tuple[FloatArray, FloatArray]:
    """Times below and above the clearance, of a rise from rest that turns at the top still braking."""
    ramp = np.cbrt(tops / (_TURN_HEIGHT * jerk))
    turning = turning_acceleration(tops, jerk, speed)
    sunk_s = turning / jerk
    # Backwards from the top, the pen is turning r^2 / 2 - jerk r^3 / 6 lower after r, and fastest after `sunk_s`.
    depth = np.maximum(tops - clearance_mm, 0.0)
    above = np.sqrt(2 * depth / turning)
    for _ in range(_DEPTH_ROUNDS):
        above = np.sqrt(depth / (turning / 2 - jerk * np.minimum(above, _TURN / np.sqrt(2.0) * sunk_s) / 6))
    whole = (1.0 + _TURN) * ramp
    if np.isfinite(speed):
        capped = jerk * ramp ** 2 > speed
        slow_ramp, sunk_mm = np.sqrt(speed / jerk), turning ** 3 / (3 * jerk ** 2)
        cruise = (tops - speed * slow_ramp - sunk_mm) / speed
        whole = np.where(capped, 2 * slow_ramp + cruise + sunk_s, whole)
        above = np.where(capped & (depth > sunk_mm), sunk_s + (depth - sunk_mm) / speed, above)
    above = np.minimum(above, whole)
    return whole - above, above


def turning_acceleration(top_mm: FloatArray, jerk: FloatArray, speed: float) -> FloatArray:
    """(...,) braking that is left where a rise to `top_mm` turns, jerk and speed being the only limits."""
    uncapped = np.sqrt(2.0) * jerk * np.cbrt(top_mm / (_TURN_HEIGHT * jerk))
    turning: FloatArray = np.minimum(uncapped, np.sqrt(2 * jerk * speed))
    return turning
