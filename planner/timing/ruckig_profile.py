"""The doorway to Ruckig: jerk-limited motion of one coordinate from rest to rest.

Only state-to-state motion of one coordinate is asked of it: several synchronised axes would bend the
path, and waypoints would make it call a cloud service.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ruckig

from planner.arrays import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class RestToRest:
    """A time-optimal move from 0 to `distance`, at rest at both ends."""

    distance: float
    _trajectory: ruckig.Trajectory

    @property
    def duration_s(self) -> float:
        return float(self._trajectory.duration)

    def at(self, times_s: FloatArray) -> FloatArray:
        """(n,) positions at times (n,); before the start 0, after the end `distance`."""
        clipped = np.clip(times_s, 0.0, self.duration_s)
        return np.array([self._trajectory.at_time(time)[0][0] for time in clipped.tolist()])

    def time_at(self, position: float) -> float:
        """When the position is passed, for positions between 0 and `distance`.

        By bisection: Ruckig's own get_first_time_at_position finds nothing for some of them.
        """
        before, after = 0.0, self.duration_s
        for _ in range(60):
            middle = 0.5 * (before + after)
            if self._trajectory.at_time(middle)[0][0] < position:
                before = middle
            else:
                after = middle
        return after


def rest_to_rest(distance: float, velocity: float, acceleration: float, jerk: float) -> RestToRest:
    """The fastest such move within the limits, all in units of the coordinate; distance >= 0, limits > 0."""
    request = ruckig.InputParameter(1)
    request.current_position, request.target_position = [0.0], [distance]
    request.max_velocity, request.max_acceleration, request.max_jerk = [velocity], [acceleration], [jerk]
    trajectory = ruckig.Trajectory(1)
    result = ruckig.Ruckig(1).calculate(request, trajectory)
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise ArithmeticError(f"Ruckig: {result} over {distance:g} within {velocity:g}, {acceleration:g}, {jerk:g}")
    return RestToRest(distance, trajectory)
