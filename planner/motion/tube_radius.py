"""How wide the tube is that pen paths are smooth in: what straight lines between samples cut off needs room as well.

Round a corner of radius r in size a pen of greatest jerk J takes a time t ~ (r / J)^(1/3), with an acceleration J t;
chords between samples, h apart, are an eighth of that times h^2 off. The tube is as wide as leaves room for them.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.kinematics.chain import Kinematics

_CHORDS = 0.25
"""Measured: of J^(2/3) r^(1/3) h^2, what chords take of the room. Too much or too little costs time only."""
_WIDEST, _NARROWEST = 0.93, 0.4
"""Of the room: between the places at which it is bounded a path strays a little further."""
_SPARED = 0.7
"""Measured: what wide tubes leave to chords beyond what these take, in shares of that."""


def tube_radius(kinematics: Kinematics, configurations: FloatArray, room_mm: float, rate_hz: float) -> float:
    """In mm, for an arm about such configurations (n, n_independent), and so much room for paths and chords."""
    jerk = tip_jerk(kinematics, configurations)
    if not np.isfinite(jerk):
        return _NARROWEST * room_mm
    chords = _CHORDS * np.cbrt(jerk) ** 2 / rate_hz**2
    # r + chords r^(1/3) = room: the left side rises, and is concave where it curves.
    low, high = 0.0, room_mm
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if middle + chords * np.cbrt(middle) < room_mm else (low, middle)
    widest_mm = _WIDEST * room_mm - _SPARED * (room_mm - low)
    return max(min(low, widest_mm), _NARROWEST * room_mm)


def tip_jerk(kinematics: Kinematics, configurations: FloatArray) -> float:
    """The median of what jerk, mm/s^3, the tip can have on the paper in any direction by the jerk limits of the joints;
    nan where no configuration (n, n_independent) is finite."""
    arm = kinematics.arm
    finite = configurations[np.isfinite(configurations).all(axis=1)]
    if not len(finite):
        return np.nan
    _, jacobian = kinematics.task_and_jacobian(finite)
    by_tip = np.linalg.pinv(jacobian)[:, :, :2]
    rest = arm.complete(finite)
    of_joints = np.stack(
        [arm.complete(finite + by_tip[:, :, k]) - rest for k in (0, 1)], axis=2
    ) / arm.max_jerk[:, None]  # fmt: skip
    largest = np.linalg.norm(of_joints, axis=2).max(axis=1)
    with np.errstate(divide="ignore"):
        ordered = np.sort(1.0 / largest)  # np.median loads masked arrays, which takes longer than all this
    return float(ordered[(len(ordered) - 1) // 2] + ordered[len(ordered) // 2]) / 2
