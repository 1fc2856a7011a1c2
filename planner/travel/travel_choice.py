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
_ROWS_AT_ONCE = 300
"""Shares and travel moves that formulas take together: fewer cost more calls, more do not fit a processor's cache."""
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

    def steeper(self, height: FloatArray, way: FloatArray) -> Slopes:
        """By so many times, (n_travel_moves,), on the way up and down, and along the way."""
        return Slopes(height[:, None] * self.lifting, height[:, None] * self.lowering, way[:, None] * self.along)


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
    slopes: Slopes,
    limits: Limits,
    clearance_mm: float,
    lift_mm: float,
    lowering_mm_s: float,
    least_mm: FloatArray | float = 0.0,
) -> Candidates:
    """The quickest ways to make each travel move, one for each of some handovers and shares, the quickest first.
    least_mm: (n_travel_moves,) handovers that are lower are left out.

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
    names = [field.name for field in fields(Candidates)]
    columns = {
        name: np.concatenate([none, *(getattr(candidates, name) for candidates in made)], axis=1) for name in names
    }
    is_low = columns["handover_mm"] < np.reshape(least_mm, (-1, 1)) * (1 - 1e-9)
    columns["seconds"][is_low] = np.inf
    order = np.argsort(columns["seconds"], axis=1, kind="stable")
    return Candidates(**{name: np.take_along_axis(column, order, axis=1) for name, column in columns.items()})


def _quickest_from(
    slopes: Slopes, limits: Limits, handover_mm: float, lift_mm: float, speeds_mm_s: FloatArray
) -> Candidates:
    """The quickest travel move for each share that hands over at that height. The fall passes it at any speed up to the
    first one. One braking takes the rise to the fall: the rise is the one that this leads back to the handover, or a
    higher one, from which it leads above that and the pen comes down the rest at this first speed."""
    rises, falls = np.linspace(*_AIMS, _N_RISES) * handover_mm, np.linspace(*_AIMS, _N_FALLS) * handover_mm
    up_jerk, down_jerk = (coordinate_limits(slope, limits).jerk[:, None] for slope in (slopes.lifting, slopes.lowering))
    below_up_s, up_speed, up_acceleration = _rise(rises, handover_mm, up_jerk, np.inf)
    below_down_s, down_speed, down_acceleration = (
        np.concatenate(column, axis=1)
        for column in zip(*(_rise(falls, handover_mm, down_jerk, speed) for speed in speeds_mm_s.tolist()), strict=True)
    )
    n_travel_moves, cap = len(up_jerk), speeds_mm_s[0]
    shape = n_travel_moves, len(_SHARES)
    seconds, at, rise_mm = np.empty(shape), np.empty(shape, dtype=np.int64), np.empty(shape)
    at_once = max(1, _ROWS_AT_ONCE // max(n_travel_moves, 1))
    for first in range(0, len(_SHARES), at_once):
        shares = _SHARES[first : first + at_once]
        move, share = np.repeat(np.arange(n_travel_moves), len(shares)), np.tile(shares, n_travel_moves)
        some = slopes.subset(move)
        over_s = rest_to_rest_s(coordinate_limits(some.along, rest_of(some, limits, share)))
        jerk = share[:, None] * np.minimum(up_jerk, down_jerk)[move]
        up, down = (up_speed[move], up_acceleration[move]), (down_speed[move], down_acceleration[move])
        turn_s, excess_mm = _turn(up, down, jerk)
        cruises = down[1][:, None] > -_NEVER_STEEP
        turn_s += np.where(cruises, excess_mm / cap, 0.0)
        whole_s = below_up_s[move, :, None] + below_down_s[move, None] + np.maximum(over_s[:, None, None], turn_s)
        _, up_mm = _brake(*up, jerk)
        whole_s[handover_mm + up_mm > lift_mm] = np.inf
        # Braking that so little jerk cannot end before the pen falls faster than it may.
        whole_s[up[0] - up[1] ** 2 / (2 * jerk) < -cap] = np.inf
        met_s, met_mm = _where_met(whole_s, excess_mm, rises)
        whole_s[~(cruises & (excess_mm >= 0.0))] = np.inf
        best = whole_s.argmin(axis=1)[:, None]
        least_s = np.take_along_axis(whole_s, best, axis=1)[:, 0]
        from_mm = np.where(least_s < met_s, rises[best[:, 0]], met_mm)
        least_s = np.minimum(least_s, met_s)
        fall = least_s.argmin(axis=1)[:, None]
        block = slice(first, first + at_once)
        at[:, block] = fall.reshape(n_travel_moves, -1)
        seconds[:, block] = np.take_along_axis(least_s, fall, axis=1).reshape(n_travel_moves, -1)
        rise_mm[:, block] = np.take_along_axis(from_mm, fall, axis=1).reshape(n_travel_moves, -1)
    speed, aim = np.divmod(at, len(falls))
    return Candidates(
        np.broadcast_to(_SHARES, at.shape),
        np.full(at.shape, handover_mm),
        rise_mm,
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


def _turn(
    up: tuple[FloatArray, FloatArray], down: tuple[FloatArray, FloatArray], jerk: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Time in which one braking that first grows and then fades takes a rise (n, n_rises) to a fall (n, n_falls), both
    as speeds and accelerations, and how much higher that ends than it began, (n, n_rises, n_falls); NaN where there is
    no such braking."""
    rise, rise_push, fall, fall_push = up[0][:, :, None], up[1][:, :, None], down[0][:, None], down[1][:, None]
    jerk = jerk[:, :, None]
    change = (rise_push - fall_push) / jerk  # by so much it grows for longer than it fades
    with np.errstate(invalid="ignore"):
        root = np.sqrt(fall_push**2 + jerk * (rise + fall + change * (rise_push - jerk * change / 2)))
    fades_s = (fall_push + root) / jerk
    grows_s = fades_s + change
    fades_s = np.where((fades_s >= 0.0) & (grows_s >= 0.0), fades_s, np.nan)
    ascent = grows_s * (rise + grows_s * (rise_push / 2 - grows_s * jerk / 6))
    descent = fades_s * (fall + fades_s * (fall_push / 2 - fades_s * jerk / 6))
    return grows_s + fades_s, ascent - descent


