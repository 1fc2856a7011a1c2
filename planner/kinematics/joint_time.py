"""The time that the joints need between two configurations, each at its greatest speed: the distance that decides
which of several configurations is the nearest (documents on the SCARA arm, choice among solutions)."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray


def joint_time_s(arm: Arm, start: FloatArray, end: FloatArray) -> FloatArray:
    """`max |end_i - start_i| / speed_i` in seconds, (...,), of all joints (..., n_joints); the two broadcast.
    NaN where a configuration is."""
    time: FloatArray = (np.abs(end - start) / arm.max_velocity).max(axis=-1)
    return time
