"""The moves of a pattern, each from rest to rest: across in the air, and straight up or down."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits, within_limits
from planner.kinematics.projection import project

_SHORTEST_S = 0.15
_LONGEST_S = 10.0
"""No leg of a pattern takes as long, unless its joints have to jump, for which no time is enough."""
_ROUNDS = 4
_MARGIN = 1.02
RESTING = 3
"""Samples that a leg rests for at its end."""


def straight_leg(
    kinematics: Kinematics, limits: Limits, ends_mm: FloatArray, free: FloatArray, rate_hz: float
) -> FloatArray | None:
    """Joint samples (n, n_joints), both ends included, of the tip's way between `ends_mm` (2, 3).

    Straight in distance from and azimuth about the base axis, and in height. free: (2, n_independent) configurations
    at the ends, between which those nearest to their straight line are taken. Progress is 10u^3 - 15u^4 + 6u^5, as
    fast as the limits allow; it ends with a short rest. None where the arm cannot go that way.
    """
    arm = kinematics.arm
    axis = arm.paper.T_paper_base[:2, 3]
    about = ends_mm[:, :2] - axis
    polar = np.column_stack((np.hypot(*about.T), np.arctan2(about[:, 1], about[:, 0]), ends_mm[:, 2]))
    duration_s = _SHORTEST_S
    for _ in range(_ROUNDS):
        n = int(np.ceil(duration_s * rate_hz))
        u = np.arange(n + 1) / n
        along = (u**3 * (10 - 15 * u + 6 * u**2))[:, None]
        radius, azimuth, height = (polar[0] + along * (polar[1] - polar[0])).T
        tips = np.column_stack((axis[0] + radius * np.cos(azimuth), axis[1] + radius * np.sin(azimuth), height))
        configurations, exact = project(kinematics, free[0] + along * (free[1] - free[0]), tips)
        joints = arm.complete(configurations)
        if not exact.all() or not within_limits(arm, joints, slack=0.0).all():
            return None
        slowing = slowing_from_rest(limits, joints, rate_hz)
        if slowing <= 1.0:
            return rested(joints)
        duration_s = n / rate_hz * slowing * _MARGIN
        if duration_s > _LONGEST_S:
            return None
    return None


def rested(joints: FloatArray) -> FloatArray:
    """The samples of a leg and a rest so long that no third difference reaches from this leg into the next."""
    return np.pad(joints, ((0, RESTING - 1), (0, 0)), mode="edge")


def slowing_from_rest(limits: Limits, joints: FloatArray, rate_hz: float) -> float:
    """As `Limits.slowing_of`, the arm at rest before the first sample and after the last: from rest, jerk alone moves a
    joint J t^3 / 6 in the time t."""
    within = limits.slowing_of(np.pad(joints, ((3, 3), (0, 0)), mode="edge"), 1 / rate_hz)
    steps = np.abs(np.stack((joints[1] - joints[0], joints[-1] - joints[-2])))
    return max(within, float(np.cbrt((6 * steps * rate_hz**3 / limits.jerk).max())))
