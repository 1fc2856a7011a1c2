"""The joint limits: whether positions keep them, and those that motions are timed within."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray

SLACK = 1e-9
"""Rounding that is forgiven at a position limit, rad or mm."""


def beyond_limits(arm: Arm, joints: FloatArray) -> FloatArray:
    """(..., n_joints) how far each joint of (..., n_joints) is beyond its nearer limit, rad or mm; negative within."""
    beyond: FloatArray = np.maximum(arm.minimum - joints, joints - arm.maximum)
    return beyond


def within_limits(arm: Arm, joints: FloatArray, slack: float = SLACK) -> BoolArray:
    """(...,) whether all joints of (..., n_joints) keep their position limits; none does where one is NaN."""
    within: BoolArray = np.all((joints >= arm.minimum - slack) & (joints <= arm.maximum + slack), axis=-1)
    return within


@dataclass(frozen=True, eq=False, slots=True)
class Limits:
    """(n_joints,) largest velocity, acceleration and jerk, in rad or mm and seconds."""

    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray

    @staticmethod
    def of(arm: Arm) -> Limits:
        """The arm's own, less a part in a million, so that a file's rounding cannot push a sample over."""
        keep = 1.0 - 1e-6
        return Limits(arm.max_velocity * keep, arm.max_acceleration * keep, arm.max_jerk * keep)

    def slowing_of(self, positions: FloatArray, period_s: float, rounding: FloatArray | float = 0.0) -> float:
        """How much slower samples (n, n_joints) of a motion would have to be played for the differences of
        neighbouring samples to keep all limits; at most 1 where they do.

        rounding: (n_joints,) how far each position may be from the one that was meant. A k-th difference is off by 2^k
        times as much, which over k periods of a high rate is no longer small beside a limit, and is allowed.
        """
        needed = 0.0
        difference = positions
        for order, limit in enumerate((self.velocity, self.acceleration, self.jerk), 1):
            difference = np.diff(difference, axis=0)
            if len(difference):
                moved = np.abs(difference) - 2.0**order * rounding
                ratio = max(float((moved / limit).max()), 0.0) / period_s**order
                needed = max(needed, ratio ** (1 / order))
        return needed
