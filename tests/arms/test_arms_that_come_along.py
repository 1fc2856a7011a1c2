"""The arm files: what their sources say, and that each arm has paper to draw on."""

from __future__ import annotations

import numpy as np
import pytest

from planner.arms.arm import JointKind, PenHold
from planner.arms.arm_file import known_arms
from planner.kinematics.frame_jacobian import chain_frames
from planner.workspace.canvas import usable_canvas
from tests.arms.chains import load_once, model_of

TAUGHT = {
    "scara": ("0 0 0 0", "100 100 0 0", PenHold.CONSTRUCTION),
    "stanford": ("90 -90 0 90 -90 0", "0 0 0 0 0 0", PenHold.TOOL_AXIS),
    "three_joint": ("90 0 0", "0 110 110", PenHold.FREE),
    "six_joint": ("-90 0 90 -90 90 0", "0 120 0 0 0 0", PenHold.TOOL_AXIS),
}


@pytest.mark.parametrize("name", known_arms())
def test_every_arm_has_a_canvas_and_configurations_within_limits(name: str) -> None:
    arm = load_once(name)
    canvas = usable_canvas(model_of(arm), arm.pen.lift_mm)
    assert canvas.width_mm >= 60
    assert canvas.height_mm >= 25
    tips = np.column_stack((canvas.corners_arm_mm, np.zeros(4)))
    for height in (0.0, arm.pen.lift_mm):
        configurations, kept = model_of(arm).configuration_map().configurations_at(tips + np.array([0.0, 0.0, height]))
        assert kept.all()
        pen = chain_frames(arm, arm.complete(configurations))[:, -1] @ [*arm.pen.tool_axis, 0.0]
        if arm.pen.hold is not PenHold.FREE:
            np.testing.assert_allclose(pen[:, :3], np.tile([0, 0, -1], (4, 1)), atol=2e-7)


@pytest.mark.parametrize("name", TAUGHT)
def test_the_documents_chains(name: str) -> None:
    arm = load_once(name)
    alpha_deg, a_mm, hold = TAUGHT[name]
    assert [round(float(np.degrees(joint.alpha_rad))) for joint in arm.joints] == list(map(int, alpha_deg.split()))
    assert [joint.a_mm for joint in arm.joints] == list(map(float, a_mm.split()))
    sliding = [joint.name for joint in arm.joints if joint.kind is JointKind.PRISMATIC]
    assert sliding == (["q3"] if name in ("scara", "stanford") else [])
    assert arm.pen.hold is hold
    assert arm.closed_form == name


def test_the_scara_s_speeds_are_as_1_to_2_to_3() -> None:
    speeds = load_once("scara").max_velocity[[0, 1, 3]]
    np.testing.assert_allclose(speeds / speeds[0], [1, 2, 3])


@pytest.mark.parametrize("name", [*TAUGHT, "so101"])
def test_full_acceleration_takes_a_twentieth_of_a_second(name: str) -> None:
    arm = load_once(name)
    np.testing.assert_allclose(arm.max_acceleration / arm.max_jerk, 0.05)


def _turn(axis: str, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    turn = np.eye(4)
    rows = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    turn[np.ix_(rows, rows)] = [[c, -s], [s, c]]
    return turn


def _shift(*by_mm: float) -> np.ndarray:
    shift = np.eye(4)
    shift[:3, 3] = by_mm
    return shift


def test_the_so101_is_the_published_chain() -> None:
    """Origins and turns of the joints as published (mm and roll, pitch, yaw), from the pan axis to the gripper frame,
    with shoulder_pan counted the other way round and the pen 30 mm beyond the gripper frame."""
    half = np.pi / 2
    published = [
        ((0, 0, 62.4), (np.pi, 0, -np.pi)),
        ((-30.3992, -18.2778, -54.2), (-half, -half, 0)),
        ((-112.57, -28.0, 0), (0, 0, half)),
        ((-134.9, 5.2, 0), (0, 0, -half)),
        ((0, -61.1, 18.1), (half, 0.0486795, np.pi)),
    ]
    gripper = _shift(-7.9, -0.218121, -98.1274) @ _turn("y", np.pi)
    arm = load_once("so101")
    joints = np.random.default_rng(8).uniform(arm.minimum, arm.maximum, (200, 5))
    frames = chain_frames(arm, joints)[:, -1]
    for configuration, frame in zip(joints * [-1, 1, 1, 1, 1], frames, strict=True):
        pose = np.eye(4)
        for (origin, (roll, pitch, yaw)), value in zip(published, configuration, strict=True):
            pose = pose @ _shift(*origin) @ _turn("z", yaw) @ _turn("y", pitch) @ _turn("x", roll) @ _turn("z", value)
        pose = pose @ gripper @ _shift(0, 0, 30.0)
        np.testing.assert_allclose(frame[:3, 3], pose[:3, 3], atol=1e-3)
        np.testing.assert_allclose(frame[:3, :3] @ arm.pen.tool_axis, pose[:3, 2], atol=1e-6)
