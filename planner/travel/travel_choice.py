"""How high a travel move goes, and how it shares the joints' limits between height and place.

The pen may move over the paper only while it is above the clearance. At some height, the clearance or above it, the
height hands over to the move: below it has all of the joints' limits, above it a share of them. A travel move so lasts
as long as the way up to the handover, the stay above it, and the way down from it. A rise that aims higher passes the
handover sooner but stays above it longer; a larger share for the height leaves less for the move. All are chosen by
formulas of jerk-limited motion that leave acceleration limits of the height out: they only rank, the motions themselves
are made afterwards and kept within all limits.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.kinematics.limits import Limits

_AIMS = 1.02, 1.94
"""Heights that the rise to the handover may aim at, in heights of the handover: the highest sample of a travel move
must still be above it, and the pen must brake already where it passes it."""
_N_RISES, _N_FALLS = 10, 5
_HANDOVERS_MM, _N_HANDOVERS = 2.0 ** np.arange(-10, 10, 0.5), 7
_SPEEDS_MM_S, _N_SPEEDS = 30.0 * 2.0 ** np.arange(6, -12, -0.5), 3
"""Heights at which to hand over and speeds of lowering that are tried, and how many beside those that rules give."""
_CAPS_MM_S = 30.0 * 2.0 ** np.arange(0.0, 4.0)
"""Caps on the speed of lowering under which what is quickest is a candidate under any laxer one, too: it may be made
where what formulas find quicker may not."""
RESTING_SHARE = 0.6
"""Share of the limits for the height of a travel move that is at rest at the lift height."""
_SHARES = np.linspace(0.1, 1.0, 13)
_DEPTH_ROUNDS = 6
_LEAST_REST = 1e-3
"""Share of its limits that a joint keeps for the move over the paper at least, lest that take for ever."""
_NEVER_STEEP = 1e-9
_TURN = 1.0 + np.sqrt(2.0)
"""Duration of braking against that of speeding up where both have the same jerk and braking ends in the turn."""
_TURN_HEIGHT = 1 / 6 + _TURN / 2 + _TURN**2 / 2 - _TURN**3 / 6
"""Height of such a rise in units of jerk times the cube of the time of speeding up."""


@dataclass(frozen=True, eq=False, slots=True)
class Slopes:
    """(n_travel_moves, n_joints) largest |dq| per mm of height near both ends, and per unit of the way on the way."""

    lifting: FloatArray
    lowering: FloatArray
    along: FloatArray

    def subset(self, moves: IntArray) -> Slopes:
        return Slopes(self.lifting[moves], self.lowering[moves], self.along[moves])


def coordinate_limits(slope: FloatArray, limits: Limits) -> Limits:
    """Limits (...,) of a coordinate to which all joints move in proportion: `dq = slope * dx`, slope
    (..., n_joints)."""
    steep = np.maximum(slope, _NEVER_STEEP)
    return Limits(*((limit / steep).min(axis=-1) for limit in (limits.velocity, limits.acceleration, limits.jerk)))


def rest_of(slopes: Slopes, limits: Limits, share: FloatArray) -> Limits:
    """What a height that takes a share (n_travel_moves,) of acceleration and jerk leaves of them, (n_travel_moves,
    n_joints)."""
    rest = []
    for order in ("acceleration", "jerk"):
        limit = getattr(limits, order)
        taken = np.maximum(
            *(
                slope * getattr(coordinate_limits(slope, limits), order)[:, None]
                for slope in (slopes.lifting, slopes.lowering)
            )
        )
        rest.append(np.maximum(limit - share[:, None] * taken, _LEAST_REST * limit))
    return Limits(np.broadcast_to(limits.velocity, rest[0].shape), *rest)


@dataclass(frozen=True, eq=False, slots=True)
class Candidates:
    """Ways to make each travel move, all (n_travel_moves, n_candidates): the share of the limits that the height has
    above the handover, the height of the handover, those that the rise and the fall (backwards, as a rise) aim at, in
    mm, and the speeds in mm/s that the fall keeps below, and all of the way down. seconds: what the formulas make of
    it, inf where there is no such way."""

    share: FloatArray
    handover_mm: FloatArray
    rise_mm: FloatArray
    fall_mm: FloatArray
    fall_mm_s: FloatArray
    cap_mm_s: FloatArray
    seconds: FloatArray


def quickest_candidates(
    slopes: Slopes, limits: Limits, clearance_mm: float, lift_mm: float, lowering_mm_s: float
) -> Candidates:
    """The quickest ways to make each travel move, one for each of some handovers and shares, the quickest first.

    The heights, and the speeds below the cap at which the pen may come down, are the same whatever the clearance and
    the cap, which only say where the lists end: what a stricter rule allows is tried under a laxer one, too.
    """
    caps = [lowering_mm_s, *_CAPS_MM_S[lowering_mm_s * (1 - 1e-9) > _CAPS_MM_S].tolist()]
    higher = _HANDOVERS_MM[clearance_mm * (1 + 1e-9) < _HANDOVERS_MM][:_N_HANDOVERS]
    made = [
        _quickest_from(
            slopes,
            limits,
            height,
            lift_mm,
            np.concatenate(([cap], _SPEEDS_MM_S[cap * (1 - 1e-9) > _SPEEDS_MM_S][:_N_SPEEDS])),
        )
        for cap in caps
        for height in (clearance_mm, *higher.tolist())
        if height < lift_mm
    ]
    none = np.empty((len(slopes.along), 0))
    columns = [
        np.concatenate([none, *(getattr(candidates, field.name) for candidates in made)], axis=1)
        for field in fields(Candidates)
    ]
    order = np.argsort(columns[-1], axis=1, kind="stable")
    return Candidates(*(np.take_along_axis(column, order, axis=1) for column in columns))


def _quickest_from(
    slopes: Slopes, limits: Limits, handover_mm: float, lift_mm: float, speeds_mm_s: FloatArray
) -> Candidates:
    """The quickest travel move for each share that hands over at that height. The fall passes it at any speed up to the
    first one: what the rise has in excess of the height that leads up to that is come down at this first one."""
    rises, falls = np.linspace(*_AIMS, _N_RISES) * handover_mm, np.linspace(*_AIMS, _N_FALLS) * handover_mm
    up_jerk, down_jerk = (coordinate_limits(slope, limits).jerk[:, None] for slope in (slopes.lifting, slopes.lowering))
    below_up_s, up_speed, up_acceleration = _rise(rises, handover_mm, up_jerk, np.inf)
    below_down_s, down_speed, down_acceleration = (
        np.concatenate(column, axis=1)
        for column in zip(*(_rise(falls, handover_mm, down_jerk, speed) for speed in speeds_mm_s.tolist()), strict=True)
    )
    n_travel_moves, cap = len(up_jerk), speeds_mm_s[0]
    seconds, at = np.empty((n_travel_moves, len(_SHARES))), np.empty((n_travel_moves, len(_SHARES)), dtype=np.int64)
    for column, share in enumerate(_SHARES.tolist()):
        over_s = rest_to_rest_s(
            coordinate_limits(slopes.along, rest_of(slopes, limits, np.full(n_travel_moves, share)))
        )
        up_s, up_mm = _brake(up_speed, up_acceleration, share * up_jerk)
        down_s, down_mm = _brake(down_speed, down_acceleration, share * down_jerk)
        excess_mm = up_mm[:, :, None] - down_mm[:, None]
        above_s = up_s[:, :, None] + down_s[:, None] + excess_mm / cap
        whole_s = below_up_s[:, :, None] + below_down_s[:, None] + np.maximum(over_s[:, None, None], above_s)
        whole_s[(excess_mm < 0.0) | (handover_mm + up_mm[:, :, None] > lift_mm)] = np.inf
        # Braking that so little jerk cannot end before the pen falls faster than it may.
        whole_s[up_speed - up_acceleration**2 / (2 * share * up_jerk) < -cap] = np.inf
        at[:, column] = whole_s.reshape(n_travel_moves, -1).argmin(axis=1)
        seconds[:, column] = np.take_along_axis(
            whole_s.reshape(n_travel_moves, -1), at[:, column : column + 1], axis=1
        )[:, 0]
    rise, fall = np.divmod(at, down_speed.shape[1])
    speed, aim = np.divmod(fall, len(falls))
    return Candidates(
        np.broadcast_to(_SHARES, at.shape),
        np.full(at.shape, handover_mm),
        rises[rise],
        falls[aim],
        speeds_mm_s[speed],
        np.full(at.shape, cap),
        seconds,
    )


def rest_to_rest_s(limits: Limits) -> FloatArray:
    """(...,) duration of the fastest move by 1 from rest to rest within velocity, acceleration and jerk limits."""
    v, a, j = limits.velocity, limits.acceleration, limits.jerk
    a = np.minimum(a, np.sqrt(v * j))  # beyond that the speed is reached before the acceleration
    speed_up = v / a + a / j
    jerk_alone = np.cbrt(32.0 / j)
    with_acceleration = a / j + np.sqrt((a / j) ** 2 + 4.0 / a)
    slow = np.where(2 * a**3 / j**2 >= 1.0, jerk_alone, with_acceleration)
    duration: FloatArray = np.where(v * speed_up <= 1.0, speed_up + 1.0 / v, slow)
    return duration


def _rise(
    tops: FloatArray, clearance_mm: float, jerk: FloatArray, speed: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """When a rise from rest that turns at the top, still braking, passes the clearance; velocity, acceleration
    there."""
    ramp = np.cbrt(tops / (_TURN_HEIGHT * jerk))
    turning = turning_acceleration(tops, jerk, speed)
    # Backwards from the top, the pen is turning r^2 / 2 - jerk r^3 / 6 lower after r, and fastest after `sunk_s`.
    sunk_s, depth = turning / jerk, tops - clearance_mm
    above = np.sqrt(2 * depth / turning)
    for _ in range(_DEPTH_ROUNDS):
        above = np.sqrt(depth / (turning / 2 - jerk * np.minimum(above, sunk_s) / 6))
    whole = (1.0 + _TURN) * ramp
    if np.isfinite(speed):
        capped = jerk * ramp**2 > speed
        slow_ramp, sunk_mm = np.sqrt(speed / jerk), turning**3 / (3 * jerk**2)
        whole = np.where(capped, 2 * slow_ramp + (tops - speed * slow_ramp - sunk_mm) / speed + sunk_s, whole)
        above = np.where(capped & (depth > sunk_mm), sunk_s + (depth - sunk_mm) / speed, above)
    braked = np.minimum(above, sunk_s)
    return whole - above, turning * braked - jerk * braked**2 / 2, jerk * braked - turning


def _brake(velocity: FloatArray, acceleration: FloatArray, jerk: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Time and height until a velocity is braked to nothing, from an acceleration that is not positive."""
    time = (acceleration + np.sqrt(acceleration**2 + 2 * jerk * velocity)) / jerk
    return time, time * (velocity + time * (acceleration / 2 - jerk * time / 6))


def turning_acceleration(top_mm: FloatArray, jerk: FloatArray, speed: float) -> FloatArray:
    """(...,) braking that is left where a rise to `top_mm` turns, jerk and speed being the only limits."""
    uncapped = np.sqrt(2.0) * jerk * np.cbrt(top_mm / (_TURN_HEIGHT * jerk))
    turning: FloatArray = np.minimum(uncapped, np.sqrt(2 * jerk * speed))
    return turning
