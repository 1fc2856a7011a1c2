"""What a controller without a queue has to be able to do, for the one driver of all of them."""

from __future__ import annotations

from typing import Protocol

from hardware.calibration import Calibration
from hardware.clock import Clock
from hardware.port import Port
from planner.arrays import FloatArray


class Controller(Protocol):
    """Moves servos at once to what it is told. Values are (n_joints,), in the calibration's unit and ranges.

    Methods that are handed a port may raise HardwareError.
    """

    usual_baud: int
    calibration: Calibration

    def attach(self, port: Port, values: FloatArray, clock: Clock) -> FloatArray:
        """Make sure that everything answers, and power the servos; where they then stand.

        Those that cannot tell where they are are sent to `values`, one after another.
        """

    def set_point(self, values: FloatArray, duration_s: float) -> bytes:
        """The message that sends the servos to `values`, within `duration_s` where the controller can time it."""

    def confirm(self, port: Port, values: FloatArray, clock: Clock) -> None:
        """Return once the servos stand at `values`, as far as the controller knows; HardwareError if they do not."""

    def halt(self, port: Port) -> None:
        """The servos hold where they are."""

    def question(self) -> bytes:
        """The message that asks how it fares: about one thing at a time, by turns."""

    def take_answer(self, received: bytearray) -> bool:
        """Whether the whole answer to the last question has come; it is taken from `received`.

        Errors: HardwareError where the answer is a fault.
        """
