"""What is planned with for an arm where nobody says it: samples a second, and how far the pen may be off."""

from __future__ import annotations

import math

from planner.arms.arm import Arm
from planner.settings import MAX_RATE_HZ, MIN_RATE_HZ, PlanSettings

_SHARE = 0.5
"""Of the error that an arm is expected to draw with: as the tolerance is the most, and a part of that the usual, what
is drawn gets worse by a few per cent."""
_SHORTEST_S = 1e-9


def usual_rate_hz(arm: Arm) -> float:
    """A sample for each set point that the servos take, so that they see what was planned; as many whole ones as make
    50 a second where they take fewer, and 100 a second where nobody has said how often they do."""
    if arm.set_point_period_s is None:
        return PlanSettings().rate_hz
    samples = max(math.ceil(MIN_RATE_HZ * arm.set_point_period_s - _SHORTEST_S), 1)
    return min(samples / arm.set_point_period_s, MAX_RATE_HZ)


def usual_tolerance_mm(arm: Arm) -> float:
    """Half of the error along the paper that a calibrated arm is expected to draw with, rounded to two digits; for a
    better arm, and for one that nobody has calibrated, the least that is usual."""
    least = PlanSettings().tolerance_mm
    if arm.accuracy is None:
        return least
    half_mm = _SHARE * expected_error_mm(arm)
    return max(least, float(f"{half_mm:.2g}"))


def expected_error_mm(arm: Arm) -> float:
    """Root mean square distance of the tip from where it is meant to be, which a calibration leaves; 0 where there was
    none."""
    return 0.0 if arm.accuracy is None else math.hypot(arm.accuracy.tip_mm, arm.accuracy.tip_mm)
