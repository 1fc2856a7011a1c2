"""Dynamixel servos of the X series (XL330, XL430, XM430 and so on), which share one table of registers."""

from __future__ import annotations

from hardware.codecs import dynamixel
from hardware.drivers.streaming.servo_bus import Registers, ServoBus
from planner.arms.arm import Arm

_USUAL_BAUD = 57_600
_X_SERIES = Registers(torque=64, goal=116, present=132, ramps=((108, 4), (112, 4)))
"""Ramps: profile acceleration, profile velocity."""


def dynamixel_bus(arm: Arm) -> ServoBus:
    """The arm's servos on a Dynamixel bus. Errors: ArmFileError naming the key that a joint lacks."""
    return ServoBus(arm, dynamixel, _X_SERIES, _USUAL_BAUD)
