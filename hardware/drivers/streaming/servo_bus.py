"""Servos on a bus, which measure their position: Feetech's and Dynamixel's differ only in language and registers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from hardware.clock import Clock
from hardware.codecs.status import Status
from hardware.compensation.servo_values import count_calibration
from hardware.drivers.streaming.controller import Question
from hardware.port import Port
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import HardwareError

_ANSWER_S = 0.1
"""A servo answers within a millisecond; adapters on USB hand it over up to 16 later."""
_ATTEMPTS = 3
_HALT_S = (0.03, 0.3)
"""How long an emergency stop waits for a servo: not long at first, so that one that is dead does not delay others."""
_LONGEST_ANSWER = 32
_NEAR = 0.03
"""Of a servo's range: so close to where it was sent it has arrived, its load and its dead band considered."""
_POLL_S = 0.05
_POLLS = 40


class Language(Protocol):
    """A codec of bus servos, as a module. STATUS_SIZE: bytes of an answer without what was asked for."""

    @property
    def STATUS_SIZE(self) -> int: ...

    def ping(self, servo: int) -> bytes: ...
    def read(self, servo: int, register: int, size: int) -> bytes: ...
    def sync_write(self, register: int, data: Mapping[int, bytes]) -> bytes: ...
    def word(self, count: int) -> bytes: ...
    def count(self, data: bytes) -> int: ...
    def take_status(self, received: bytearray) -> Status | None: ...


@dataclass(frozen=True, slots=True)
class Registers:
    """Where a servo keeps what: torque on or off in one byte, goal and present position in one word each.

    ramps: (register, size) of limits of its own on speed and acceleration, none where 0.
    """

    torque: int
    goal: int
    present: int
    ramps: tuple[tuple[int, int], ...]


