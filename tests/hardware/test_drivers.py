"""Drivers by name."""

from __future__ import annotations

import pytest

from hardware.clock import InstantClock
from hardware.drivers import DRIVERS, SIMULATED, make_driver
from hardware.port import Line
from planner.arms.arm_file import load_arm
from planner.errors import HardwareError, UsageError

ARM = load_arm("scara")


def test_an_unknown_driver_lists_the_known_ones() -> None:
    with pytest.raises(UsageError, match=r"no driver 'meastro'; there are sim, native, maestro, "):
        make_driver("meastro", ARM, None, InstantClock())


@pytest.mark.parametrize("name", [name for name in DRIVERS if name != SIMULATED])
def test_a_driver_of_hardware_needs_a_port(name: str) -> None:
    with pytest.raises(UsageError, match=f"driver {name} needs a --port"):
        make_driver(name, ARM, None, InstantClock())


@pytest.mark.parametrize(("name", "key"), [("maestro", "servo"), ("ssc32", "servo"), ("feetech", "bus"),
                                           ("dynamixel", "bus")])
def test_an_arm_that_does_not_say_how_it_is_moved_is_told_which_key_to_add(name: str, key: str) -> None:
    with pytest.raises(HardwareError, match=rf"joint q1 is moved; add to that joint in the arm file: {key} = {{"):
        make_driver(name, ARM, Line("loop://"), InstantClock())
