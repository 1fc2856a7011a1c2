"""Drivers by name: what their servos are told, and what an arm file has to say for it."""

from __future__ import annotations

import pytest

from hardware.clock import InstantClock
from hardware.drivers.table import DRIVERS, SIMULATED, SIMULATORS, calibration_of, make_driver
from hardware.port import Line
from planner.arms.arm_file import load_arm
from planner.errors import ArmFileError

UNDESCRIBED = load_arm("scara")
ON_BUS = ("feetech", "dynamixel")


@pytest.mark.parametrize("name", [name for name in DRIVERS if name not in SIMULATORS])
def test_an_arm_that_does_not_say_how_it_is_moved_is_told_which_key_to_add(name: str) -> None:
    key = "bus" if name in ON_BUS else "servo"
    with pytest.raises(ArmFileError, match=rf"joint q1 is moved; add to that joint in the arm file: {key} = {{"):
        calibration_of(name, UNDESCRIBED)


@pytest.mark.parametrize("name", [name for name in DRIVERS if name not in (*SIMULATORS, "native")])
def test_a_controller_that_streams_is_made_without_opening_its_line(name: str) -> None:
    arm = load_arm("so101" if name in ON_BUS else "drawing_arm")
    assert make_driver(name, arm, Line("/dev/none"), InstantClock()).ahead_s == 0
    calibration = calibration_of(name, arm)
    assert calibration is not None
    assert calibration.unit == ("counts" if name in ON_BUS else "us")


def test_the_simulated_arm_does_without_servos() -> None:
    assert calibration_of(SIMULATED, UNDESCRIBED) is None
    simulated = calibration_of(SIMULATED, load_arm("drawing_arm"))
    assert simulated is not None
    assert simulated.addresses == (0, 1, 2, 3, 4)
