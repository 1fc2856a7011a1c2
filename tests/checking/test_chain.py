"""The check's forward kinematics against products of 4x4 matrices and against geometry."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arms.arm import Arm, Coupling, Joint, JointKind, PenHold
from planner.arms.rigid_transform import IDENTITY, RigidTransform
from planner.arrays import FloatArray
from planner.checking.chain import chain_poses
from planner.checking.check import check_trajectory
from planner.trajectory import TRAVELLING, Trajectory
from tests.arms.chains import transform_matrix
from tests.checking.rig import AFFINE, RATE_HZ, arm_of, gantry, joint, with_limit

angles = st.floats(-pi, pi)
lengths = st.sampled_from([0.0, 0.0, 30.0, -12.5, 50.0])
transforms = st.just(IDENTITY) | st.builds(RigidTransform, lengths, lengths, lengths, angles, angles, angles)


@st.composite
def arms(draw: st.DrawFn) -> Arm:
    rows = [
        joint(f"q{index}", draw(st.sampled_from(JointKind)), draw(angles), draw(lengths), draw(lengths), draw(angles))
        for index in range(draw(st.integers(1, 7)))
    ]
    moved = [replace(row, origin=draw(transforms)) for row in rows]
    return replace(arm_of(*moved, tool_axis=(0.6, 0.0, -0.8)), tool=draw(transforms))


def rotation_z(angle: float) -> FloatArray:
    return np.array([[cos(angle), -sin(angle), 0, 0], [sin(angle), cos(angle), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def rotation_x(angle: float) -> FloatArray:
    return np.array([[1, 0, 0, 0], [0, cos(angle), -sin(angle), 0], [0, sin(angle), cos(angle), 0], [0, 0, 0, 1]])


def shift(x: float, z: float) -> FloatArray:
    matrix = np.eye(4)
    matrix[:3, 3] = x, 0, z
    return matrix


def row(one: Joint, position: float) -> tuple[FloatArray, FloatArray]:
    """The row's transform up to Tz(d), and the rest of it."""
    slides = one.kind is JointKind.PRISMATIC
    turn, slide = (0.0, position) if slides else (position, 0.0)
    return rotation_z(one.theta_rad + turn) @ shift(0, one.d_mm + slide), shift(one.a_mm, 0) @ rotation_x(one.alpha_rad)


@given(arm=arms(), seed=st.integers(0, 2**32 - 1))
def test_poses_are_the_product_of_the_rows(arm: Arm, seed: int) -> None:
    positions = np.random.default_rng(seed).uniform(-3, 3, (4, arm.n_joints))
    poses = chain_poses(arm, positions)
    for index, configuration in enumerate(positions):
        pose, nodes = np.eye(4), [np.zeros(3)]
        for one, position in zip(arm.joints, configuration, strict=True):
            for part in (transform_matrix(one.origin), *row(one, position)):
                pose = pose @ part
                nodes.append(pose[:3, 3])
        pose = pose @ transform_matrix(arm.tool)
        np.testing.assert_allclose(poses.tip_mm[:, index], pose[:3, 3], atol=1e-10)
        np.testing.assert_allclose(poses.tool[:, index], pose[:3, :3] @ arm.pen.tool_axis, atol=1e-12)
        others = [node[2] for node in nodes if np.abs(node - pose[:3, 3]).max() > 1e-9]
        lowest = min(others, default=0.0)
        assert poses.lowest_mm[index] == pytest.approx(lowest, abs=1e-9) or poses.lowest_mm[index] == pytest.approx(
            min(lowest, pose[2, 3]), abs=1e-9
        )  # a joint may slide by nothing, and its node is then the tip


