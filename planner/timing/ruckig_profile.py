"""The doorway to Ruckig: jerk-limited motion of one coordinate from rest to rest, or to where it turns round.

Only state-to-state motion of one coordinate is asked of it: several synchronised axes would bend the
path, and waypoints would make it call a cloud service.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
import ruckig

from planner.arrays import FloatArray


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


def rest_to_rest(distance: float, velocity: float, acceleration: float, jerk: float, turning: float = 0.0
                 ) -> RestToRest:
    """The fastest such move within the limits, all in units of the coordinate; distance >= 0, limits > 0.

    turning: braking that is left at the end, where the coordinate turns round rather than rests; less than both
    `acceleration` and `sqrt(2 jerk velocity)`.
    """
    request = ruckig.InputParameter(1)
    request.current_position, request.target_position = [0.0], [distance]
    request.max_velocity, request.max_acceleration, request.max_jerk = [velocity], [acceleration], [jerk]
    request.target_acceleration = [-turning]
    trajectory = ruckig.Trajectory(1)
    result = ruckig.Ruckig(1).calculate(request, trajectory)
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise ArithmeticError(f"Ruckig: {result} over {distance:g} within {velocity:g}, {acceleration:g}, {jerk:g}")
    return RestToRest(distance, *_pieces(trajectory))


def between_states(position: float, start: tuple[float, float], end: tuple[float, float], lowest_velocity: float,
                   limits: tuple[float, float, float], least_s: float) -> RestToRest:
    """The fastest way back to the same `position`, from velocity and acceleration `start` to those at the `end`, that
    takes `least_s` at least. Both ends must be within the limits, and stay so when braked from or led up to."""
    velocity, acceleration, jerk = limits
    request = ruckig.InputParameter(1)
    request.current_position, request.target_position = [position], [position]
    request.current_velocity, request.target_velocity = [start[0]], [end[0]]
    request.current_acceleration, request.target_acceleration = [start[1]], [end[1]]
    request.min_velocity, request.max_velocity = [lowest_velocity], [velocity]
    request.max_acceleration, request.max_jerk = [acceleration], [jerk]
    request.minimum_duration = least_s
    trajectory = ruckig.Trajectory(1)
    ruckig.Ruckig(1).calculate(request, trajectory)
    return RestToRest(position, *_pieces(trajectory))


def _pieces(trajectory: ruckig.Trajectory
            ) -> tuple[tuple[float, ...], tuple[tuple[float, float, float, float], ...]]:
    profile = trajectory.profiles[0][0]
    begins_s = (0.0, *accumulate(profile.t))
    return begins_s, tuple(zip(profile.p, profile.v, profile.a, (*profile.j, 0.0), strict=True))
