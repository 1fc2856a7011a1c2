"""Forward kinematics and Jacobians of every arm against an independent library, Pinocchio, on the same DH tables."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from planner.arms.arm import Arm, JointKind
from planner.arms.arm_file import known_arms
from planner.arrays import FloatArray
from planner.kinematics.frame_jacobian import chain_frames, frame_jacobian
from tests.arms.chains import kinematics_of, load_once, random_configurations

EXACT = 1e-9
COUNT = 40


@pytest.fixture(params=known_arms())
def arm(request: pytest.FixtureRequest) -> Arm:
    return load_once(request.param)


def model_of(arm: Arm) -> tuple[pin.Model, list[int]]:
    """The chain in millimetres, and the frame after each DH row. A joint turns about its z or slides along it, and
    commutes with the row's own turn and shift about that axis: the row is fixed behind the joint."""
    model, frames = pin.Model(), []
    parent, behind = 0, pin.SE3.Identity()
    for joint in arm.joints:
        kind = pin.JointModelRZ() if joint.kind is JointKind.REVOLUTE else pin.JointModelPZ()
        parent = model.addJoint(parent, kind, behind, joint.name)
        behind = pin.SE3(pin.rpy.rotate("z", joint.theta_rad), np.array([0.0, 0.0, joint.d_mm])) * pin.SE3(
            pin.rpy.rotate("x", joint.alpha_rad), np.array([joint.a_mm, 0.0, 0.0])
        )
        frames.append(model.addFrame(pin.Frame(f"after {joint.name}", parent, 0, behind, pin.FrameType.OP_FRAME)))
    return model, frames


def configurations(arm: Arm) -> FloatArray:
    """All joints, mimic ones as their couplings have them."""
    return arm.complete(random_configurations(arm, 12, COUNT))


def test_frames(arm: Arm) -> None:
    model, frames = model_of(arm)
    data = model.createData()
    joints = configurations(arm)
    ours = chain_frames(arm, joints)
    kinematics = kinematics_of(arm)
    poses = kinematics.pose(kinematics.independent_of(joints))
    for configuration, chain, pose in zip(joints, ours, poses, strict=True):
        pin.framesForwardKinematics(model, data, configuration)
        theirs = np.array([data.oMf[frame].homogeneous for frame in frames])
        np.testing.assert_allclose(chain[1:], theirs, rtol=0, atol=EXACT)
        np.testing.assert_allclose(pose, theirs[-1], rtol=0, atol=EXACT)


def test_jacobians_of_every_frame_in_every_frame(arm: Arm) -> None:
    """Joints independent, couplings or not."""
    model, frames = model_of(arm)
    data = model.createData()
    joints = np.random.default_rng(13).uniform(arm.minimum, arm.maximum, (COUNT, arm.n_joints))
    ours = {
        (of, seen): frame_jacobian(arm, joints, of + 1, seen + 1)
        for of in range(arm.n_joints)
        for seen in range(-1, arm.n_joints)
    }
    symbolic = kinematics_of(arm).jacobian(joints)
    for index, configuration in enumerate(joints):
        pin.computeJointJacobians(model, data, configuration)
        pin.updateFramePlacements(model, data)
        turns = [np.eye(3), *(data.oMf[frame].rotation for frame in frames)]
        for of, frame in enumerate(frames):
            in_base = pin.getFrameJacobian(model, data, frame, pin.LOCAL_WORLD_ALIGNED)
            for seen in range(-1, arm.n_joints):
                theirs = np.kron(np.eye(2), turns[seen + 1].T) @ in_base
                np.testing.assert_allclose(ours[of, seen][index], theirs, rtol=0, atol=EXACT)
        np.testing.assert_allclose(symbolic[index], in_base, rtol=0, atol=EXACT)
