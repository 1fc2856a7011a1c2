"""Drivers of bus servos against models of two languages that take no wrong byte."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hardware.drivers.driver import Driver, Measuring
from hardware.drivers.table import make_driver
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.errors import HardwareError
from tests.hardware.controllers.bench import Bench
from tests.hardware.controllers.bus import BusModel, DynamixelModel, FeetechModel

ARM = load_arm("so101")
POSE = ARM.from_file_units([10.0, -20.0, 30.0, 40.0, -50.0])
COUNTS = {1: 2048 - 114, 2: 2048 - 228, 3: 2048 + 341, 4: 2048 + 455, 5: 2048 - 569}
REST = {1: 2048, 2: 920, 3: 3145, 4: 2700, 5: 2048}

BUSES = pytest.mark.parametrize(("name", "kind"), [("feetech", FeetechModel), ("dynamixel", DynamixelModel)])


def _driver(name: str, far: Bench, arm: Arm = ARM) -> Driver:
    return make_driver(name, arm, far, far)


def _stream(driver: Driver) -> None:
    """Ten seconds at rest."""
    for _ in range(500):
        driver.send(POSE, 0.02)
        driver.flush()


@BUSES
def test_servos_glide_from_where_they_stand_to_the_pose_and_follow(name: str, kind: type[BusModel]) -> None:
    model = kind(REST)
    far = Bench(model)
    driver = _driver(name, far)
    driver.connect(POSE)
    assert model.goals[0] == REST
    assert model.goals[-1] == COUNTS
    sent = np.array([[goals[servo] for servo in COUNTS] for goals in model.goals])
    # A fifth of 200 deg/s, of 4096 counts a turn.
    assert np.abs(np.diff(sent, axis=0)).max() <= 40 * 0.02 * 4096 / 360 + 1
    moved = POSE.copy()
    moved[3] += np.radians(2.0)
    driver.send(moved, 0.02)
    driver.flush()
    driver.close()
    assert model.goals[-1] == {**COUNTS, 4: 2048 + 478}


def test_bytes_of_a_set_point() -> None:
    model = FeetechModel(REST)
    far = Bench(model)
    driver = _driver("feetech", far)
    driver.connect(ARM.from_file_units([0.0] * 5))
    before = len(far.received)
    driver.send(ARM.from_file_units([0.0] * 5), 0.02)
    driver.close()
    assert far.received[before:].startswith(
        bytes.fromhex("FF FF FE 13 83 2A 02 01 00 08 02 00 08 03 00 08 04 00 08 05 00 08 08")
    )


@BUSES
def test_a_servo_that_does_not_answer_is_named_with_its_joint(name: str, kind: type[BusModel]) -> None:
    model = kind(REST)
    model.dead = {3, 5}
    far = Bench(model)
    driver = _driver(name, far)
    with pytest.raises(HardwareError, match=r"no answer from servo 3 \(elbow_flex\), servo 5 \(wrist_roll\)"):
        driver.connect(POSE)
    driver.close()
    assert model.goals == []


@BUSES
def test_answers_lost_to_noise_are_asked_for_again(name: str, kind: type[BusModel]) -> None:
    model = kind(REST)
    model.noise = 2
    far = Bench(model)
    driver = _driver(name, far)
    driver.connect(POSE)
    driver.close()
    assert model.goals[-1] == COUNTS


@BUSES
def test_a_servo_that_cannot_follow_is_told(name: str, kind: type[BusModel]) -> None:
    model = kind(REST)
    model.stuck = {2}
    far = Bench(model)
    driver = _driver(name, far)
    with pytest.raises(HardwareError, match=r"servo 2 \(shoulder_lift\) is at 920 counts instead of 1820"):
        driver.connect(POSE)
    driver.close()


@BUSES
def test_faults_and_silence_are_noticed_in_passing(name: str, kind: type[BusModel]) -> None:
    model = kind(REST)
    far = Bench(model)
    driver = _driver(name, far)
    driver.connect(POSE)
    model.faults = {4: 0x84 if kind is DynamixelModel else 0x20}
    with pytest.raises(HardwareError, match=r"servo 4 \(wrist_flex\) reports: .*overloaded"):
        _stream(driver)
    model.faults = {}
    model.memory[3][model.TORQUE] = 0
    with pytest.raises(HardwareError, match=r"servo 3 \(elbow_flex\) has lost its torque"):
        _stream(driver)
    model.memory[3][model.TORQUE] = 1
    model.dead = set(REST)
    with pytest.raises(HardwareError, match="no longer answers"):
        _stream(driver)
    driver.close()


@BUSES
def test_emergency_stop_makes_the_place_where_a_servo_is_its_goal(name: str, kind: type[BusModel]) -> None:
    model = kind(REST)
    far = Bench(model)
    driver = _driver(name, far)
    driver.emergency_stop()
    driver.connect(POSE)
    model.stuck = set(REST)  # on its way
    moved = POSE + np.radians(5.0)
    driver.send(moved, 0.02)
    model.dead = {2}
    model.put(5, model.PRESENT, 4000)  # pushed outside its range, which ends at 3901
    driver.emergency_stop()
    driver.close()
    held = [goals for goals in model.goals if len(goals) == 1]
    assert {servo: count for goals in held for servo, count in goals.items()} == {
        1: COUNTS[1],
        3: COUNTS[3],
        4: COUNTS[4],
        5: 3901,
    }


@BUSES
def test_an_arm_left_far_outside_its_range_is_not_powered(name: str, kind: type[BusModel]) -> None:
    just_outside, outside = 910 - 100, 910 - 120  # a twentieth of the range of shoulder_lift is 114
    for rest, refused in ((just_outside, False), (outside, True)):
        model = kind({**REST, 2: rest})
        far = Bench(model)
        driver = _driver(name, far)
        if refused:
            with pytest.raises(HardwareError, match="joint shoulder_lift is at 790 counts, outside its range"):
                driver.connect(POSE)
        else:
            driver.connect(POSE)
        driver.close()
        assert bool(model.goals) is not refused
        if model.goals:
            assert model.goals[0][2] == 910


def test_negative_counts_of_more_than_a_turn() -> None:
    joints = (
        *ARM.joints[:4],
        replace(ARM.joints[4], bus=replace(ARM.joints[4].bus, count_at_zero=-70000.0, count_range=(-72000, -68000))),
    )
    model = DynamixelModel({**REST, 5: -70100})
    far = Bench(model)
    driver = _driver("dynamixel", far, replace(ARM, joints=joints))
    driver.connect(POSE)
    driver.close()
    assert model.goals[-1] == {**COUNTS, 5: -70569}


@BUSES
def test_joints_are_measured_while_they_play_the_one_that_moves_the_most(name: str, kind: type[BusModel]) -> None:
    model = kind(REST)
    driver = _driver(name, Bench(model))
    assert isinstance(driver, Measuring)
    driver.measure()
    driver.connect(POSE)
    for k in range(200):
        pose = POSE.copy()
        pose[3] += np.radians(0.1 * k)
        driver.send(pose, 0.02)
    driver.flush()
    driver.close()
    measured = driver.measured()
    assert np.all(np.diff(measured.times_s) >= 0)
    assert np.count_nonzero(~np.isnan(measured.positions), axis=0).min() > 10
    of_the_fourth = ~np.isnan(measured.positions[:, 3])
    assert np.count_nonzero(of_the_fourth) > 90
    expected = POSE[3] + np.radians(0.1) * np.floor(measured.times_s[of_the_fourth] / 0.02)
    np.testing.assert_allclose(measured.positions[of_the_fourth, 3], expected, atol=np.radians(0.3))
