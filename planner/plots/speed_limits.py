"""How fast the pen may go along its path, from the samples of a trajectory and the limits of the arm alone.

Along a path q(s), s being the way of the tip in mm, joints move at q' v and q' a + q'' v^2 where the pen has speed v
and gains it at a. Velocity limits bound v by the least of `max_velocity / |q'|`. Acceleration limits leave a choice of
a at speed v exactly where they do for every two joints i and k, that is up to
`v^2 = (A_i |q'_k| + A_k |q'_i|) / |q''_i q'_k - q''_k q'_i|`, the maximum velocity curve (Bobrow, Dubowsky and
Gibson 1985; in this form Pham 2014).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray

_CELL_MM = 1e-3
"""Samples that are closer, about a rest, do not tell where the path leads, at nine decimals of a degree."""


@dataclass(frozen=True, eq=False, slots=True)
class PathSpeeds:
    """Along a stroke, at n places in the middle between samples.

    way_mm: (n,) way of the pen from the start of the stroke. speed_mm_s: (n,) of the pen. velocity_limit_mm_s: (n,)
    what the joints' velocities allow; nowhere less than the speed of a motion that keeps them. binding: (n,) the joint
    that allows least. acceleration_way_mm, acceleration_limit_mm_s: (n - 1,) what their accelerations allow, and where.
    """

    way_mm: FloatArray
    speed_mm_s: FloatArray
    velocity_limit_mm_s: FloatArray
    binding: IntArray
    acceleration_way_mm: FloatArray
    acceleration_limit_mm_s: FloatArray


def path_speeds(arm: Arm, joints: FloatArray, tip_mm: FloatArray, rate_hz: float) -> PathSpeeds:
    """Of one stroke: joints (n_samples, n_joints) in rad or mm and the tip (n_samples, 2 or more) at its samples.

    A tap, or a stroke within a micrometre, gives empty arrays.
    """
    steps_mm = np.linalg.norm(np.diff(tip_mm[:, :2], axis=0), axis=1)
    at_mm = np.concatenate(([0.0], np.cumsum(steps_mm)))
    kept = np.flatnonzero(np.diff(np.floor(at_mm / _CELL_MM), prepend=-1.0) > 0)
    way_mm, taken_s = np.diff(at_mm[kept]), np.diff(kept) / rate_hz
    slope = np.diff(joints[kept], axis=0) / way_mm[:, np.newaxis]
    with np.errstate(divide="ignore"):
        allowed = arm.max_velocity / np.abs(slope)
    middle_mm = (at_mm[kept[1:]] + at_mm[kept[:-1]]) / 2
    return PathSpeeds(
        middle_mm,
        way_mm / taken_s,
        allowed.min(axis=1, initial=np.inf),
        allowed.argmin(axis=1),
        at_mm[kept[1:-1]],
        _acceleration_limit(arm, slope, np.diff(middle_mm)),
    )


def _acceleration_limit(arm: Arm, slope: FloatArray, between_mm: FloatArray) -> FloatArray:
    """(n - 1,) mm/s from the slopes dq/ds (n, n_joints) and the way from each to the next (n - 1,)."""
    first, second = (slope[1:] + slope[:-1]) / 2, np.diff(slope, axis=0) / between_mm[:, np.newaxis]
    squared = np.full(len(first), np.inf)
    for i in range(arm.n_joints):
        for k in range(i):
            room = arm.max_acceleration[i] * np.abs(first[:, k]) + arm.max_acceleration[k] * np.abs(first[:, i])
            turn = np.abs(second[:, i] * first[:, k] - second[:, k] * first[:, i])
            squared = np.minimum(squared, np.divide(room, turn, out=np.full(len(first), np.inf), where=turn > 0))
    limit: FloatArray = np.sqrt(squared)
    return limit
