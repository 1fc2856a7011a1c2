"""What servos are told: round trips, ranges that are never left, and joints that no file describes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.compensation.servo_values import count_calibration, pulse_calibration
from planner.arms.arm import Arm, BusServo, Servo
from planner.arms.arm_file import known_arms, load_arm
from planner.arrays import FloatArray
from planner.errors import ArmFileError, HardwareError

ARM = load_arm("three_joint")
TABLE = ((-1.0, 500.0), (-0.5, 800.0), (0.5, 1500.0), (2.0, 2300.0))


def _moved_by(servo: Servo, bus: BusServo | None = None) -> Arm:
    return replace(
        ARM,
        joints=tuple(
            replace(joint, servo=replace(servo, channel=k), bus=bus and replace(bus, id=k))
            for k, joint in enumerate(ARM.joints)
        ),
    )


@st.composite
def servos(draw: st.DrawFn) -> Servo:
    n = draw(st.integers(2, 6))
    steps = st.lists(st.floats(0.05, 1.0), min_size=n, max_size=n)
    positions = draw(st.floats(-2, 0)) + np.cumsum(draw(steps))
    pulses_us = 500 + 300 * np.cumsum(draw(steps))
    if draw(st.booleans()):
        pulses_us = pulses_us[::-1]
    return Servo(
        0,
        tuple(zip(positions.tolist(), pulses_us.tolist(), strict=True)),
        draw(st.sampled_from([1, -1])),
        draw(st.floats(-50, 50)),
        (300.0, 3000.0),
        1.0,
        0.0,
        0.0,
    )


@settings(max_examples=50)
@given(servo=servos(), shares=st.lists(st.floats(0, 1), min_size=1, max_size=5))
def test_back_undoes_there_and_nothing_leaves_the_range(servo: Servo, shares: list[float]) -> None:
    calibration = pulse_calibration(_moved_by(servo))
    low, high = servo.curve[0][0], servo.curve[-1][0]
    one = servo.direction * (low + (high - low) * np.array(shares))
    positions = np.column_stack((one, one[::-1], one))
    pulses_us = calibration.to_servos(positions)
    np.testing.assert_allclose(calibration.to_joints(pulses_us), positions, atol=1e-9)
    np.testing.assert_array_equal(calibration.to_servos(positions[0]), pulses_us[0])
    ends_us = sorted(pulse_us + servo.trim_us for pulse_us in (servo.curve[0][1], servo.curve[-1][1]))
    assert ends_us[0] <= pulses_us.min()
    assert pulses_us.max() <= ends_us[1]


@pytest.mark.parametrize(
    ("direction", "trim_us", "position", "pulse_us"),
    [(1, 0, 0.0, 1150), (1, 0, -1.0, 500), (1, 12.5, 1.25, 1912.5), (-1, 0, 0.75, 650), (-1, -20, -2.0, 2280)],
)
def test_between_the_rows_of_a_table_runs_a_straight_line(
    direction: int, trim_us: float, position: float, pulse_us: float
) -> None:
    arm = _moved_by(Servo(0, TABLE, direction, trim_us, (450.0, 2400.0), 1.0, 0.0, 0.0))
    assert pulse_calibration(arm).to_servos(np.full(3, position)) == pytest.approx([pulse_us] * 3)


@settings(max_examples=40)
@given(share=st.floats(1e-4, 10), above=st.booleans())
def test_beyond_the_table_or_the_range_is_refused_with_joint_value_and_range(share: float, above: bool) -> None:
    arm = _moved_by(Servo(0, TABLE, 1, 10.0, (450.0, 2200.0), 1.0, 0.0, 0.0))
    highest = 2.0 - (2300.0 + 10 - 2200) * 1.5 / 800
    calibration = pulse_calibration(arm)
    positions = np.zeros((3, 3))
    positions[1, 2] = highest + share if above else -1.0 - share
    with pytest.raises(HardwareError, match=r"joint q3 at \S+ deg .* us, outside its range of 510 to 2200 us"):
        calibration.to_servos(positions)
    positions[1, 2] = highest if above else -1.0
    assert calibration.to_servos(positions)[1, 2] == pytest.approx(2200 if above else 510)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_beyond_every_range(value: float) -> None:
    calibration = pulse_calibration(load_arm("drawing_arm"))
    with pytest.raises(HardwareError, match="joint q2"), np.errstate(invalid="ignore"):
        calibration.to_servos(np.array([0.0, value, 0.0, 0.0, 0.0]))


def test_counts_of_a_bus() -> None:
    servo = Servo(0, TABLE, 1, 0.0, (450.0, 2400.0), 1.0, 0.0, 0.0)
    calibration = count_calibration(_moved_by(servo, BusServo(0, 2048.0, -4096 / (2 * np.pi), (0, 4095))))
    assert (calibration.unit, calibration.addresses) == ("counts", (0, 1, 2))
    assert calibration.to_servos(np.array([0.0, np.pi / 2, -np.pi / 4])) == pytest.approx([2048, 1024, 2560])
    assert calibration.to_joints(np.array([2048.0, 1024, 4200])) == pytest.approx(
        [0.0, np.pi / 2, -np.pi * 2152 / 2048]
    )
    with pytest.raises(HardwareError, match=r"joint q2 at 180.1 deg .* counts, outside its range of 0 to 4095 counts"):
        calibration.to_servos(np.array([0.0, np.radians(180.1), 0.0]))


@pytest.mark.parametrize("name", known_arms())
def test_arms_that_come_along_reach_their_whole_range_or_say_what_their_file_lacks(name: str) -> None:
    arm = load_arm(name)
    ends: FloatArray = np.stack((arm.minimum, arm.maximum))
    for calibrate, described in (
        (pulse_calibration, [joint.servo for joint in arm.joints]),
        (count_calibration, [joint.bus for joint in arm.joints]),
    ):
        if None in described:
            key = "servo" if calibrate is pulse_calibration else "bus"
            with pytest.raises(ArmFileError, match=rf"joint {arm.joints[0].name} .* arm file: {key} = {{"):
                calibrate(arm)
        else:
            calibration = calibrate(arm)
            np.testing.assert_allclose(calibration.to_joints(calibration.to_servos(ends)), ends, atol=1e-9)
