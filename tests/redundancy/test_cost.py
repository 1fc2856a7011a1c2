"""The weights of the configuration map do what their names say."""

from __future__ import annotations

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.redundancy.cost import ConfigurationCost
from planner.redundancy.ring_map import RingMap
from planner.settings import ConfigurationWeights
from tests.arms.chains import kinematics_of, load_once, model_of

TIME, SENSITIVITY, LIMITS = (
    ConfigurationWeights(1, 0, 0, 0.1),
    ConfigurationWeights(0.05, 1, 0, 0.1),
    ConfigurationWeights(0.05, 0, 0, 1),
)


@pytest.fixture(scope="module")
def arm() -> Arm:
    return load_once("drawing_arm")


def slopes(configuration_map: RingMap) -> FloatArray:
    """(n,) mean over the radius of the fastest joint's |dq/drho|, in deg/mm."""
    radii = np.linspace(40.0, 140.0, 200)
    tips = np.column_stack((radii, np.zeros((len(radii), 2))))
    joints = configuration_map.arm.complete(configuration_map.configurations_at(tips)[0])
    return np.degrees(np.abs(np.gradient(joints, radii, axis=0)).max(axis=1))


def drawn_error(configuration_map: RingMap) -> float:
    """Mean over the radius of the square of the tip's way, height counted by half, that joints add by running late and
    by standing wrong at rest; by differences."""
    radii = np.linspace(configuration_map.radii_mm[0] + 2.0, configuration_map.radii_mm[-1] - 10.0, 200)
    tips = np.column_stack((radii, np.zeros((len(radii), 2))))
    arm = configuration_map.arm
    joints = arm.complete(configuration_map.configurations_at(tips)[0])
    slope = np.gradient(joints, radii, axis=0)
    moved = kinematics_of(arm).jacobian(joints)[:, :3] * np.array([[1.0], [1.0], [0.5]])
    at_rest = 2.5 / configuration_map.radii_mm[-1]
    return float(((moved**2).sum(axis=1) * (slope**2 + at_rest**2)).sum(axis=1).mean())


def test_time_makes_the_fastest_joint_slower(arm: Arm) -> None:
    assert (
        slopes(model_of(arm).configuration_map(TIME)).mean()
        < 0.95 * slopes(model_of(arm).configuration_map(SENSITIVITY)).mean()
    )


@pytest.mark.parametrize("name", ["drawing_arm", "so101"])
def test_sensitivity_makes_joints_spoil_less(name: str) -> None:
    def error(weights: ConfigurationWeights) -> float:
        return drawn_error(model_of(load_once(name)).configuration_map(weights))

    assert error(SENSITIVITY) < 0.995 * error(TIME)
    assert error(SENSITIVITY) < 0.98 * error(ConfigurationWeights(0.05, 0, 1, 0.1))
    assert error(ConfigurationWeights()) < error(TIME)


def test_limits_keep_configurations_nearer_the_middle_of_their_ranges(arm: Arm) -> None:
    def spread(configuration_map: RingMap) -> float:
        joints = arm.complete(configuration_map.configurations)
        return float((((joints - (arm.maximum + arm.minimum) / 2) / (arm.maximum - arm.minimum)) ** 2).mean())

    assert spread(model_of(arm).configuration_map(LIMITS)) < spread(model_of(arm).configuration_map(SENSITIVITY))


def slopes_that_cost(arm: Arm, weights: ConfigurationWeights, *speeds: float, tip_mm: float = 0.0) -> float:
    """Cost density of a millimetre in which joints take these shares of the time that is typical of the arm, each
    moving the tip by so much a radian."""
    cost = ConfigurationCost(kinematics_of(arm), weights, 300.0, 150.0)
    steps = np.array([*speeds, *[0.0] * (arm.n_joints - len(speeds))]) * arm.max_velocity / 300.0
    return float(cost.steps(steps, 1.0, np.full(arm.n_joints, tip_mm**2)))


def test_time_is_that_of_the_fastest_joint(arm: Arm) -> None:
    time = ConfigurationWeights(1, 0, 0, 0)
    assert slopes_that_cost(arm, time, 0.5, 0.5, 0.5) == pytest.approx(slopes_that_cost(arm, time, 0.5))
    assert slopes_that_cost(arm, time, 1.0) == pytest.approx(4 * slopes_that_cost(arm, time, 0.5))


def test_one_joint_that_rests_is_worth_more_than_two_that_move_half_as_much(arm: Arm) -> None:
    turns = ConfigurationWeights(0, 0, 1, 0)
    assert slopes_that_cost(arm, turns, 0.0, 1.0) < 0.9 * slopes_that_cost(arm, turns, 0.5, 0.5)
    assert slopes_that_cost(arm, turns, 0.4) > slopes_that_cost(arm, turns, 0.3) > slopes_that_cost(arm, turns) == 0.0


def test_a_joint_spoils_the_more_the_further_it_moves_the_tip(arm: Arm) -> None:
    drawn = ConfigurationWeights(0, 1, 0, 0)
    still = slopes_that_cost(arm, drawn, 0.5)
    near, far = (slopes_that_cost(arm, drawn, 0.5, tip_mm=tip_mm) - still for tip_mm in (50.0, 100.0))
    assert far == pytest.approx(4 * near)
    against = slopes_that_cost(arm, drawn, 0.5, 0.5, tip_mm=50.0) - slopes_that_cost(arm, drawn, 0.5, 0.5)
    assert against == pytest.approx(near * (1 + (arm.max_velocity[1] / arm.max_velocity[0]) ** 2))


def test_reversals_let_a_joint_rest(arm: Arm) -> None:
    """Between its corners the map of a drawing arm has a joint at rest, and with time alone it has none."""

    def resting(weights: ConfigurationWeights) -> float:
        radii = np.linspace(40.0, 140.0, 400)
        joints = arm.complete(
            model_of(arm)
            .configuration_map(weights)
            .configurations_at(np.column_stack((radii, np.zeros((len(radii), 2)))))[0]
        )[:, 1:]
        slowest = np.degrees(np.abs(np.gradient(joints, radii, axis=0)).min(axis=1))
        return float((slowest < 0.01).mean())

    assert resting(ConfigurationWeights(0.05, 0, 1, 0.1)) > 0.4
    assert resting(TIME) < 0.2
