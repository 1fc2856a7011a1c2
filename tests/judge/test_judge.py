"""The judge itself: true arms, and what they do with pulses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from tests.judge.playing import Record, play
from tests.judge.true_arm import TrueArm, random_arm
from tests.judge.verdict import judge

ARM = load_arm("drawing_arm_2022")


def true_arm(seed: int, **changes: FloatArray) -> TrueArm:
    return replace(random_arm(ARM, np.random.default_rng(seed)), **changes)


def record(pulses_us: FloatArray) -> Record:
    n = len(pulses_us)
    return Record(np.arange(n) / 100, np.zeros(n, dtype=np.int64), np.zeros((n, 2)), pulses_us)


def swept() -> FloatArray:
    """(n, n_joints) there, a rest, and half-way back, a rest."""
    way = np.concatenate((np.linspace(0, 1, 100), np.ones(100), np.linspace(1, 0.5, 50), np.full(100, 0.5)))
    ends = np.array([joint.servo.pulse_range_us for joint in ARM.joints if joint.servo is not None])
    low, high = ends.mean(axis=1) - 150, ends.mean(axis=1) + 150
    return low + way[:, None] * (high - low)


@pytest.mark.parametrize("seed", [0, 1])
def test_joints_come_to_rest_on_the_near_edge_of_play_and_dead_band(seed: int) -> None:
    arm, pulses = true_arm(seed), swept()
    joints = play(arm, record(pulses), np.array([1.9, 3.4]))
    wanted = arm.angles(np.round(2 * pulses[[190, 340]]) / 2)
    slack = (arm.play_low + arm.play_high) / 2 + arm.dead_band
    way = np.sign(wanted[0] - arm.angles(pulses[:1])[0])
    np.testing.assert_allclose(joints[0], wanted[0] - way * slack, atol=1e-4)
    np.testing.assert_allclose(joints[1], wanted[1] + way * slack, atol=1e-4)


def test_gravity_keeps_a_joint_on_one_side() -> None:
    arm = random_arm(ARM, np.random.default_rng(2), gravity=("q2",))
    joints = play(arm, record(swept()), np.array([1.9, 3.4]))[:, 1]
    wanted = arm.angles(swept()[[190, 340]])[:, 1]
    offsets = joints - wanted + arm.play_low[1]
    np.testing.assert_allclose(np.abs(offsets), arm.dead_band[1], atol=2e-3)


def test_an_arm_without_errors_draws_what_is_meant() -> None:
    nothing = np.zeros(ARM.n_joints)
    arm = true_arm(3, play_low=nothing, play_high=nothing, dead_band=nothing, lag_s=nothing + 1e-4)
    pulses = np.repeat(swept()[150:151], 60, axis=0)
    tips = arm.tip_mm(play(arm, record(pulses), np.array([0.3])))
    arm = replace(
        arm,
        T_sheet_base=np.block(
            [
                [arm.T_sheet_base[:3, :3], (arm.T_sheet_base[:3, 3] - [0, 0, tips[0, 2]])[:, None]],
                [np.zeros((1, 3)), np.ones((1, 1))],
            ]
        ),
    )
    meant = replace(record(pulses), meant_mm=np.repeat(tips[:, :2], 60, axis=0))
    verdict = judge(arm, meant)
    assert verdict.rms < 0.05
    assert verdict.missing == verdict.crushed == 0.0


def straight_line_residual_deg(arm: Arm, true: TrueArm, joint: int) -> float:
    limits = arm.joints[joint]
    pulses = true.middle_us + np.linspace(-1, 1, 81)[:, None] * true.half_us
    angles = true.angles(pulses)[:, joint]
    line = np.polyfit(pulses[:, joint], angles, 1)
    assert limits.maximum > limits.minimum
    return float(np.degrees(np.sqrt(np.mean((angles - np.polyval(line, pulses[:, joint])) ** 2))))


def test_curves_are_as_far_from_straight_as_servos_are() -> None:
    residuals = [straight_line_residual_deg(ARM, true_arm(seed), joint) for seed in range(6) for joint in range(5)]
    assert min(residuals) > 0.39 and max(residuals) < 1.31
