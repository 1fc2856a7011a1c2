"""Every driver there is, by the name that `plan run --driver` takes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from hardware.calibration import pulse_calibration
from hardware.clock import Clock
from hardware.driver import Driver
from hardware.port import Line
from hardware.streaming.controller import Controller
from hardware.streaming.driver import StreamingDriver
from hardware.streaming.dynamixel import dynamixel_bus
from hardware.streaming.feetech import feetech_bus
from hardware.streaming.maestro import Maestro
from hardware.streaming.ssc32 import Ssc32
from planner.arms.arm import Arm
from planner.errors import UsageError

SIMULATED = "sim"
_NATIVE = "native"
_STREAMING: dict[str, Callable[[Arm], Controller]] = {
    "maestro": Maestro,
    "maestro-crc": partial(Maestro, with_crc=True),
    "ssc32": Ssc32,
    "feetech": feetech_bus,
    "dynamixel": dynamixel_bus,
}

DRIVERS = (SIMULATED, _NATIVE, *_STREAMING)


def make_driver(name: str, arm: Arm, line: Line | None, clock: Clock) -> Driver:
    """The driver of that name, not yet connected. line: None for the simulated arm alone.

    Errors: UsageError; HardwareError where the arm file does not say how joints are moved.
    """
    if name not in DRIVERS:
        raise UsageError(f"there is no driver '{name}'; there are {', '.join(DRIVERS)}")
    if name == SIMULATED:
        from hardware.simulated_arm import SimulatedArm

        return SimulatedArm(arm, clock)
    if line is None:
        raise UsageError(f"driver {name} needs a --port (plan ports lists what is plugged in)")
    if name == _NATIVE:
        from hardware.codecs.native import BAUD
        from hardware.native.driver import NativeDriver

        calibration = pulse_calibration(arm)
        return NativeDriver(lambda: line.open(BAUD), calibration.to_servos, calibration.addresses, calibration.ranges,
                            clock)
    return StreamingDriver(arm, _STREAMING[name](arm), line, clock)
