"""The weights of the posture field do what their names say, and its cost is the same in numbers and in symbols."""

from __future__ import annotations

import casadi
import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arms.kinematics import kinematics_of
from planner.arms.posture_cost import PostureCost
from planner.arms.posture_field import PostureField, posture_field
from planner.arrays import FloatArray
from planner.settings import PostureWeights
from tests.arms.chains import load_once

TIME, SENSITIVITY, LIMITS = PostureWeights(1, 0, 0, 0.1), PostureWeights(0.05, 1, 0, 0.1), PostureWeights(0.05, 0, 0, 1)


@pytest.fixture(scope="module")
def arm() -> Arm:
    return load_once("drawing_arm")


def slopes(field: PostureField) -> FloatArray:
    """(n,) mean over the radius of the fastest joint's |dq/drho|, in deg/mm."""
    radii = np.linspace(40.0, 140.0, 200)
    tips = np.column_stack((radii, np.zeros((len(radii), 2))))
    joints = field.arm.complete(field.postures_at(tips)[0])
    return np.degrees(np.abs(np.gradient(joints, radii, axis=0)).max(axis=1))


def sideways(field: PostureField) -> FloatArray:
    """(n,) rms of how far a degree of error of each joint moves the tip across the paper, in mm, by differences."""
    radii = np.linspace(40.0, 140.0, 30)
    tips = np.column_stack((radii, np.zeros((len(radii), 2))))
    arm = field.arm
    joints = arm.complete(field.postures_at(tips)[0])
    kinematics = kinematics_of(arm)
    jacobian = kinematics.jacobian(joints)[:, :2] * np.radians(1)
    mean: FloatArray = np.sqrt((jacobian ** 2).sum(axis=(1, 2)))
    return mean


def test_time_makes_the_fastest_joint_slower(arm: Arm) -> None:
    assert slopes(posture_field(arm, TIME)).mean() < 0.95 * slopes(posture_field(arm, SENSITIVITY)).mean()


def test_sensitivity_makes_the_tip_steadier(arm: Arm) -> None:
    assert sideways(posture_field(arm, SENSITIVITY)).mean() < 0.97 * sideways(posture_field(arm, TIME)).mean()


def test_limits_keep_postures_nearer_the_middle_of_their_ranges(arm: Arm) -> None:
    def spread(field: PostureField) -> float:
        joints = arm.complete(field.postures)
        return float((((joints - (arm.maximum + arm.minimum) / 2) / (arm.maximum - arm.minimum)) ** 2).mean())
    assert spread(posture_field(arm, LIMITS)) < spread(posture_field(arm, SENSITIVITY))


def test_numbers_and_symbols_agree(arm: Arm) -> None:
    kinematics = kinematics_of(arm)
    cost = PostureCost(kinematics, PostureWeights(), 300.0, 150.0)
    postures = np.random.default_rng(1).uniform(-1, 1, (5, kinematics.n_free))
    symbol = casadi.Function("cost", [kinematics.free], [cost.posture_symbol()])
    np.testing.assert_allclose(cost.postures(postures), [float(symbol(posture)) for posture in postures])
    steps = np.random.default_rng(2).uniform(0.05, 0.2, (4, arm.n_joints))
    symbols = casadi.SX.sym("steps", arm.n_joints, 4)
    smooth = casadi.Function("steps", [symbols], [cost.steps_symbol(symbols, np.full(4, 6.0))])
    np.testing.assert_allclose(np.array(smooth(steps.T)).ravel(), cost.steps(steps, 6.0), rtol=0.3)