class ServoBus:
    """A Controller. A servo that was reset has no torque, until it is attached anew."""

    forgets_resets = False

    def __init__(self, arm: Arm, language: Language, registers: Registers, usual_baud: int) -> None:
        self.usual_baud = usual_baud
        self.calibration = count_calibration(arm)
        self.witnesses = arm.n_joints
        self._joints = dict(zip(self.calibration.addresses, (joint.name for joint in arm.joints), strict=True))
        self._language, self._registers = language, registers
        self._word_size = len(language.word(0))
        self._measured: Callable[[int, float], None] | None = None

    def measure(self, measured: Callable[[int, float], None]) -> None:
        """From now on, answers to questions tell where the servo is: measured(witness, count) is called with it."""
        self._measured = measured

    def attach(self, port: Port, values: FloatArray, clock: Clock) -> FloatArray:
        silent = [servo for servo in self._joints if self._ask(port, servo, self._language.ping(servo)) is None]
        if silent:
            raise HardwareError(
                f"{port.name}: no answer from {', '.join(map(self._named, silent))}; check power and "
                "wiring, the ids in the arm file, and --baud"
            )
        measured = self.calibration.within(self._present(port))
        port.write(self._goals(measured))  # so that torque moves nothing
        for register, size in self._registers.ramps:
            port.write(self._language.sync_write(register, dict.fromkeys(self._joints, bytes(size))))
        port.write(self._language.sync_write(self._registers.torque, dict.fromkeys(self._joints, b"\x01")))
        return measured

    def set_point(self, values: FloatArray, duration_s: float) -> bytes:
        return self._goals(values)

    def confirm(self, port: Port, values: FloatArray, clock: Clock) -> None:
        for _ in range(_POLLS):
            present = self._present(port)
            away = np.abs(present - values) > _NEAR * np.ptp(self.calibration.ranges, axis=1)
            if not away.any():
                return
            clock.sleep_until(clock.now_s() + _POLL_S)
        k = int(np.argmax(away))
        servo = self._named(self.calibration.addresses[k])
        raise HardwareError(
            f"{port.name}: {servo} is at {present[k]:g} counts instead of {values[k]:.0f}; "
            "is it blocked, or is the servos' own supply off?"
        )

    def halt(self, port: Port) -> None:
        """Each as soon as it answers with its position; one that does not answer holds its last goal."""
        port.discard_input()
        moving = list(self._joints)
        for patience_s in _HALT_S:
            moving = [servo for servo in moving if not self._held(port, servo, patience_s)]

    def question(self, witness: int) -> Question:
        """Of one servo, whether it still has torque, and where it is if that is measured: one reading of all registers
        from the one to the other. Any answer tells its faults as well."""
        servo = self.calibration.addresses[witness]
        return Question(
            self._language.read(servo, self._registers.torque, self._asked), self._language.STATUS_SIZE + self._asked
        )

    def take_answer(self, witness: int, received: bytearray) -> bool:
        servo = self.calibration.addresses[witness]
        status = self._language.take_status(received)
        while status is not None and (
            status.servo != servo or len(status.data) != self._asked
        ):  # to a question given up before
            status = self._language.take_status(received)
        if status is None:
            return False
        self._complain(status)
        if status.data[0] == 0:
            raise HardwareError(
                f"{self._named(status.servo)} has lost its torque: it was reset or protects itself; check the "
                "servos' supply and what is in the arm's way"
            )
        if self._measured is not None:
            self._measured(witness, float(self._language.count(status.data[-self._word_size :])))
        return True

    @property
    def _asked(self) -> int:
        """Bytes of what a question asks for."""
        return 1 if self._measured is None else self._registers.present + self._word_size - self._registers.torque

    def _held(self, port: Port, servo: int, patience_s: float) -> bool:
        """Whether the servo has answered, and has where it is for its goal, or the nearest in its range."""
        status = self._exchange(port, servo, self._reading(servo), patience_s)
        if status is None or len(status.data) != self._word_size:
            return False
        low, high = self.calibration.ranges[self.calibration.addresses.index(servo)]
        goal = min(max(self._language.count(status.data), int(low)), int(high))
        port.write(self._language.sync_write(self._registers.goal, {servo: self._language.word(goal)}))
        return True

    def _goals(self, values: FloatArray) -> bytes:
        counts = np.rint(values).astype(int).tolist()
        return self._language.sync_write(
            self._registers.goal,
            {servo: self._language.word(count) for servo, count in zip(self._joints, counts, strict=True)},
        )

    def _reading(self, servo: int) -> bytes:
        return self._language.read(servo, self._registers.present, self._word_size)

    def _present(self, port: Port) -> FloatArray:
        """(n_joints,) measured counts."""
        counts = []
        for servo in self._joints:
            status = self._ask(port, servo, self._reading(servo))
            if status is None or len(status.data) != self._word_size:
                raise HardwareError(f"{port.name}: {self._named(servo)} no longer answers; check power and wiring")
            counts.append(float(self._language.count(status.data)))
        return np.array(counts)

    def _ask(self, port: Port, servo: int, message: bytes) -> Status | None:
        """The answer, asked for again where noise took it. Errors: HardwareError where it tells of a fault."""
        for _ in range(_ATTEMPTS):
            status = self._exchange(port, servo, message)
            if status is not None:
                self._complain(status)
                return status
        return None

    def _exchange(self, port: Port, servo: int, message: bytes, patience_s: float = _ANSWER_S) -> Status | None:
        port.write(message)
        received = bytearray()
        while byte := port.read(1, patience_s):
            received += byte
            status = self._language.take_status(received)
            if status is not None and status.servo == servo:
                return status
            if len(received) > _LONGEST_ANSWER:
                break
        return None

    def _complain(self, status: Status) -> None:
        if status.faults:
            raise HardwareError(
                f"{self._named(status.servo)} reports: {', '.join(status.faults)}; switch the servos "
                "off, remove the cause, and start again"
            )

    def _named(self, servo: int) -> str:
        return f"servo {servo} ({self._joints.get(servo, 'of no joint')})"
