"""Arms with a closed form: those that come along, and variants with offsets in every place that a family allows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.inverse_kinematics.closed_forms import FAMILIES, Family

NAMES = ("drawing_arm", "drawing_arm_2022", "scara", "three_joint", "six_joint", "stanford")
VARIANTS = ("drawing_arm/offset", "scara/offset", "three_joint/offset", "six_joint/offset", "stanford/both_ways")
WITH_POSE = ("scara", "scara/offset", "six_joint", "six_joint/offset", "stanford", "stanford/both_ways")
ALL = NAMES + VARIANTS


def changed(arm: Arm, rows: Sequence[dict[str, float]]) -> Arm:
    """The arm with values of its joints, row by row, replaced."""
    joints = tuple(replace(joint, **row) for joint, row in zip(arm.joints, rows, strict=True))
    return replace(arm, joints=joints)


@lru_cache
def arm_of(name: str) -> Arm:
    """An arm by name, `family/variant` for those that are made up here."""
    base, _, variant = name.partition("/")
    family = "drawing_arm" if base.startswith("drawing_arm") else base
    arm = replace(load_arm(base), closed_form=family)
    return changed(arm, _VARIANTS[variant][family]) if variant else arm


def family(arm: Arm) -> Family:
    """The closed form of an arm that has one."""
    assert arm.closed_form is not None
    return FAMILIES[arm.closed_form]


_QUARTER = np.pi / 2
_VARIANTS: dict[str, dict[str, list[dict[str, float]]]] = {
    "offset": {
        "drawing_arm": [
            {"theta_rad": 0.3, "a_mm": 7.0, "alpha_rad": -_QUARTER},
            {"theta_rad": -0.2, "d_mm": 6.0},
            {"a_mm": 61.0, "theta_rad": 0.7},
            {"d_mm": -9.0, "theta_rad": 0.1},
            {"theta_rad": -1.1},
        ],
        "scara": [
            {"theta_rad": 0.3, "a_mm": 80.0},
            {"theta_rad": -0.5, "d_mm": 4.0},
            {"theta_rad": 0.2, "d_mm": -3.0},
            {"theta_rad": 1.0, "d_mm": -15.0},
        ],
        "three_joint": [
            {"theta_rad": 0.3, "a_mm": 12.0, "alpha_rad": -_QUARTER},
            {"theta_rad": -0.4, "d_mm": 9.0},
            {"theta_rad": 0.6, "d_mm": 5.0, "a_mm": 95.0, "alpha_rad": 0.8},
        ],
        "six_joint": [
            {"theta_rad": 0.3, "a_mm": 10.0, "alpha_rad": _QUARTER},
            {"theta_rad": -0.4, "d_mm": 9.0},
            {"theta_rad": 0.6, "d_mm": 5.0, "a_mm": 13.0, "alpha_rad": -_QUARTER},
            {"theta_rad": 0.9, "alpha_rad": _QUARTER},
            {"theta_rad": 0.1, "alpha_rad": -_QUARTER},
            {"theta_rad": -0.7},
        ],
    },
    "both_ways": {
        "stanford": [
            {"theta_rad": 0.3, "a_mm": 8.0, "alpha_rad": -_QUARTER},
            {"theta_rad": 0.2, "d_mm": -30.0, "alpha_rad": _QUARTER},
            {"theta_rad": 0.5, "d_mm": 11.0, "minimum": -200.0},
            {"theta_rad": 0.4, "d_mm": 21.0, "alpha_rad": -_QUARTER},
            {"theta_rad": 0.1, "alpha_rad": _QUARTER},
            {"theta_rad": -0.7},
        ],
    },
}


def poses_of(arm: Arm, joints: FloatArray) -> FloatArray:
    """(n, 4, 4) by the product of DH matrices, written out over arrays: independent of what is tested."""
    pose = np.tile(np.eye(4), (len(joints), 1, 1))
    for joint, value in zip(arm.joints, joints.T, strict=True):
        turning = joint.file_unit == "deg"
        theta = joint.theta_rad + (value if turning else 0.0) + np.zeros(len(joints))
        row = np.zeros((len(joints), 4, 4))
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(joint.alpha_rad), np.sin(joint.alpha_rad)
        row[:, 0] = np.stack((c, -s * ca, s * sa, joint.a_mm * c), axis=1)
        row[:, 1] = np.stack((s, c * ca, -c * sa, joint.a_mm * s), axis=1)
        row[:, 2, 1:3] = sa, ca
        row[:, 2, 3] = joint.d_mm + (0.0 if turning else value)
        row[:, 3, 3] = 1.0
        pose = pose @ row
    return pose


def redundancy_of(arm: Arm, independent: FloatArray) -> FloatArray:
    """(n,) the redundancy of drawing configurations (n, n_independent), from its definition: pitch of the drawing arm,
    else the direction of the last frame's x axis from the azimuth of the tip."""
    joints = arm.complete(independent)
    if arm.closed_form == "drawing_arm":
        return joints[:, 1:4].sum(axis=1) + sum(joint.theta_rad for joint in arm.joints[1:4])
    pose = poses_of(arm, joints)
    return np.arctan2(pose[:, 1, 0], pose[:, 0, 0]) - np.arctan2(pose[:, 1, 3], pose[:, 0, 3])


def apart(arm: Arm, first: FloatArray, second: FloatArray) -> FloatArray:
    """(...,) largest difference of independent joints (..., n_independent), whole turns aside."""
    turning = np.array([arm.joints[index].file_unit == "deg" for index in arm.independent_joints])
    difference = np.asarray(first - second)
    return np.abs(np.where(turning, np.angle(np.exp(1j * difference)), difference)).max(axis=-1)
