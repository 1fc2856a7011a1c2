"""The weights of the posture field do what their names say."""

from __future__ import annotations

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


def slopes_that_cost(arm: Arm, weights: PostureWeights, *speeds: float) -> float:
    """Cost density of a millimetre in which joints take these shares of the time that is typical of the arm."""
    cost = PostureCost(kinematics_of(arm), weights, 300.0, 150.0)
    steps = np.array([*speeds, *[0.0] * (arm.n_joints - len(speeds))]) * arm.max_velocity / 300.0
    return float(cost.steps(steps, 1.0))


def test_time_is_that_of_the_fastest_joint(arm: Arm) -> None:
    time = PostureWeights(1, 0, 0, 0)
    assert slopes_that_cost(arm, time, 0.5, 0.5, 0.5) == pytest.approx(slopes_that_cost(arm, time, 0.5))
    assert slopes_that_cost(arm, time, 1.0) == pytest.approx(4 * slopes_that_cost(arm, time, 0.5))


def test_one_joint_that_rests_is_worth_more_than_two_that_move_half_as_much(arm: Arm) -> None:
    turns = PostureWeights(0, 0, 1, 0)
    assert slopes_that_cost(arm, turns, 0.0, 1.0) < 0.9 * slopes_that_cost(arm, turns, 0.5, 0.5)
    assert slopes_that_cost(arm, turns, 0.4) > slopes_that_cost(arm, turns, 0.3) > slopes_that_cost(arm, turns) == 0.0


def test_reversals_let_a_joint_rest(arm: Arm) -> None:
    """Between its corners the field of a drawing arm has a joint at rest, and with time alone it has none."""
    def resting(weights: PostureWeights) -> float:
        radii = np.linspace(40.0, 140.0, 400)
        joints = arm.complete(posture_field(arm, weights).postures_at(
            np.column_stack((radii, np.zeros((len(radii), 2)))))[0])[:, 1:]
        slowest = np.degrees(np.abs(np.gradient(joints, radii, axis=0)).min(axis=1))
        return float((slowest < 0.01).mean())
    assert resting(PostureWeights(0.05, 0, 1, 0.1)) > 0.4
    assert resting(TIME) < 0.2
