"""Small steps of the tool and of the joints, and the types of singularities."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from planner.arms.arm import Arm
from planner.arms.rigid_transform import RigidTransform
from planner.cli import main
from planner.kinematics.escape import Escape, escape
from planner.kinematics.frame_jacobian import frame_jacobian
from planner.kinematics.small_step import rotation_vector, step_of_joints, step_of_tool
from tests.arms.chains import chains, load_once, random_configurations, transform_matrix


def test_the_documents_last_scara_example() -> None:
    """At q2 = 90 deg, a step (eps, -delta) along the axes of frame 2, the heading kept."""
    arm = load_once("scara")
    a1, a2 = arm.joints[0].a_mm, arm.joints[1].a_mm
    eps, delta = 0.3, 0.7
    at = np.array([0.4, np.pi / 2, -110.0, -0.2])
    found = step_of_tool(arm, at, np.array([eps, -delta, 0, 0, 0, 0]), 2)
    np.testing.assert_allclose(found.joints, [eps / a1, -delta / a2 - eps / a1, 0, delta / a2], atol=1e-12)
    assert found.is_possible
    np.testing.assert_allclose(step_of_joints(arm, at, found.joints, 2).tool, [eps, -delta, 0, 0, 0, 0], atol=1e-12)
    tilted = step_of_tool(arm, at, np.array([0, 0, 0, 0.01, 0, 0.02]), 2)  # two freedoms that it does not have
    np.testing.assert_allclose(tilted.missing, [0, 0, 0, 0.01, 0, 0], atol=1e-12)
    stretched = step_of_tool(arm, np.array([0.4, 0.0, -110.0, -0.2]), np.array([eps, -delta, 0, 0, 0, 0]), 2)
    np.testing.assert_allclose(stretched.missing, [eps, 0, 0, 0, 0, 0], atol=1e-12)


@given(arm=chains(), seed=st.integers(0, 2**32 - 1), frame=st.integers(0, 7), rows=st.sampled_from([3, 6]))
def test_there_and_back(arm: Arm, seed: int, frame: int, rows: int) -> None:
    """What can be had of a step and what is missing make it up; what can be had can be had again."""
    in_frame = min(frame, arm.n_joints)
    at = arm.complete(random_configurations(arm, seed, 1))[0]
    wanted = np.random.default_rng(seed).normal(size=rows) * ([1.0] * 3 + [0.01] * 3)[:rows]
    found = step_of_tool(arm, at, wanted, in_frame)
    np.testing.assert_allclose((found.tool + found.missing)[:rows], wanted, atol=1e-6)
    matrix, _ = arm.coupling_matrix
    np.testing.assert_allclose(matrix @ found.joints[list(arm.independent_joints)], found.joints, atol=1e-9)
    again = step_of_tool(arm, at, found.tool[:rows], in_frame)
    np.testing.assert_allclose(again.joints, found.joints, atol=1e-5 * max(1.0, np.abs(found.joints).max()))
    jacobian = frame_jacobian(arm, at[None], None, in_frame)[0]
    np.testing.assert_allclose(step_of_joints(arm, at, found.joints, in_frame).tool, jacobian @ found.joints, atol=1e-9)


@given(arm=chains(), seed=st.integers(0, 2**32 - 1))
def test_the_linear_part_is_the_limit_of_what_the_tool_does(arm: Arm, seed: int) -> None:
    at = arm.complete(random_configurations(arm, seed, 1))[0]
    step = arm.coupling_matrix[0] @ np.random.default_rng(seed).uniform(-1e-5, 1e-5, len(arm.independent_joints))
    found = step_of_joints(arm, at, step)
    np.testing.assert_allclose(found.moved, found.tool, atol=1e-6)


@given(angles=st.tuples(*[st.floats(-1.2, 1.2)] * 3))
def test_a_rotation_vector_is_axis_and_angle(angles: tuple[float, float, float]) -> None:
    turn = transform_matrix(RigidTransform(0, 0, 0, *angles))[:3, :3]
    np.testing.assert_allclose(Rotation.from_rotvec(rotation_vector(turn)).as_matrix(), turn, atol=1e-9)


SINGULAR = {
    # The documents: of type 2, because a motion in the null space leaves it, by a change of q2.
    "stretched SCARA": ("scara", [0, 0, -110, 0], Escape(True, False, False)),
    "aligned wrist": ("six_joint", [0, 30, 20, 0, 0, 0], Escape(False, False, True)),
    "stretched three joints": ("three_joint", [20, 30, 0], Escape(True, False, False)),
    "tip on the base axis": ("three_joint", [20, 45, 90], Escape(False, False, True)),
    "four links in line, folded": ("drawing_arm", [0, 60, 180, -180], Escape(True, True, True)),
}


@pytest.mark.parametrize("kind", SINGULAR)
def test_types_of_singularities(kind: str) -> None:
    name, position, expected = SINGULAR[kind]
    arm = load_once(name)
    if name == "three_joint":  # links of one length, so that the tip comes to the axis
        arm = replace(arm, joints=(arm.joints[0], *(replace(joint, a_mm=100.0) for joint in arm.joints[1:])))
    at = np.array(position, dtype=float) * arm.per_file_unit[list(arm.independent_joints)]
    assert escape(arm, arm.complete(at)) == expected


def test_a_configuration_that_is_not_singular_has_no_type() -> None:
    arm = load_once("scara")
    assert escape(arm, arm.from_file_units([0.0, 40.0, -110.0, 0.0])) is None


def test_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["step", "--arm", "scara", "--at", "0", "0", "-110", "0", "--tool", "1", "0", "0", "--frame", "2"]) == 0
    said = capsys.readouterr().out
    for part in ("missing: x +1 mm", "impossible, in frame 2: vx", "type 2: motion in the null space leaves it"):
        assert part in said
    joints = ["--at", "0", "90", "-110", "0", "--frame", "tool", "--joints", "1", "-1", "2", "0"]
    assert main(["step", "--arm", "scara", *joints, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["asked"] is None and told["tool_step"]["z"] == 2 and told["possible"] and not told["singular"]
    assert main(["step", "--at", "0", "90", "-90", "-90", "--joints", "1", "0", "0", "0"]) == 0  # the coupling follows
    assert "q5 +0 deg" in capsys.readouterr().out
    at = ["step", "--arm", "scara", "--at", "0", "0", "-110", "0"]
    for wrong in (
        [],
        ["--tool", "1", "2"],
        ["--tool", "1", "0", "0", "--joints", "1", "0", "0", "0"],
        ["--joints", "1"],
        ["--tool", "1", "0", "0", "--frame", "9"],
        ["--tool", "nan", "0", "0"],
    ):
        assert main([*at, *wrong]) == 2
        assert len(capsys.readouterr().err.splitlines()) == 1
