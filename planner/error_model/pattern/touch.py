"""The line beside a mark that tells the height of the tip: the pen comes down along a slope, and where ink begins says
how high it was. A pen that is 1 mm too high begins 1 mm further along a slope of 1."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.error_model.pattern.legs import rested
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import project

SLOPE = 0.8
"""mm of height lost for a mm along the line."""
REACH_MM = 4.0
"""Height at which a line begins, and depth that it ends at."""
OFFSET_MM = 3.5
"""From a mark to the nearer end of its line."""
_DURATION_S = 1.5


@dataclass(frozen=True, eq=False, slots=True)
class Touch:
    """begin_mm, zero_mm, end_mm: (2,) where the line begins, where a tip without error comes to the paper, and where it
    ends. joints: (n, n_joints) samples, at rest at both ends; zero: the one at zero_mm."""

    begin_mm: FloatArray
    zero_mm: FloatArray
    end_mm: FloatArray
    joints: FloatArray
    zero: int


def ends_of(mark_mm: FloatArray, way: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where the line of a mark begins and ends, both (..., 2), in the direction `way` (2,)."""
    begin = mark_mm + OFFSET_MM * way
    return begin, begin + 2 * REACH_MM / SLOPE * way


def touch_line(
    kinematics: Kinematics, mark_mm: FloatArray, free: FloatArray, way: FloatArray, rate_hz: float
) -> Touch | None:
    """The touch of a mark drawn in the configuration `free` (n_independent,); None where the arm cannot make it."""
    begin, end = ends_of(mark_mm, way)
    half = round(_DURATION_S * rate_hz / 2)
    u = np.arange(2 * half + 1) / (2 * half)
    along = (u**3 * (10 - 15 * u + 6 * u**2))[:, None]
    tips = np.column_stack((begin + along * (end - begin), REACH_MM * (1 - 2 * along)))
    configurations, exact = project(kinematics, np.repeat(free[None], len(tips), axis=0), tips)
    arm = kinematics.arm
    joints = arm.complete(configurations)
    if not exact.all() or (joints < arm.minimum).any() or (joints > arm.maximum).any():
        return None
    return Touch(begin, (begin + end) / 2, end, rested(joints), half)
