"""Pololu Maestro: pulses in quarters of a microsecond, each channel on its own, no timing but the host's."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hardware.clock import Clock
from hardware.codecs import maestro
from hardware.compensation.servo_values import pulse_calibration
from hardware.drivers.streaming.controller import STAGGER_S, Question
from hardware.port import Port
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import HardwareError

_ANSWER_S = 0.5
_SETTLED_US = 1.0


class Maestro:
    """A Controller. with_crc: the board's setting "Enable CRC" is on."""

    usual_baud = 115_200  # over USB any will do
    witnesses = 1
    forgets_resets = True

    def __init__(self, arm: Arm, *, with_crc: bool = False) -> None:
        self.calibration = pulse_calibration(arm)
        self._seal: Callable[[bytes], bytes] = maestro.with_crc if with_crc else bytes

    def attach(self, port: Port, values: FloatArray, clock: Clock) -> FloatArray:
        self._ask(port, maestro.GET_ERRORS)  # of what came before
        measured = values.copy()
        for k, (channel, pulse_us) in enumerate(zip(self.calibration.addresses, values, strict=True)):
            for command in maestro.unlimited(channel):
                port.write(self._seal(command))
            present_us = self._position_us(port, channel)
            if present_us:
                measured[k] = present_us
            else:
                port.write(self._seal(maestro.set_target(channel, pulse_us)))
                clock.sleep_until(clock.now_s() + STAGGER_S)
        return self.calibration.within(measured)

    def set_point(self, values: FloatArray, duration_s: float) -> bytes:
        return b"".join(
            self._seal(maestro.set_target(channel, pulse_us))
            for channel, pulse_us in zip(self.calibration.addresses, values, strict=True)
        )

    def confirm(self, port: Port, values: FloatArray, clock: Clock) -> None:
        """The board keeps to a range of its own for each channel, and says nothing of a target outside."""
        _complain(self._ask(port, maestro.GET_ERRORS))
        for channel, pulse_us in zip(self.calibration.addresses, values, strict=True):
            present_us = self._position_us(port, channel)
            if abs(present_us - pulse_us) > _SETTLED_US:
                raise HardwareError(
                    f"{port.name}: channel {channel} of the Maestro stays at {present_us:g} us instead of "
                    f"{pulse_us:g} us; widen Min and Max of its channel settings"
                )

    def halt(self, port: Port) -> None:
        port.discard_input()
        present_us = np.array([self._position_us(port, channel) for channel in self.calibration.addresses])
        port.write(
            b"".join(
                self._seal(maestro.set_target(channel, pulse_us))
                for channel, pulse_us in zip(self.calibration.addresses, present_us, strict=True)
                if pulse_us
            )
        )

    def question(self, witness: int) -> Question:
        """Its errors, and the pulse of one servo: a board that was reset gives none until its next command."""
        ask_position = maestro.get_position(self.calibration.addresses[0])
        return Question(self._seal(maestro.GET_ERRORS) + self._seal(ask_position), 2 * maestro.REPLY_SIZE)

    def take_answer(self, witness: int, received: bytearray) -> bool:
        if len(received) < 2 * maestro.REPLY_SIZE:
            return False
        errors, position = received[: maestro.REPLY_SIZE], received[maestro.REPLY_SIZE : 2 * maestro.REPLY_SIZE]
        received.clear()
        _complain(errors)
        if not maestro.position_us(position):
            raise HardwareError(
                "the Maestro was reset in the middle of the run; check its power, lift the pen, put "
                "the arm into its park pose, and go on with --resume"
            )
        return True

    def _position_us(self, port: Port, channel: int) -> float:
        return maestro.position_us(self._ask(port, maestro.get_position(channel)))

    def _ask(self, port: Port, command: bytes) -> bytes:
        port.write(self._seal(command))
        reply = port.read(maestro.REPLY_SIZE, _ANSWER_S)
        if len(reply) < maestro.REPLY_SIZE:
            raise HardwareError(
                f"{port.name}: no Maestro answers; give the first of its two USB ports and set its "
                "serial mode to USB Dual Port, or give its UART and the fixed --baud it is set to"
            )
        return reply


def _complain(reply: bytes | bytearray) -> None:
    errors = maestro.errors(reply)
    if errors:
        raise HardwareError(
            f"the Maestro reports {', '.join(errors)}; see its Serial settings in the Maestro Control Center"
        )
