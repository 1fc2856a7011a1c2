"""SSC-32 and its kin: whole microseconds, all servos in one move with a time, which the board keeps."""

from __future__ import annotations

from hardware.clock import Clock
from hardware.codecs import ssc32
from hardware.compensation.servo_values import pulse_calibration
from hardware.drivers.streaming.controller import STAGGER_S, Question
from hardware.port import Port
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import HardwareError

_FIRST_MOVE_S = 2.0
"""A servo that the board has moved before goes to its first pulse in this time; others jump there."""
_ANSWER_S = 0.5
_LONGEST_VERSION = 64
_POLL_S = 0.05
_POLLS = 100


class Ssc32:
    """A Controller."""

    usual_baud = 115_200
    witnesses = 1
    forgets_resets = True

    def __init__(self, arm: Arm) -> None:
        self.calibration = pulse_calibration(arm)

    def attach(self, port: Port, values: FloatArray, clock: Clock) -> FloatArray:
        port.write(ssc32.VERSION)
        for _ in range(_LONGEST_VERSION):
            byte = port.read(1, _ANSWER_S)
            if not byte:
                raise HardwareError(
                    f"{port.name}: no SSC-32 answers; check its power, and the --baud that its jumpers "
                    "or its button have set"
                )
            if byte == b"\r":
                break
        for channel, pulse_us in zip(self.calibration.addresses, values, strict=True):
            port.write(ssc32.move([(channel, pulse_us)], _FIRST_MOVE_S))
            clock.sleep_until(clock.now_s() + STAGGER_S)
        return values

    def set_point(self, values: FloatArray, duration_s: float) -> bytes:
        return ssc32.move(zip(self.calibration.addresses, values.tolist(), strict=True), duration_s)

    def confirm(self, port: Port, values: FloatArray, clock: Clock) -> None:
        for _ in range(_POLLS):
            port.write(ssc32.IS_MOVING)
            answer = port.read(1, _ANSWER_S)
            if answer == ssc32.RESTING:
                return
            clock.sleep_until(clock.now_s() + _POLL_S)
        raise HardwareError(f"{port.name}: the board does not finish its first move; switch it off and on")

    def halt(self, port: Port) -> None:
        port.write(ssc32.stop(self.calibration.addresses))

    def question(self, witness: int) -> Question:
        """Nothing that it answers tells of a reset: all that shows is a question that it was not there to answer."""
        return Question(ssc32.IS_MOVING, 1)

    def take_answer(self, witness: int, received: bytearray) -> bool:
        answered = any(bytes((byte,)) in (ssc32.MOVING, ssc32.RESTING) for byte in received)
        received.clear()
        return answered
