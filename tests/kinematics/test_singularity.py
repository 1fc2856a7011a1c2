"""Null spaces, manipulability and the shapes of singular configurations: laws over every arm, and the documents'
SCARA."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.kinematics.frame_jacobian import frame_jacobian
from planner.kinematics.sensitivity import sideways_error, tip_sensitivity
from planner.kinematics.singular_shapes import singular_shapes
from planner.kinematics.singularity import manipulability, mobility, singularity
from tests.arms.chains import dh_frames, load_once

FREEDOM = {
    "drawing_arm": 3,
    "drawing_arm_2022": 3,
    "scara": 4,
    "stanford": 6,
    "three_joint": 3,
    "six_joint": 6,
    "so101": 5,
}
SINGULAR = [
    ("scara", (0, 0, -120, 0), "links before and after q2 are stretched out"),
    ("three_joint", (20, 40, 0), "links before and after q3 are stretched out"),
    ("three_joint", (20, 30, 120), "tip is on the axis of q1"),
    ("three_joint", (20, 22.5, -135), None),
    ("six_joint", (5, -40, 90, 10, 30, 0), "links before and after q3 are stretched out"),
    ("six_joint", (5, -40, 190, 10, 0, 0), "axes of q4 and q6 coincide"),
    ("six_joint", (5, -60, 270, 10, 30, 0), "centre of the wrist is on the axis of q1"),
    ("six_joint", (5, -60, 220, 10, 30, 0), None),
    ("stanford", (5, -120, 200, 10, 0, 0), "axes of q4 and q6 coincide"),
    ("stanford", (5, -180, 200, 10, 30, 0), "slide of q3 is parallel to the axis of q1"),
    ("stanford", (5, -120, 200, 10, 30, 0), None),
    ("drawing_arm", (30, 10, 0, 0, -100), "links before and after q3 are stretched out"),
    ("so101", (0, 76.032, -73.8245, 40, 10), "links before and after elbow_flex are stretched out"),
    ("scara", (0, 180, -120, 0), "links before and after q2 are folded onto each other"),
]


@pytest.fixture(params=FREEDOM)
def any_arm(request: pytest.FixtureRequest) -> Arm:
    return load_once(request.param)


def test_freedom_is_what_the_chain_has(any_arm: Arm) -> None:
    assert mobility(any_arm).freedom == FREEDOM[any_arm.name]


def test_internal_motions_rest_and_impossible_velocities_never_come(any_arm: Arm) -> None:
    """In every frame, singular or not; dimensions add up, and couplings are kept."""
    random = np.random.default_rng(3)
    independent = random.uniform(any_arm.minimum, any_arm.maximum, (6, any_arm.n_joints))[
        :, list(any_arm.independent_joints)
    ]
    matrix, _ = any_arm.coupling_matrix
    configurations = [
        *any_arm.complete(independent),
        *(any_arm.from_file_units(positions) for name, positions, _ in SINGULAR if name == any_arm.name),
    ]
    for in_frame in (0, 1, any_arm.n_joints):
        for joints in configurations:
            found = singularity(any_arm, joints, None, in_frame)
            rows = list(found.mobility.rows)
            np.testing.assert_allclose(found.jacobian[rows] @ found.internal.T, 0, atol=1e-6)
            reachable = found.jacobian[rows] @ matrix
            np.testing.assert_allclose(found.impossible @ reachable, 0, atol=1e-6)
            assert len(found.internal) == len(any_arm.independent_joints) - found.rank
            assert len(found.impossible) == len(rows) - found.rank
            assert np.linalg.matrix_rank(found.internal) == len(found.internal)
            complete = found.internal[:, list(any_arm.independent_joints)] @ matrix.T
            np.testing.assert_allclose(found.internal, complete, atol=1e-12)


@pytest.mark.parametrize(("name", "positions", "shape"), SINGULAR)
def test_singular_configurations_are_known_by_their_shape(
    name: str, positions: tuple[float, ...], shape: str | None
) -> None:
    arm = load_once(name)
    joints = arm.from_file_units(positions)
    found = singularity(arm, joints)
    assert found.is_singular is (shape is not None)
    shapes = "; ".join(singular_shapes(arm, joints))
    assert (shape in shapes) if shape else shapes == ""
    assert bool(np.isinf(found.condition)) is found.is_singular


@given(q1=st.floats(-2, 2), q2=st.floats(-2.6, 2.6), in_frame=st.integers(0, 4))
def test_the_scara_s_manipulability_is_a1_a2_sin_q2(q1: float, q2: float, in_frame: int) -> None:
    arm = load_once("scara")
    a1, a2 = (joint.a_mm for joint in arm.joints[:2])
    joints = np.array([q1, q2, -110.0, 0.7])
    assert manipulability(arm, joints[None], 4, in_frame)[0] == pytest.approx(a1 * a2 * abs(np.sin(q2)), abs=1e-6)
    rows = frame_jacobian(arm, joints[None], 4, 2)[0][list(mobility(arm, 4, 2).rows)]
    assert np.linalg.det(rows) == pytest.approx(a1 * a2 * np.sin(q2), abs=1e-6)


def test_the_stretched_scara_s_null_spaces_are_the_documents_() -> None:
    """Internal motion [a2, -(a1 + a2), 0, a1] (where the document prints a plus), nothing along x of frame 2."""
    arm = load_once("scara")
    a1, a2 = (joint.a_mm for joint in arm.joints[:2])
    found = singularity(arm, np.array([0.3, 0.0, -110.0, 0.2]), 4, 2)
    (motion,), (velocity,) = found.internal, found.impossible
    np.testing.assert_allclose(motion, np.array([a2, -(a1 + a2), 0, a1]) / -(a1 + a2), atol=1e-9)
    np.testing.assert_allclose(velocity, [1, 0, 0, 0], atol=1e-9)
    printed = np.array([a2, a1 + a2, 0, a1])
    assert np.abs(found.jacobian @ printed).max() > 1.0


def test_joints_that_spin_the_pen_alone_are_told_alone() -> None:
    arm = load_once("six_joint")
    (motion,) = singularity(arm, arm.from_file_units((0, -40, 190, 0, 0, 0))).internal
    np.testing.assert_allclose(np.abs(motion), [0, 0, 0, 1, 0, 1], atol=1e-9)
    assert motion[3] == pytest.approx(-motion[5])


def test_tip_sensitivity_is_where_the_tip_goes_by_a_small_error(any_arm: Arm) -> None:
    joints = np.random.default_rng(5).uniform(any_arm.minimum, any_arm.maximum)
    sensitivity = tip_sensitivity(any_arm, joints[None])[0]
    error = 1e-4
    strayed = np.array(
        [
            dh_frames(any_arm, joints + error * any_arm.per_file_unit * one)[-1][:3, 3]
            for one in np.eye(any_arm.n_joints)
        ]
    )
    np.testing.assert_allclose(sensitivity.T * error, strayed - dh_frames(any_arm, joints)[-1][:3, 3], atol=1e-7)
    squares = sum(float(column[:2] @ column[:2]) for column in sensitivity.T)
    assert sideways_error(any_arm, joints[None])[0] == pytest.approx(np.sqrt(squares / any_arm.n_joints))
