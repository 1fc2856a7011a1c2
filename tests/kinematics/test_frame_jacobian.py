"""The Jacobian of any frame in any other, against difference quotients and the documents' SCARA."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.errors import UsageError
from planner.kinematics.frame_jacobian import chain_frames, frame_jacobian
from tests.arms.chains import chains, dh_frames, kinematics_of, load_once

SEEDS = st.integers(0, 2**32 - 1)


def some_joints(arm: Arm, seed: int, count: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-2, 2, (count, arm.n_joints))


@settings(max_examples=40, deadline=None)
@given(arm=chains(), seed=SEEDS, data=st.data())
def test_it_is_the_difference_quotient_of_the_frame_seen_from_the_other(
    arm: Arm, seed: int, data: st.DataObject
) -> None:
    of_frame, in_frame = (data.draw(st.integers(0, arm.n_joints)) for _ in range(2))
    joints = some_joints(arm, seed, 2)
    jacobian = frame_jacobian(arm, joints, of_frame, in_frame)
    assert jacobian.shape == (2, 6, arm.n_joints)
    step = 1e-5
    for index, configuration in enumerate(joints):
        frames = dh_frames(arm, configuration)
        np.testing.assert_allclose(chain_frames(arm, configuration[None])[0], frames, atol=1e-9)
        seen_from, rotation = frames[in_frame][:3, :3].T, frames[of_frame][:3, :3]
        for k in range(arm.n_joints):
            moved = step * np.eye(arm.n_joints)[k]
            slope = (
                dh_frames(arm, configuration + moved)[of_frame] - dh_frames(arm, configuration - moved)[of_frame]
            ) / (2 * step)
            spin = slope[:3, :3] @ rotation.T
            turn = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
            np.testing.assert_allclose(jacobian[index, :3, k], seen_from @ slope[:3, 3], atol=1e-6)
            np.testing.assert_allclose(jacobian[index, 3:, k], seen_from @ turn, atol=1e-8)


@pytest.mark.parametrize("name", ["drawing_arm", "scara", "stanford", "three_joint", "six_joint", "so101"])
def test_of_the_pen_in_the_base_it_is_the_symbolic_one(name: str) -> None:
    arm = load_once(name)
    joints = np.random.default_rng(1).uniform(arm.minimum, arm.maximum, (50, arm.n_joints))
    np.testing.assert_allclose(frame_jacobian(arm, joints), kinematics_of(arm).jacobian(joints), atol=1e-9)


@given(q1=st.floats(-3, 3), q2=st.floats(-3, 3), q4=st.floats(-3, 3))
def test_the_scara_s_in_frame_2_is_the_documents_(q1: float, q2: float, q4: float) -> None:
    """Document on the SCARA arm: frame 4 in frame 2."""
    arm = load_once("scara")
    a1, a2 = (joint.a_mm for joint in arm.joints[:2])
    printed = [
        [a1 * np.sin(q2), 0, 0, 0],
        [a1 * np.cos(q2) + a2, a2, 0, 0],
        [0, 0, 1, 0],
        [0, 0, 0, 0],
        [0, 0, 0, 0],
        [1, 1, 0, 1],
    ]
    found = frame_jacobian(arm, np.array([[q1, q2, -110.0, q4]]), of_frame=4, in_frame=2)
    np.testing.assert_allclose(found[0], printed, atol=1e-10)


def test_the_documents_small_step_at_a_right_angle() -> None:
    """(eps, -delta) in frame 2 at q2 = 90 degrees, heading kept: eps/a1, -delta/a2 - eps/a1, delta/a2."""
    arm = load_once("scara")
    a1, a2 = (joint.a_mm for joint in arm.joints[:2])
    eps, delta = 0.3, 0.2
    step = np.array([eps / a1, -delta / a2 - eps / a1, 0.0, delta / a2])
    jacobian = frame_jacobian(arm, np.array([[0.4, np.pi / 2, -110.0, 0.1]]), 4, 2)[0]
    np.testing.assert_allclose(jacobian @ step, [eps, -delta, 0, 0, 0, 0], atol=1e-12)


@pytest.mark.parametrize(("of_frame", "in_frame"), [(5, 0), (-1, 0), (4, 5), (4, -1)])
def test_a_frame_that_is_not_there_is_an_error(of_frame: int, in_frame: int) -> None:
    with pytest.raises(UsageError, match=r"frames 0 \(base\) to 4 \(tool\)"):
        frame_jacobian(load_once("scara"), np.zeros((1, 4)), of_frame, in_frame)
