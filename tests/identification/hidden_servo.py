"""A servo with limits that nobody is told: a position loop of second order, whose acceleration and jerk saturate,
behind gears with play, measured in counts and with noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from planner.arrays import FloatArray

_FINE = 10


@dataclass(frozen=True, slots=True)
class HiddenServo:
    """acceleration, jerk: its limits, in units of the joint. lag_s: how late it is at a steady speed. play: of the
    joint; noise, count: of what is measured, and the steps of that."""

    acceleration: float
    jerk: float
    lag_s: float = 0.02
    play: float = 0.0
    noise: float = 0.0
    count: float = 0.0

    def measured(self, told: FloatArray, rate_hz: float, random: np.random.Generator) -> FloatArray:
        """(n,) where the joint is measured to be at each of the samples that it is told (n,)."""
        step_s = 1 / rate_hz / _FINE
        targets = CubicSpline(np.arange(len(told)), told)(np.arange(len(told) * _FINE) / _FINE).tolist()
        stiffness, damping = 4 / self.lag_s**2, 4 / self.lag_s
        position = joint = targets[0]
        velocity = acceleration = 0.0
        positions = np.empty(len(targets))
        for k, target in enumerate(targets):
            wanted = stiffness * (target - position) - damping * velocity
            wanted = min(max(wanted, -self.acceleration), self.acceleration)
            most = self.jerk * step_s
            acceleration += min(max(wanted - acceleration, -most), most)
            velocity += acceleration * step_s
            position += velocity * step_s
            joint = min(max(joint, position - self.play / 2), position + self.play / 2)
            positions[k] = joint
        seen = positions[::_FINE] + random.normal(0.0, self.noise, len(told))
        return np.round(seen / self.count) * self.count if self.count else seen
