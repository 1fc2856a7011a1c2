"""The driver of controllers without a queue: each set point goes out when it is due and is forgotten."""

from __future__ import annotations

import math

from hardware.clock import Clock
from hardware.gentle_move import come_from
from hardware.port import Line, Port
from hardware.streaming.controller import Controller
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.counted import counted
from planner.errors import HardwareError

_COMING_PERIOD_S = 0.02
_ASK_EVERY_S = 0.5
_PATIENCE_S = 1.0
_UNANSWERED = 3
"""So many questions in a row without an answer, and nobody is there. One may be lost to noise."""
_LAST_CHANCE_S = 0.25
_LONGEST_ANSWER = 256


class StreamingDriver:
    """Sends set points as they come, and asks in between how the controller fares without waiting for the answer."""

    ahead_s = 0.0

    def __init__(self, arm: Arm, controller: Controller, line: Line, clock: Clock) -> None:
        self._arm, self._controller, self._line, self._clock = arm, controller, line, clock
        self._port: Port | None = None
        self._reached_s = -math.inf
        self._sent = self._bytes = self._asked = self._answered = self._unanswered = 0
        self._received = bytearray()
        self._asked_s: float | None = None
        self._ask_s = -math.inf

    def connect(self, pose: FloatArray) -> None:
        values = self._controller.calibration.to_servos(pose)
        self._port = self._line.open(self._controller.usual_baud)
        self._port.discard_input()
        self._come_from(self._controller.attach(self._port, values, self._clock), pose)
        self._controller.confirm(self._port, values, self._clock)

    def send(self, positions: FloatArray, duration_s: float) -> None:
        port = self._connected()
        message = self._controller.set_point(self._controller.calibration.to_servos(positions), duration_s)
        if 0.0 < duration_s < port.seconds(len(message)):
            raise HardwareError(
                f"{port.name}: a set point is {port.seconds(len(message)) * 1e3:.3g} ms on the line and "
                f"{duration_s * 1e3:.3g} ms are between two; set controller and --baud to a higher speed")
        now_s = self._clock.now_s()
        message += self._question(port, now_s)
        port.write(message)
        self._sent += 1
        self._bytes += len(message)
        self._reached_s = now_s + duration_s

    def executed(self) -> int:
        return self._sent

    def flush(self) -> None:
        self._connected()
        self._clock.sleep_until(self._reached_s)

    def emergency_stop(self) -> None:
        if self._port is not None:
            self._controller.halt(self._port)

    def close(self) -> None:
        if self._port is not None:
            self._port.close()
            self._port = None

    def statistics(self) -> list[str]:
        return [f"{counted(self._sent, 'set point')} in {counted(self._bytes, 'byte')}; "
                f"the controller answered {self._answered} of {counted(self._asked, 'question')} about how it fares"]

    def _connected(self) -> Port:
        if self._port is None:
            raise HardwareError(f"{self._line.name}: the line is not open")
        return self._port

    def _come_from(self, standing: FloatArray, pose: FloatArray) -> None:
        """Slowly from where the servos stand, perhaps with the pen on the paper, to `pose`."""
        calibration = self._controller.calibration
        way = come_from(self._arm, calibration.to_joints(standing), pose, 1 / _COMING_PERIOD_S)
        start_s = self._clock.now_s()
        for k, values in enumerate(calibration.to_servos(way), start=1):
            self._clock.sleep_until(start_s + k * _COMING_PERIOD_S)
            self._connected().write(self._controller.set_point(values, _COMING_PERIOD_S))

    def _question(self, port: Port, now_s: float) -> bytes:
        """The question that is due now, if any, once the one before is answered or given up."""
        self._received += port.read(_LONGEST_ANSWER)
        if self._asked_s is not None:
            self._note_answer(port, waited_s=now_s - self._asked_s)
        if self._asked_s is not None or now_s < self._ask_s:
            return b""
        self._received.clear()
        self._asked_s, self._ask_s = now_s, now_s + _ASK_EVERY_S
        self._asked += 1
        return self._controller.question()

    def _note_answer(self, port: Port, waited_s: float) -> None:
        if not self._controller.take_answer(self._received):
            if waited_s <= _PATIENCE_S:
                return
            self._unanswered += 1
            if self._unanswered < _UNANSWERED:
                self._asked_s = None
                return
            self._received += port.read(_LONGEST_ANSWER, _LAST_CHANCE_S)
            if not self._controller.take_answer(self._received):
                raise HardwareError(f"{port.name}: the controller no longer answers; check its cable and its power")
        self._asked_s, self._unanswered = None, 0
        self._answered += 1
