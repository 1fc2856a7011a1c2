"""How high a hop goes, and how it shares the joints' limits between height and place.

The pen may move over the paper only while it is above the clearance, so a hop lasts as long as the way up to the
clearance, the stay above it, and the way down from it. A rise that aims higher passes the clearance sooner but stays
above it longer; a larger share for the height leaves less for the move over the paper. Both are chosen by formulas of
jerk-limited motion that leave acceleration limits of the height out: they only rank, the motions themselves are
made afterwards and kept within all limits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.timing.limits import Limits

_LOWEST_AIM, _HIGHEST_AIM = 1.02, 1.94
"""Heights that the rise to the clearance may aim at, in clearances: the highest sample of a hop must still be above
the clearance, and the pen must brake already where it passes it."""
RESTING_SHARE = 0.6
"""Share of the limits for the height of a hop that is at rest at the lift height."""
_SHARES = np.linspace(0.1, 1.0, 19)
_N_AIMS = 12
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


def shares_and_aims(slopes: Slopes, limits: Limits, clearance_mm: float, lift_mm: float, lowering_mm_s: float
                    ) -> tuple[FloatArray, FloatArray]:
    """Of the hops that end soonest: (n_hops,) share of the limits for the height while the pen is above the
    clearance, and the height in mm that the rise to the clearance aims at, NaN where the lift height leaves no room.

    The way down passes the clearance with no acceleration left (`fall_aim`): what the rise has in excess of the height
    that leads up to that is then come down at the lowering speed.
    """
    aims = np.linspace(_LOWEST_AIM, _HIGHEST_AIM, _N_AIMS) * clearance_mm
    up_jerk, down_jerk = (coordinate_limits(slope, limits).jerk[:, None] for slope in (slopes.lifting, slopes.lowering))
    below_up_s, up_speed, up_acceleration = _rise(aims, clearance_mm, up_jerk, np.inf)
    below_down_s, down_speed, down_acceleration = _rise(aims[-1:], clearance_mm, down_jerk, lowering_mm_s)
    n_hops = len(up_jerk)
    best_s = np.full(n_hops, np.inf)
    share, aim = np.full(n_hops, RESTING_SHARE), np.full(n_hops, np.nan)
    for tried in _SHARES.tolist():
        over_s = rest_to_rest_s(coordinate_limits(slopes.along, rest_of(slopes, limits, np.full(n_hops, tried))))
        up_s, up_mm = _brake(up_speed, up_acceleration, tried * up_jerk)
        down_s, down_mm = _brake(down_speed, down_acceleration, tried * down_jerk)
        excess_mm = up_mm - down_mm
        above_s = up_s + down_s + excess_mm / lowering_mm_s
        whole_s = below_up_s + below_down_s + np.maximum(over_s[:, None], above_s)
        whole_s[(excess_mm < 0.0) | (clearance_mm + up_mm > lift_mm)] = np.inf
        at = whole_s.argmin(axis=1)
        found_s = whole_s[np.arange(n_hops), at]
        better = found_s < best_s
        best_s[better], share[better], aim[better] = found_s[better], tried, aims[at][better]
    return share, aim


def fall_aim(clearance_mm: float) -> float:
    """The height in mm that the rise aims at which, backwards, is the way down from the clearance."""
    return _HIGHEST_AIM * clearance_mm


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


def _rise(tops: FloatArray, clearance_mm: float, jerk: FloatArray, speed: float
          ) -> tuple[FloatArray, FloatArray, FloatArray]:
    """When a rise from rest that turns at the top, still braking, passes the clearance; velocity, acceleration there.
    """
    ramp = np.cbrt(tops / (_TURN_HEIGHT * jerk))
    turning = turning_acceleration(tops, jerk, speed)
    # Backwards from the top, the pen is turning r^2 / 2 - jerk r^3 / 6 lower after r, and fastest after `sunk_s`.
    sunk_s, depth = turning / jerk, tops - clearance_mm
    above = np.sqrt(2 * depth / turning)
    for _ in range(_DEPTH_ROUNDS):
        above = np.sqrt(depth / (turning / 2 - jerk * np.minimum(above, sunk_s) / 6))
    whole = (1.0 + _TURN) * ramp
    if np.isfinite(speed):
        capped = jerk * ramp ** 2 > speed
        slow_ramp, sunk_mm = np.sqrt(speed / jerk), turning ** 3 / (3 * jerk ** 2)
        whole = np.where(capped, 2 * slow_ramp + (tops - speed * slow_ramp - sunk_mm) / speed + sunk_s, whole)
        above = np.where(capped & (depth > sunk_mm), sunk_s + (depth - sunk_mm) / speed, above)
    braked = np.minimum(above, sunk_s)
    return whole - above, turning * braked - jerk * braked ** 2 / 2, jerk * braked - turning


def _brake(velocity: FloatArray, acceleration: FloatArray, jerk: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Time and height until a velocity is braked to nothing, from an acceleration that is not positive."""
    time = (acceleration + np.sqrt(acceleration ** 2 + 2 * jerk * velocity)) / jerk
    return time, time * (velocity + time * (acceleration / 2 - jerk * time / 6))


def turning_acceleration(top_mm: FloatArray, jerk: FloatArray, speed: float) -> FloatArray:
    """(...,) braking that is left where a rise to `top_mm` turns, jerk and speed being the only limits."""
    uncapped = np.sqrt(2.0) * jerk * np.cbrt(top_mm / (_TURN_HEIGHT * jerk))
    turning: FloatArray = np.minimum(uncapped, np.sqrt(2 * jerk * speed))
    return turning