def five_joints(hold: PenHold = PenHold.COUPLING) -> Arm:
    links = [joint(f"q{index}", a=50.0, low=-pi, high=pi) for index in range(2, 6)]
    upright = Coupling(4, -pi / 2, ((1, -1.0), (2, -1.0), (3, -1.0)))
    return arm_of(
        joint("q1", d=50.0, alpha=pi / 2), *links, hold=hold, couplings=(upright,) if hold is PenHold.COUPLING else ()
    )


@given(st.tuples(*[angles] * 5))
def test_five_joints_by_their_formula(angles_rad: tuple[float, ...]) -> None:
    first, *others = angles_rad
    pitch = np.cumsum(others)
    radius, height = 50 * np.cos(pitch).sum(), 50 + 50 * np.sin(pitch).sum()
    poses = chain_poses(five_joints(), np.array([angles_rad]))
    np.testing.assert_allclose(
        poses.tip_mm[:, 0], [radius * cos(first), radius * sin(first), height], rtol=0, atol=1e-9
    )


def resting(arm: Arm, degrees: list[float], down: slice = slice(0)) -> Trajectory:
    pen = np.zeros(20, dtype=bool)
    pen[down] = True
    return Trajectory(
        "rig", "", "", RATE_HZ, arm.column_names, np.tile(degrees, (20, 1)), pen, np.where(pen, 0, TRAVELLING), AFFINE
    )


def found(trajectory: Trajectory, arm: Arm) -> set[str]:
    """The faults, but for the one that they all have: an arm that never moves does not lift the pen."""
    return {finding.check for finding in check_trajectory(trajectory, arm).faults} - {"pen as the tip"}


def test_a_coupling_off_by_a_little_is_found() -> None:
    arm = five_joints()
    arm = replace(arm, joints=tuple(replace(one, maximum=pi, minimum=-pi) for one in arm.joints))
    configuration = [20.0, 90.0, -70.0, -60.0, -50.0]
    assert not found(resting(arm, configuration), arm)
    assert not found(resting(arm, [*configuration[:4], -50.00009]), arm)
    assert found(resting(arm, [*configuration[:4], -50.00011]), arm) == {"coupling"}
    assert found(resting(arm, [20.0, 90.0, -70.0, -59.9998, -50.0]), arm) == {"coupling"}


def test_a_tilted_pen_is_found_where_it_has_to_be_upright() -> None:
    arm = arm_of(joint("q1", a=60.0), joint("q2", alpha=pi / 2, d=30.0), joint("q3", a=30.0), hold=PenHold.TOOL_AXIS)
    tilted = 2.0
    lower = replace(arm.joints[1], d_mm=30 * cos(np.radians(tilted)))
    leaning = replace(arm, joints=(arm.joints[0], lower, arm.joints[2]))
    down = slice(5, 9)
    assert not found(resting(arm, [10.0, 30.0, -90.0], down), arm)
    assert found(resting(leaning, [10.0, 30.0, -90.0 + tilted], down), leaning) == {"pen upright on the paper"}
    assert not found(resting(leaning, [10.0, 30.0, -90.0 + tilted]), leaning)
    free = replace(leaning, pen=replace(leaning.pen, hold=PenHold.FREE))
    assert not found(resting(free, [10.0, 30.0, -90.0 + tilted], down), free)


def test_a_link_through_the_paper_is_found() -> None:
    arm = arm_of(joint("q1", alpha=pi / 2), joint("q2", a=50.0), joint("q3", a=50.0), hold=PenHold.FREE)
    assert not found(resting(arm, [0.0, 40.0, 20.0]), arm)
    assert found(resting(arm, [0.0, -10.0, 100.0]), arm) == {"links below the paper"}


def test_a_slide_below_its_limit_is_named() -> None:
    arm = with_limit(gantry(), "h", minimum=26.0)
    check_result = check_trajectory(resting(arm, [25.0, 0.0, 0.0]), arm)
    finding, between = check_result.faults
    assert between.check == "position between samples"
    assert (finding.check, finding.worst, finding.unit) == ("position", 25.0, "mm")
    assert finding.limit == 26.0
