"""The stroke of a mark: the pen comes down along a slope, rests, and is lifted further along.

Where the ink begins tells how high the tip was: one that is 1 mm too high begins 1 mm further along a slope of 1. Where
the pen rests is the mark: it blots there. As slack is taken up, a pen that is lifted still drags ink some way, so it
goes on in the same direction: the beginning stays clean.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.error_model.pattern.legs import rested
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import project

SLOPE = 1.0
"""mm of height lost for a mm along the line."""
LIFT_SLOPE = 4.0
"""mm of height won for a mm along the line, where the pen is lifted."""
_LIFT_MM, _REACH_MM = 10.0, 4.0
_DURATION_S = 1.5


@dataclass(frozen=True, slots=True)
class Heights:
    """Of a pattern, over the paper as the arm file has it. lift_mm: of travel. reach_mm: where a stroke begins, and how
    deep it ends.

    Tips of an arm that was never calibrated are several millimetres too high here and too low there, even where the
    paper's height is known at one place.
    """

    lift_mm: float
    reach_mm: float

    @property
    def length_mm(self) -> float:
        """Of a stroke."""
        return 2 * self.reach_mm / SLOPE

    @staticmethod
    def for_arm(arm: Arm) -> Heights:
        """Those that its pen allows."""
        return Heights(max(_LIFT_MM, arm.pen.lift_mm), _REACH_MM)


@dataclass(frozen=True, eq=False, slots=True)
class Touch:
    """begin_mm, zero_mm, end_mm: (2,) where the stroke begins, where a tip without error comes to the paper, and where
    it ends. joints: (n, n_joints) samples, at rest at both ends; zero: the one at zero_mm."""

    begin_mm: FloatArray
    zero_mm: FloatArray
    end_mm: FloatArray
    joints: FloatArray
    zero: int


def touch_line(
    kinematics: Kinematics,
    ends_mm: FloatArray,
    free: FloatArray,
    reach_mm: float,
    rate_hz: float,
) -> Touch | None:
    """The stroke between two places (2, 2) in configurations near to free (2, n_independent) at its ends; None where
    the arm cannot make it."""
    begin, end = ends_mm
    half = round(_DURATION_S * rate_hz / 2)
    u = np.arange(2 * half + 1) / (2 * half)
    along = (u**3 * (10 - 15 * u + 6 * u**2))[:, None]
    tips = np.column_stack((begin + along * (end - begin), reach_mm * (1 - 2 * along)))
    configurations, exact = project(kinematics, free[0] + along * (free[1] - free[0]), tips)
    arm = kinematics.arm
    joints = arm.complete(configurations)
    if not exact.all() or (joints < arm.minimum).any() or (joints > arm.maximum).any():
        return None
    return Touch(begin, (begin + end) / 2, end, rested(joints), half)
