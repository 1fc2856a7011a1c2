"""What is planned with for an arm where nobody says it: samples a second, how far the pen may be off, and how high it
is clear of the paper."""

from __future__ import annotations

import math

from planner.arms.arm import Arm
from planner.settings import MAX_RATE_HZ, MIN_RATE_HZ, PlanSettings

_SHARE = 0.5
"""Of the error that an arm is expected to draw with: as the tolerance is the most, and a part of that the usual, what
is drawn gets worse by a few per cent."""
_SHORTEST_S = 1e-9
_CLEARANCE_MM, _LEAST_CLEARANCE_MM = 1.0, 0.3
"""Of an arm that nobody has calibrated, and of the best."""
_LEFT = 1.645
"""Standard deviations of the height within which 95 of 100 places are not higher."""
_UNEVEN_MM = 0.2
"""What paper bulges off its board, and a nib is off its middle, is taken to add."""


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


def usual_clearance_mm(arm: Arm) -> float:
    """The height below which the pen goes straight up and down: there the pen of a calibrated arm has left the paper at
    95 of 100 places, by what is expected of its height; rounded to two digits, and never above the lift height."""
    if arm.accuracy is None:
        return min(_CLEARANCE_MM, arm.pen.lift_mm)
    enough_mm = float(f"{_LEFT * arm.accuracy.height_mm + _UNEVEN_MM:.2g}")
    return min(max(enough_mm, _LEAST_CLEARANCE_MM), arm.pen.lift_mm)