def _where_met(whole_s: FloatArray, excess_mm: FloatArray, rises: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Duration and height aimed at (n, n_falls) of the rise between the tried ones (n_rises,) that ends just as high as
    it began; inf where it would have to be beyond them."""
    is_enough = excess_mm >= 0.0
    behind = np.maximum(is_enough.argmax(axis=1), 1)[:, None]
    low, high = (np.take_along_axis(excess_mm, behind - k, axis=1)[:, 0] for k in (1, 0))
    low_s, high_s = (np.take_along_axis(whole_s, behind - k, axis=1)[:, 0] for k in (1, 0))
    with np.errstate(invalid="ignore", divide="ignore"):
        share = low / (low - high)
        met_s = low_s + share * (high_s - low_s)
    is_met = (share >= 0.0) & (share <= 1.0) & np.isfinite(met_s)
    met_mm = rises[behind[:, 0] - 1] + np.where(is_met, share, 0.0) * (rises[1] - rises[0])
    return np.where(is_met, met_s, np.inf), met_mm


def turning_acceleration(top_mm: FloatArray, jerk: FloatArray, speed: float) -> FloatArray:
    """(...,) braking that is left where a rise to `top_mm` turns, jerk and speed being the only limits."""
    uncapped = np.sqrt(2.0) * jerk * np.cbrt(top_mm / (_TURN_HEIGHT * jerk))
    turning: FloatArray = np.minimum(uncapped, np.sqrt(2 * jerk * speed))
    return turning
