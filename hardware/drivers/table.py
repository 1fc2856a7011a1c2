"""Every driver there is, by the name that `plan run --driver` takes."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import partial

from hardware.clock import Clock
from hardware.compensation.servo_values import Calibration, own_calibration, pulse_calibration
from hardware.drivers.driver import Driver
from hardware.drivers.streaming.controller import Controller
from hardware.drivers.streaming.driver import StreamingDriver
from hardware.drivers.streaming.dynamixel import dynamixel_bus
from hardware.drivers.streaming.feetech import feetech_bus
from hardware.drivers.streaming.maestro import Maestro
from hardware.drivers.streaming.ssc32 import Ssc32
from hardware.motion.slow_transfer import come_from
from hardware.port import Line
from planner.arms.arm import Arm
from planner.errors import ArmFileError

SIMULATED = "sim"
MUJOCO = "mujoco"
SIMULATORS = (SIMULATED, MUJOCO)
"""These are at no port, and move nothing."""
_NATIVE = "native"
_STREAMING: dict[str, Callable[[Arm], Controller]] = {
    "maestro": Maestro,
    "maestro-crc": partial(Maestro, with_crc=True),
    "ssc32": Ssc32,
    "feetech": feetech_bus,
    "dynamixel": dynamixel_bus,
}
MEASURE_POSITIONS = ("feetech", "dynamixel")
"""Servos of these measure where they are, so that they do not jump when they are attached."""

DRIVERS = (*SIMULATORS, _NATIVE, *_STREAMING)


def calibration_of(name: str, arm: Arm) -> Calibration | None:
    """The servo values of that driver; None for an arm that is only simulated and says nothing of servos.

    Errors: ArmFileError where the arm file does not say how joints are moved.
    """
    if name in _STREAMING:
        return _STREAMING[name](arm).calibration
    if name in SIMULATORS:
        with suppress(ArmFileError):
            return own_calibration(arm)
        return None
    return pulse_calibration(arm)


def make_driver(name: str, arm: Arm, line: Line, clock: Clock) -> Driver:
    """The driver of that name at the end of a line, not yet connected.

    Errors: ArmFileError where the arm file does not say how joints are moved.
    """
    if name == _NATIVE:
        from hardware.codecs.native import BAUD
        from hardware.drivers.native.driver import NativeDriver

        calibration = pulse_calibration(arm)
        return NativeDriver(
            lambda: line.open(BAUD),
            calibration.to_servos,
            calibration.to_joints,
            partial(come_from, arm),
            calibration.addresses,
            calibration.ranges,
            clock,
        )
    return StreamingDriver(arm, _STREAMING[name](arm), line, clock)
