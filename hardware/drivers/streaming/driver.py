"""The driver of controllers without a queue: each set point is sent when it is due."""

from __future__ import annotations

import math

import numpy as np

from hardware.clock import Clock
from hardware.drivers.streaming.controller import Controller, MeasuringController
from hardware.drivers.streaming.witness import Witness, fits, seconds
from hardware.measurements import Measurements
from hardware.motion.slow_transfer import come_from
from hardware.port import Line, Port
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.counted import counted
from planner.errors import HardwareError

_COMING_PERIOD_S = 0.02


class StreamingDriver:
    """Sends set points as they come, and in between asks for the controller's state without waiting for the answer.

    What is `executed` is what an answer proves: see hardware/drivers/streaming/witness.py.
    """

    ahead_s = 0.0

    def __init__(self, arm: Arm, controller: Controller, line: Line, clock: Clock) -> None:
        self._arm, self._controller, self._line, self._clock = arm, controller, line, clock
        self._port: Port | None = None
        self._witness = Witness(controller)
        self._reached_s = self._free_s = -math.inf
        self._sent = self._bytes = 0
        self._told: FloatArray | None = None
        self._played_s = self._asked_s = 0.0
        self._measured: list[tuple[float, int, float]] | None = None

    def measure(self) -> None:
        """Errors: HardwareError where servos do not measure where they are."""
        if not isinstance(self._controller, MeasuringController):
            raise HardwareError(f"{self._line.name}: these servos do not tell where they are")
        measured = self._measured = []
        self._controller.measure(lambda witness, value: measured.append((self._asked_s, witness, value)))

    def measured(self) -> Measurements:
        table = self._measured or []
        values = np.full((len(table), self._arm.n_joints), np.nan)
        for row, (_, joint, value) in enumerate(table):
            values[row, joint] = value
        return Measurements(
            np.array([time_s for time_s, _, _ in table]), self._controller.calibration.to_joints(values)
        )

    def open(self) -> None:
        if self._port is None:
            self._port = self._line.open(self._controller.usual_baud)

    def connect(self, pose: FloatArray) -> None:
        values = self._controller.calibration.to_servos(pose)
        self.open()
        port = self._connected()
        port.discard_input()
        self._come_from(self._controller.attach(port, values, self._clock), pose)
        self._controller.confirm(port, values, self._clock)

    def send(self, positions: FloatArray, duration_s: float) -> None:
        port = self._connected()
        values = self._controller.calibration.to_servos(positions)
        message = self._controller.set_point(values, duration_s)
        if 0.0 < duration_s < port.seconds(len(message)):
            raise HardwareError(
                f"{port.name}: a set point takes {port.seconds(len(message)) * 1e3:.3g} ms on the line, but the "
                f"next one follows after {duration_s * 1e3:.3g} ms; set controller and --baud to a higher speed"
            )
        self._clock.sleep_until(self._free_s)  # servos that share the line may still be answering
        now_s = self._clock.now_s()
        self._witness.listen(port, now_s)
        if self._sent and self._witness.due(now_s):
            message = self._with_question(port, message, duration_s, now_s, self._moving(values))
        port.write(message)
        self._told = values
        self._played_s += duration_s
        self._sent += 1
        self._bytes += len(message)
        self._reached_s = now_s + duration_s

    def executed(self) -> int:
        return self._witness.proven

    def flush(self) -> None:
        port = self._connected()
        self._clock.sleep_until(max(self._reached_s, self._free_s))
        self._witness.make_sure(port, self._clock.now_s(), self._sent)

    def emergency_stop(self) -> None:
        if self._port is not None:
            self._controller.halt(self._port)

    def close(self) -> None:
        if self._port is not None:
            self._port.close()
            self._port = None

    def statistics(self) -> list[str]:
        return [
            f"{counted(self._sent, 'set point')} in {counted(self._bytes, 'byte')}; the controller answered "
            f"{self._witness.answered} of {counted(self._witness.asked, 'question')} about its state"
        ]

    def _connected(self) -> Port:
        if self._port is None:
            raise HardwareError(f"{self._line.name}: the line is not open")
        return self._port

    def _come_from(self, measured: FloatArray, pose: FloatArray) -> None:
        """Slowly from the `measured` values of the servos, perhaps with the pen on the paper, to `pose`."""
        calibration = self._controller.calibration
        way = come_from(self._arm, calibration.to_joints(measured), pose, 1 / _COMING_PERIOD_S)
        start_s = self._clock.now_s()
        for k, values in enumerate(calibration.to_servos(way), start=1):
            self._clock.sleep_until(start_s + k * _COMING_PERIOD_S)
            self._connected().write(self._controller.set_point(values, _COMING_PERIOD_S))

    def _moving(self, values: FloatArray) -> int | None:
        """The joint that moves most, where joints are measured and one of them moves."""
        if self._measured is None or self._told is None or not np.any(values != self._told):
            return None
        return int(np.argmax(np.abs(values - self._told)))

    def _with_question(self, port: Port, message: bytes, duration_s: float, now_s: float, rather: int | None) -> bytes:
        """A set point and a question, which asks of those sent before: they have had their time to be reached."""
        question = self._witness.next_question(rather)
        self._asked_s = self._played_s + port.seconds(len(message) + len(question.message))
        self._witness.asked_now(now_s, self._sent, rarely=not fits(port, message, question, duration_s))
        self._free_s = now_s + seconds(port, message, question)
        if self._controller.forgets_resets:
            return question.message + message
        return message + question.message
