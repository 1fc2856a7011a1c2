"""Feetech STS and SMS bus servos, of which the STS3215 is the one that hobby arms are built of."""

from __future__ import annotations

from hardware.codecs import feetech
from hardware.drivers.streaming.servo_bus import Registers, ServoBus
from planner.arms.arm import Arm

_USUAL_BAUD = 1_000_000
_STS = Registers(torque=40, goal=42, present=56, ramps=((41, 1), (46, 2)))
"""Ramps: acceleration, speed."""


def feetech_bus(arm: Arm) -> ServoBus:
    """The arm's servos on a Feetech bus. Errors: ArmFileError naming the key that a joint lacks."""
    return ServoBus(arm, feetech, _STS, _USUAL_BAUD)
