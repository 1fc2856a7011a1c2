"""The documents' worked examples of the SCARA arm, with their errata: links of one length a."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.inverse_kinematics.closed_forms import scara
from planner.inverse_kinematics.closed_forms.branches import nearest
from planner.kinematics.joint_time import joint_time_s
from tests.arms.chains import kinematics_of
from tests.inverse_kinematics.closed_forms.arms import arm_of

A_MM = 100.0


@pytest.fixture(scope="module")
def arm() -> Arm:
    """The documents' chain: no base height, joint speeds 1, 2 and 3 rad/s."""
    given = arm_of("scara")
    speeds = (1.0, 2.0, 1000.0, 3.0)
    joints = tuple(
        replace(joint, d_mm=0.0, max_velocity=speed) for joint, speed in zip(given.joints, speeds, strict=True)
    )
    return replace(given, joints=joints)


def pose(x_mm: float, y_mm: float, z_mm: float, heading_rad: float) -> FloatArray:
    c, s = np.cos(heading_rad), np.sin(heading_rad)
    return np.array([[[c, -s, 0, x_mm], [s, c, 0, y_mm], [0, 0, 1, z_mm], [0, 0, 0, 1]]])


def jacobian_in_frame_2(arm: Arm, joints: FloatArray) -> FloatArray:
    """(6, 4) velocity of frame 4 along the axes of frame 2, which is the base turned by q1 + q2."""
    c, s = np.cos(joints[0] + joints[1]), np.sin(joints[0] + joints[1])
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    return np.kron(np.eye(2), turn) @ kinematics_of(arm).jacobian(joints[None])[0]


def test_both_solutions(arm: Arm) -> None:
    found = scara.at_pose(arm, pose(A_MM, A_MM, 0.0, 0.0)).configurations[0]
    np.testing.assert_allclose(found, [[0, pi / 2, 0, -pi / 2], [pi / 2, -pi / 2, 0, 0]], atol=1e-12)


def test_times_to_the_stretched_pose(arm: Arm) -> None:
    stretched = scara.at_pose(arm, pose(2 * A_MM, 0.0, 0.0, 0.0))
    assert stretched.singular.all()
    np.testing.assert_allclose(stretched.configurations[0], np.zeros((2, 4)), atol=1e-12)
    both = scara.at_pose(arm, pose(A_MM, A_MM, 0.0, 0.0))
    np.testing.assert_allclose(
        joint_time_s(arm, both.configurations[0], stretched.configurations[0, 0]), [pi / 4, pi / 2]
    )
    index, time_s = nearest(arm, both, np.zeros((1, 4)))
    assert index.tolist() == [0]
    np.testing.assert_allclose(time_s, pi / 4)


def test_jacobian_in_frame_2(arm: Arm) -> None:
    a1, a2 = arm.joints[0].a_mm, arm.joints[1].a_mm
    for joints in np.random.default_rng(1).uniform(-2, 2, (20, 4)):
        s2, c2 = np.sin(joints[1]), np.cos(joints[1])
        expected = [[a1 * s2, 0, 0, 0], [a1 * c2 + a2, a2, 0, 0], [0, 0, 1, 0], [0] * 4, [0] * 4, [1, 1, 0, 1]]
        jacobian = jacobian_in_frame_2(arm, joints)
        np.testing.assert_allclose(jacobian, expected, atol=1e-10)
        np.testing.assert_allclose(np.linalg.det(jacobian[[0, 1, 2, 5]]), a1 * a2 * s2, atol=1e-8)


def test_null_spaces_of_the_stretched_arm(arm: Arm) -> None:
    a1, a2 = arm.joints[0].a_mm, arm.joints[1].a_mm
    jacobian = jacobian_in_frame_2(arm, np.array([0.7, 0.0, 0.0, -0.4]))[[0, 1, 2, 5]]
    assert np.linalg.matrix_rank(jacobian) == 3
    np.testing.assert_allclose(jacobian @ [a2, -(a1 + a2), 0, a1], 0, atol=1e-9)
    assert np.abs(jacobian @ [a2, a1 + a2, 0, a1]).max() > 1  # the sign that is printed
    np.testing.assert_allclose([1, 0, 0, 0] @ jacobian, 0, atol=1e-12)


def test_small_step_with_the_heading_kept(arm: Arm) -> None:
    """At q2 = 90 degrees a tool step (eps, -delta) in frame 2 turns q1 by eps/a1, q2 by -delta/a2 - eps/a1 and q4
    by delta/a2, to first order: the closed form of the moved pose agrees to second."""
    a1, a2 = arm.joints[0].a_mm, arm.joints[1].a_mm
    start = np.array([[0.3, pi / 2, 0.0, -0.2]])
    eps, delta = 1e-3, 2e-3
    moved = kinematics_of(arm).pose(start)
    across = start[0, 0] + start[0, 1]
    c, s = np.cos(across), np.sin(across)
    moved[0, :2, 3] += eps * np.array([c, s]) - delta * np.array([-s, c])
    branches = scara.at_pose(arm, moved)
    index, _ = nearest(arm, branches, start)
    step = branches.configurations[0, index[0]] - start[0]
    np.testing.assert_allclose(step, [eps / a1, -delta / a2 - eps / a1, 0, delta / a2], atol=1e-8)
    assert np.abs(step).max() > 1e-5
