"""The doorway to Ruckig: jerk-limited motion of one coordinate from rest to rest, or to where it turns round.

Only state-to-state motion of one coordinate is asked of it: several synchronised axes would bend the
path, and waypoints would make it call a cloud service.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass
from itertools import accumulate, chain

import numpy as np
import ruckig

from planner.arrays import FloatArray

_MIRRORED = 1e-9
_NOTHING = 1e-100
"""Distances so short that their squares vanish take no time."""
_JOINT = 1e-6
"""Share of its positions and of its speeds that a move may jump by between two pieces."""
_AMPLE, _SCARCE = 10.0, 1e-3
"""Speeds and accelerations of a move over 1 at a jerk of 1: more than it can use, and so little that jerk counts for
nothing."""


class NoSuchMove(ArithmeticError):
    """Ruckig finds no move: this one is out of the question, and others may do."""


@dataclass(frozen=True, slots=True)
class RestToRest:
    """A time-optimal move from 0 to `distance`, at rest at both ends, but for the braking that may be left where it
    turns round.

    begins_s: (8,) when each of its seven pieces of constant jerk begins, and when the last one ends; states: (8,)
    position, velocity, acceleration and jerk at these times.
    """

    distance: float
    begins_s: tuple[float, ...]
    states: tuple[tuple[float, float, float, float], ...]

    @property
    def duration_s(self) -> float:
        return self.begins_s[-1]

    @property
    def highest_speed(self) -> float:
        return max(abs(velocity) for _, velocity, _, _ in self.states)

    @property
    def lowest_velocity(self) -> float:
        return min(velocity for _, velocity, _, _ in self.states)

    def at(self, times_s: FloatArray) -> FloatArray:
        """(n,) positions at times (n,); before the start 0, after the end `distance`."""
        begins = np.array(self.begins_s)
        times = np.clip(times_s, 0.0, begins[-1])
        piece = np.searchsorted(begins[1:-1], times, side="right")
        position, velocity, acceleration, jerk = np.array(self.states)[piece].T
        into = times - begins[piece]
        reached: FloatArray = position + into * (velocity + into * (acceleration / 2 + into * jerk / 6))
        reached[times_s >= begins[-1]] = self.distance
        return reached

    def state_at(self, time_s: float) -> tuple[float, float]:
        """Velocity and acceleration at a time between the start and the end."""
        piece = max(bisect_right(self.begins_s[:-1], time_s) - 1, 0)
        into = time_s - self.begins_s[piece]
        _, velocity, acceleration, jerk = self.states[piece]
        return velocity + into * (acceleration + into * jerk / 2), acceleration + into * jerk

    def time_at(self, position: float) -> float:
        """When the position is passed, for positions between 0 and `distance`, by bisection within its piece."""
        piece = min(max(bisect_right([state[0] for state in self.states], position) - 1, 0), len(self.states) - 2)
        start, velocity, acceleration, jerk = self.states[piece]
        before, after = 0.0, self.begins_s[piece + 1] - self.begins_s[piece]
        for _ in range(60):
            middle = 0.5 * (before + after)
            if start + middle * (velocity + middle * (acceleration / 2 + middle * jerk / 6)) < position:
                before = middle
            else:
                after = middle
        return self.begins_s[piece] + after


def rest_to_rest(
    distance: float, velocity: float, acceleration: float, jerk: float, turning: float = 0.0
) -> RestToRest:
    """The fastest such move within the limits, all in units of the coordinate; distance >= 0, limits > 0.

    turning: braking that is left at the end, where the coordinate turns round rather than rests; less than both
    `acceleration` and `sqrt(2 jerk velocity)`. Errors: NoSuchMove, never where turning is 0.

    Ruckig is asked for a move over 1 at a jerk of 1, so that its tolerances fit whatever the scale of the limits. Where
    speed or acceleration is so scarce that jerk costs no time to speak of, less of it does.
    """
    if distance <= _NOTHING:
        return RestToRest(0.0, (0.0, 0.0), ((0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)))
    unit_s = max(
        math.cbrt(distance / jerk), _SCARCE * distance / velocity, math.sqrt(_SCARCE * distance / acceleration)
    )
    speed, push = distance / unit_s, distance / unit_s**2
    request = ruckig.InputParameter(1)
    request.current_position, request.target_position = [0.0], [1.0]
    request.max_velocity, request.max_acceleration = [min(velocity / speed, _AMPLE)], [min(acceleration / push, _AMPLE)]
    request.max_jerk = [1.0]
    request.target_acceleration = [-turning / push]
    begins_s, states = _calculated(request)
    units = (distance, speed, push, push / unit_s)
    return RestToRest(
        distance,
        tuple(unit_s * begin for begin in begins_s),
        tuple((p * units[0], v * units[1], a * units[2], j * units[3]) for p, v, a, j in states),
    )


def between_states(
    position: float,
    start: tuple[float, float],
    end: tuple[float, float],
    lowest_velocity: float,
    limits: tuple[float, float, float],
    least_s: float,
) -> RestToRest:
    """The fastest way back to the same `position`, from velocity and acceleration `start` to those at the `end`, that
    takes `least_s` at least. Errors: NoSuchMove, as where an end is not within the limits, or cannot be braked from, or
    led up to, without leaving them."""
    velocity, acceleration, jerk = limits
    if math.isclose(start[0], -end[0], rel_tol=_MIRRORED) and math.isclose(start[1], end[1], rel_tol=_MIRRORED):
        raise NoSuchMove("ends that mirror each other crash Ruckig")  # a segmentation fault of 0.19
    request = ruckig.InputParameter(1)
    request.current_position, request.target_position = [position], [position]
    request.current_velocity, request.target_velocity = [start[0]], [end[0]]
    request.current_acceleration, request.target_acceleration = [start[1]], [end[1]]
    request.min_velocity, request.max_velocity = [lowest_velocity], [velocity]
    request.max_acceleration, request.max_jerk = [acceleration], [jerk]
    request.minimum_duration = least_s
    return RestToRest(position, *_calculated(request))


_States = tuple[tuple[float, float, float, float], ...]


def _calculated(request: ruckig.InputParameter) -> tuple[tuple[float, ...], _States]:
    """When each piece of the move begins and the last one ends, and position, velocity, acceleration and jerk then.
    Errors: NoSuchMove."""
    trajectory = ruckig.Trajectory(1)
    try:
        result = ruckig.Ruckig(1).calculate(request, trajectory)
    except (ruckig.RuckigError, ValueError, RuntimeError) as error:  # limits that contradict the ends
        raise NoSuchMove(str(error)) from error
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise NoSuchMove(f"{result}")
    profile = trajectory.profiles[0][0]
    if profile.brake.duration > 0.0:  # it first leaves the limits that it began beyond
        raise NoSuchMove("the start cannot be braked from within the limits")
    begins_s = (0.0, *accumulate(profile.t))
    states = tuple(zip(profile.p, profile.v, profile.a, (*profile.j, 0.0), strict=True))
    if not all(map(math.isfinite, chain(begins_s, *states))):
        raise NoSuchMove("numbers beyond what a computer holds")
    if not _joined(begins_s, states):
        raise NoSuchMove("its pieces do not join")
    return begins_s, states


def _joined(begins_s: tuple[float, ...], states: _States) -> bool:
    """Whether each piece ends where the next begins, in position and in velocity."""
    begins, (position, velocity, acceleration, jerk) = np.array(begins_s), np.array(states).T
    into = np.diff(begins)
    reached = position[:-1] + into * (velocity[:-1] + into * (acceleration[:-1] / 2 + into * jerk[:-1] / 6))
    speed = velocity[:-1] + into * (acceleration[:-1] + into * jerk[:-1] / 2)
    return bool(
        np.abs(reached - position[1:]).max() <= _JOINT * np.abs(position).max()
        and np.abs(speed - velocity[1:]).max() <= _JOINT * np.abs(velocity).max()
    )
