"""Curves of servos, and the chain with its derivatives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.compensation.servo_values import pulse_calibration
from hardware.motion.tip import link_nodes_mm
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arms.paper_pose import PaperPose
from planner.arms.rigid_transform import RigidTransform
from planner.error_model.believed import arm_of, believed
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.chain import tips
from planner.error_model.curve import smooth_curve
from planner.error_model.model import Told, tips_at

PAPER = PaperPose(5.0, -3.0, 1.5, 0.02, -0.01, 0.015)


def with_origins(arm: Arm) -> Arm:
    """The arm with the frames that robot descriptions have beside the rows of a table."""
    moved = RigidTransform(5.0, -3.0, 8.0, 0.3, -0.2, 1.1)
    return replace(arm, tool=moved, joints=tuple(replace(joint, origin=moved) for joint in arm.joints))


def test_a_straight_line_stays_one_and_tells_back() -> None:
    curve = smooth_curve(np.array([[-2.0, 2600.0], [2.0, 600.0]]), -1.5, 1.5, 1.0)
    told = np.linspace(700.0, 2500.0, 20)  # beyond the curve's own range, too
    np.testing.assert_allclose(curve.position(told), (1600.0 - told) / 500.0, atol=1e-9)
    np.testing.assert_allclose(curve.told(curve.position(told)), told, atol=1e-6)
    assert curve.is_monotone


def test_a_jagged_table_is_smoothed_and_a_smooth_one_is_kept() -> None:
    position = np.linspace(-1.0, 1.0, 41)
    told = 1500 + 600 * position + 40 * np.sin(2 * position)
    noise = np.random.default_rng(0).normal(0, 12.0, len(told))  # of 0.02 rad
    smooth = smooth_curve(np.column_stack((position, told)), -0.9, 0.9, 1.0)
    rough = smooth_curve(np.column_stack((position, told + noise)), -0.9, 0.9, 1.0)
    inside = np.abs(position) < 0.85
    assert np.abs(smooth.position(told) - position)[inside].max() < 5e-4
    assert np.sqrt(np.mean((rough.position(told) - position)[inside] ** 2)) < 0.5 * 0.02


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_an_arm_is_as_it_was_believed_to_be(seed: int) -> None:
    arm = with_origins(replace(load_arm("drawing_arm_2022"), paper=PAPER))
    random = np.random.default_rng(seed)
    joints = random.uniform(arm.minimum, arm.maximum, (4, arm.n_joints))
    model = believed(arm)
    np.testing.assert_allclose(tips(model.geometry, joints).tip_mm, link_nodes_mm(arm, joints)[:, -1], atol=1e-9)
    again = arm_of(model, arm)
    np.testing.assert_allclose(link_nodes_mm(again, joints), link_nodes_mm(arm, joints), atol=1e-9)
    told = pulse_calibration(again).to_servos(joints)
    back = np.column_stack([curve.position(told[:, k]) for k, curve in enumerate(model.curves)])
    np.testing.assert_allclose(back, joints, atol=2e-3)
    assert (again.minimum == arm.minimum).all() and (again.maximum == arm.maximum).all()
    room = 0.01  # rad, beyond the limits: a correction there is within reach
    pulse_calibration(again).to_servos(np.stack((arm.minimum - room, arm.maximum + room)))


@pytest.mark.parametrize("name", ["drawing_arm_2022", "so101"])
def test_the_jacobian_is_the_finite_difference(name: str) -> None:
    arm = with_origins(replace(load_arm(name), paper=PAPER))
    prior = believed(arm)
    prior = replace(prior, slack=prior.slack + 0.01)
    parameters = Parameters.of(prior, arm)
    random = np.random.default_rng(1)
    way = random.uniform(arm.minimum, arm.maximum, (30, arm.n_joints))
    told = Told.of(np.column_stack([curve.told(way[:, k]) for k, curve in enumerate(prior.curves)]), np.arange(5, 30))
    vector = 0.1 * parameters.sd * random.normal(size=len(parameters.sd))
    model = parameters.model(vector)
    jacobian = parameters.jacobian(model, *tips_at(model, told))
    for k, name_ in enumerate(parameters.names):
        step = np.zeros_like(vector)
        step[k] = 1e-6
        ahead, behind = (tips_at(parameters.model(vector + way * step), told)[0].tip_mm for way in (1, -1))
        np.testing.assert_allclose(jacobian[:, :, k], (ahead - behind) / 2e-6, atol=2e-3, err_msg=name_)
