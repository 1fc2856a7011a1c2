"""Symbolic kinematics of any chain against matrix products, finite differences and the drawing arm's formulas."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm, Coupling, Joint, JointKind, Pen, PenHold, Workspace
from planner.kinematics.chain import Kinematics
from tests.arms.chains import (
    chains,
    dh_frames,
    dh_matrix,
    kinematics_of,
    load_once,
    random_configurations,
    tips_by_product,
    transform_matrix,
)

SEEDS = st.integers(0, 2**32 - 1)
built_anew = settings(max_examples=30, deadline=None)  # each example compiles a chain


@built_anew
@given(arm=chains(), seed=SEEDS)
def test_poses_and_nodes_are_those_of_the_matrix_product(arm: Arm, seed: int) -> None:
    kinematics = Kinematics(arm)
    independent = random_configurations(arm, seed, 3)
    poses, tips, nodes = kinematics.pose(independent), kinematics.tip_mm(independent), kinematics.nodes_mm(independent)
    for index, joints in enumerate(arm.complete(independent)):
        frames = dh_frames(arm, joints)
        np.testing.assert_allclose(poses[index], frames[-1], atol=1e-10)
        np.testing.assert_allclose(tips[index], frames[-1][:3, 3], atol=1e-10)
        corners, end = [], np.eye(4)
        for joint, value in zip(arm.joints, joints, strict=True):
            turn, slide = (value, 0.0) if joint.kind is JointKind.REVOLUTE else (0.0, value)
            start = end @ transform_matrix(joint.origin)
            corners += [start[:3, 3]] if joint.origin.length_mm else []
            corners.append((start @ [0, 0, joint.d_mm + slide, 1])[:3])
            end = start @ dh_matrix(joint.theta_rad + turn, joint.d_mm + slide, joint.a_mm, joint.alpha_rad)
            corners.append(end[:3, 3])
        corners += [frames[-1][:3, 3]] if arm.tool.length_mm else []
        np.testing.assert_allclose(nodes[index], corners, atol=1e-10)


@built_anew
@given(arm=chains(), seed=SEEDS)
def test_task_is_tip_and_pointing_and_its_jacobian_the_difference_quotient(arm: Arm, seed: int) -> None:
    """Pointing is the horizontal part of the axis, in as many components as it has; seen from the
    turning base where the arm turns over its paper."""
    kinematics = Kinematics(arm)
    independent = random_configurations(arm, seed, 30)
    task, jacobian = kinematics.task_and_jacobian(independent)
    assert jacobian.shape == (30, kinematics.n_task, kinematics.n_independent)
    axis = kinematics.tool_axis(independent)
    np.testing.assert_allclose(axis, kinematics.pose(independent)[:, :3, :3] @ np.array(arm.pen.tool_axis), atol=1e-12)
    np.testing.assert_allclose(task[:, :3], kinematics.tip_mm(independent), atol=1e-12)
    if arm.pen.hold is PenHold.TOOL_AXIS:
        turn = arm.complete(independent)[:, 0] if arm.joints[0].kind is JointKind.REVOLUTE else np.zeros(30)
        c, s = np.cos(turn), np.sin(turn)
        pointing = np.column_stack((c * axis[:, 0] + s * axis[:, 1], c * axis[:, 1] - s * axis[:, 0]))
        off = np.linalg.norm(task[:, 3:], axis=1) - np.linalg.norm(pointing, axis=1)
        assert np.abs(off).max() < 2e-4
        held = np.abs(pointing).max(axis=0) > 1e-4
        if kinematics.n_task == 3 + held.sum() and kinematics.turns_over_paper:
            np.testing.assert_allclose(task[:, 3:], pointing[:, held], atol=1e-12)
    step = 1e-5
    for k in range(kinematics.n_independent):
        moved = step * np.eye(kinematics.n_independent)[k]
        after, before = (kinematics.task_and_jacobian(independent + sign * moved)[0] for sign in (1, -1))
        slope = (after - before) / (2 * step)
        np.testing.assert_allclose(jacobian[:, :, k], slope, atol=1e-6)


@built_anew
@given(arm=chains(), seed=SEEDS)
def test_geometric_jacobian_gives_tip_velocity_and_turn_of_the_last_frame(arm: Arm, seed: int) -> None:
    """Of each joint for itself: couplings play no part in it. [w]x = dR/dq R^T."""
    joints = np.random.default_rng(seed).uniform(-2, 2, (2, arm.n_joints))
    jacobian = Kinematics(arm).jacobian(joints)
    assert jacobian.shape == (2, 6, arm.n_joints)
    step = 1e-5
    for index, configuration in enumerate(joints):
        rotation = dh_frames(arm, configuration)[-1][:3, :3]
        for k in range(arm.n_joints):
            moved = step * np.eye(arm.n_joints)[k]
            slope = (dh_frames(arm, configuration + moved)[-1] - dh_frames(arm, configuration - moved)[-1]) / (2 * step)
            spin = slope[:3, :3] @ rotation.T
            np.testing.assert_allclose(jacobian[index, :3, k], slope[:3, 3], atol=1e-6)
            np.testing.assert_allclose(jacobian[index, 3:, k], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-8)


def test_drawing_arms_hold_the_pen_upright_whatever_the_configuration(arm: Arm) -> None:
    independent = random_configurations(arm, 1, 200)
    poses = kinematics_of(arm).pose(independent)
    axis = poses[:, :3, :3] @ np.array(arm.pen.tool_axis)
    np.testing.assert_allclose(axis, np.tile([0, 0, -1], (200, 1)), atol=1e-12)
    np.testing.assert_allclose(arm.complete(independent)[:, 1:].sum(axis=1), -np.pi / 2, atol=1e-12)


def test_drawing_arms_are_redundant_by_one(arm: Arm) -> None:
    kinematics = kinematics_of(arm)
    assert (arm.n_joints, kinematics.n_independent, kinematics.n_task, kinematics.n_redundant) == (5, 4, 3, 1)
    target = np.array([[90.0, 10.0, 0.0], [80.0, -5.0, 2.0]])
    np.testing.assert_array_equal(kinematics.task_target(target), target)


def test_tip_of_the_arm_with_a_pen_beside_its_plane() -> None:
    """x = rho c1 + D s1, y = rho s1 - D c1 for a pen D to the side."""
    arm = load_once("drawing_arm_2022")
    q1, *bends = random_configurations(arm, 2, 100).T
    pitch = np.cumsum(bends, axis=0)
    rho = 50.0 * np.cos(pitch).sum(axis=0)
    height = 50.0 + 50.0 * np.sin(pitch).sum(axis=0) - 37.0
    expected = np.column_stack((rho * np.cos(q1) - 27.0 * np.sin(q1), rho * np.sin(q1) + 27.0 * np.cos(q1), height))
    np.testing.assert_allclose(kinematics_of(arm).tip_mm(np.column_stack((q1, *bends))), expected, atol=1e-9)


def test_any_number_of_configurations_at_once(arm: Arm) -> None:
    """Compiled functions work in blocks: none, part of one, and several give the same rows."""
    kinematics = kinematics_of(arm)
    independent = random_configurations(arm, 3, 700)
    tips = kinematics.tip_mm(independent)
    assert kinematics.tip_mm(independent[:0]).shape == (0, 3)
    np.testing.assert_array_equal(kinematics.tip_mm(independent[255:258]), tips[255:258])
    np.testing.assert_allclose(tips, tips_by_product(arm, arm.complete(independent)), atol=1e-9)


def test_independent_joints_of_complete_configurations_are_the_independent_joints(arm: Arm) -> None:
    independent = random_configurations(arm, 4, 10)
    np.testing.assert_array_equal(kinematics_of(arm).independent_of(arm.complete(independent)), independent)


def test_a_single_independent_joint_has_a_jacobian_of_one_column() -> None:
    hinge = Joint("hinge", JointKind.REVOLUTE, 0.0, 0.0, 40.0, 0.0, -1.0, 1.0, 1.0, 1.0, 1.0)
    arm = Arm(
        "hinge",
        "made for tests",
        (hinge, replace(hinge, name="follower")),
        (Coupling(1, 0.0, ((0, -1.0),)),),
        Pen(PenHold.COUPLING, (0.0, 0.0, -1.0), 5.0, 1.0),
        Workspace(0.0, 1.0),
    )
    task, jacobian = Kinematics(arm).task_and_jacobian(np.array([[0.0], [np.pi / 2]]))
    np.testing.assert_allclose(task, [[80, 0, 0], [40, 40, 0]], atol=1e-12)
    np.testing.assert_allclose(jacobian, [[[0], [40], [0]], [[-40], [0], [0]]], atol=1e-12)
