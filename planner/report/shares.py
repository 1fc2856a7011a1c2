"""How much of its limits each joint uses, and when it uses most."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.plots.samples import finite_difference
from planner.trajectory import Trajectory

QUANTITIES = ("position", "velocity", "acceleration", "jerk")


@dataclass(frozen=True, slots=True)
class LargestShare:
    """share: of the limit, 1 at it; of a position, of the way from the middle of its range to an end. time_s: when.
    stroke: what is drawn then, TRAVELLING between strokes."""

    share: float
    time_s: float
    stroke: int


def largest_shares(trajectory: Trajectory, arm: Arm) -> list[list[LargestShare]]:
    """A row for each joint, with an entry for each of QUANTITIES. Derivatives are plain differences of the samples."""
    middle, half = (arm.to_file_units((arm.maximum + sign * arm.minimum) / 2) for sign in (1, -1))
    limits = (half, *map(arm.to_file_units, (arm.max_velocity, arm.max_acceleration, arm.max_jerk)))
    columns = []
    for order, limit in enumerate(limits):
        times_s, values = finite_difference(trajectory.positions - middle, trajectory.rate_hz, order)
        place = np.argmax(np.abs(values), axis=0)
        columns.append(
            [
                _share(trajectory, abs(float(values[row, joint])) / float(limit[joint]), float(times_s[row]))
                for joint, row in enumerate(place.tolist())
            ]
        )
    return [list(row) for row in zip(*columns, strict=True)]


def _share(trajectory: Trajectory, share: float, time_s: float) -> LargestShare:
    time_s = min(max(time_s, 0.0), trajectory.duration_s)
    return LargestShare(share, time_s, int(trajectory.stroke[int(time_s * trajectory.rate_hz)]))
