"""`plan run` in a process of its own, its line and its clock those of an emulated controller, and what befalls it.

The controller's time passes only while its line is read, so that a host which is killed between two looks at the line
leaves a controller that can be talked to again; and hours of drawing take minutes.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path

import numpy as np

from hardware import clock, port
from planner.cli import main
from planner.errors import HardwareError
from tests.hardware.emulator.emulator import LockStep

_GONE_ON_S = 2.0
"""What does not end a run is followed by something else within this time."""


class Kind(StrEnum):
    """What befalls a run."""

    KILL = "host killed (SIGKILL)"
    HANG_UP = "terminal closed (SIGHUP)"
    TERMINATE = "asked to end (SIGTERM)"
    CABLE = "cable pulled"
    RESET = "controller reset"
    POWER = "controller without power"
    KILL_AND_RESET = "host killed, then reset"
    KILL_AND_POWER = "host killed, then no power"
    ERRORS = "burst of byte errors"
    DISK = "disk full"
    SECOND = "second run at the same time"


_GOES_ON = (Kind.ERRORS, Kind.DISK, Kind.SECOND)
"""These a run should survive."""


@dataclass
class Host:
    """One run: `plan run` with `arguments` on `controller`; from `strikes_s` of its clock on one thing of `kinds`
    befalls it, and another if it goes on. `log` is what it says."""

    controller: LockStep
    arguments: list[str]
    log: Path
    random: np.random.Generator
    kinds: list[Kind] = field(default_factory=list)
    strikes_s: float = float("inf")
    _errors_until_s: float = float("-inf")
    _error_rate: float = 0.0
    _pulled: bool = False
    _tell: int = -1

    def run(self) -> tuple[int, list[str]]:
        """Its exit code, negative for the signal that it died of; and a line for each thing that befell it, "! " before
        what should not have been. Both it and what it says come through pipes, which a full disk does not fill."""
        told, self._tell = os.pipe()
        said, say = os.pipe()
        child = os.fork()
        if child == 0:
            code = 70
            try:
                with self._in_place(), Path(os.devnull).open("rb") as nothing:
                    for descriptor, file in enumerate((nothing.fileno(), say, say)):
                        os.dup2(file, descriptor)
                    sys.stdout = sys.stderr = os.fdopen(say, "w", buffering=1)  # those there may be files, which seek
                    code = main(self.arguments)
            finally:
                os._exit(code)
        os.close(self._tell)
        os.close(say)
        with os.fdopen(said, "rb") as words, self.log.open("ab") as log:
            log.write(words.read())
        with os.fdopen(told) as lines:
            return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), lines.read().splitlines()

    @contextmanager
    def _in_place(self) -> Iterator[None]:
        """The line and the clock of this process are the controller's. It is a process to itself: nothing is undone."""
        port.Line.open = lambda line, usual_baud: self  # type: ignore[method-assign, assignment, return-value]
        clock.WallClock.now_s = lambda _: self.controller.now_s()  # type: ignore[method-assign]
        clock.WallClock.sleep_until = lambda _, until_s: self.controller.sleep_until(until_s)  # type: ignore[method-assign]
        yield

    def read(self, size: int, timeout_s: float = 0.0) -> bytes:
        self._look_out()
        return self._damaged(self.controller.read(size, timeout_s))

    def write(self, message: bytes) -> None:
        self._look_out()
        self.controller.write(self._damaged(message))

    def close(self) -> None:
        """Nothing is held."""

    def _look_out(self) -> None:
        if self._pulled:
            raise HardwareError("the line failed (the cable was pulled)")
        if self.controller.now_s() < self.strikes_s:
            return
        kind = Kind(self.random.choice(self.kinds))
        self.strikes_s = float("inf")
        if kind in _GOES_ON:
            self.strikes_s = self.controller.now_s() + self.random.uniform(0.0, _GONE_ON_S)
        os.write(self._tell, f"{kind.name}\n".encode())
        _BEFALLS[kind](self)

    def _damaged(self, message: bytes) -> bytes:
        if self.controller.now_s() >= self._errors_until_s:
            return message
        return bytes(
            byte ^ 1 << int(self.random.integers(8)) if self.random.random() < self._error_rate else byte
            for byte in message
        )

    def _kill(self) -> None:
        os.kill(os.getpid(), signal.SIGKILL)

    def _hang_up(self) -> None:
        os.kill(os.getpid(), signal.SIGHUP)

    def _terminate(self) -> None:
        os.kill(os.getpid(), signal.SIGTERM)

    def _pull_cable(self) -> None:
        self._pulled = True
        self._look_out()

    def _reset(self) -> None:
        self.controller.emulator.reset()

    def _lose_power(self) -> None:
        self.controller.emulator.lose_power()

    def _err(self) -> None:
        self._errors_until_s = self.controller.now_s() + self.random.uniform(0.02, 1.5)
        self._error_rate = float(10.0 ** self.random.uniform(-3, 0))

    def _fill_disk(self) -> None:
        """No file of this process grows any more; a line may be torn."""
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        written = Path(self.arguments[1] + ".journal")
        most = (written.stat().st_size if written.exists() else 0) + int(self.random.integers(40))
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, resource.RLIM_INFINITY))

    def _start_second(self) -> None:
        """It finds the port taken, if it comes so far."""
        second = os.fork()
        if second == 0:
            code = 70
            try:
                for number in (signal.SIGTERM, signal.SIGINT):
                    signal.signal(number, signal.SIG_DFL)
                port.Line.open = _taken  # type: ignore[method-assign]
                code = main(self.arguments)
            finally:
                os._exit(code)
        code = os.waitstatus_to_exitcode(os.waitpid(second, 0)[1])
        if code not in (2, 4):
            os.write(self._tell, f"! a second run ended with {code}\n".encode())


def _taken(line: port.Line, usual_baud: int) -> port.Port:
    raise HardwareError(f"{line.name}: another program has it open; close that first")


_BEFALLS: dict[Kind, Callable[[Host], None]] = {
    Kind.KILL: Host._kill,
    Kind.HANG_UP: Host._hang_up,
    Kind.TERMINATE: Host._terminate,
    Kind.CABLE: Host._pull_cable,
    Kind.RESET: Host._reset,
    Kind.POWER: Host._lose_power,
    Kind.KILL_AND_RESET: Host._kill,
    Kind.KILL_AND_POWER: Host._kill,
    Kind.ERRORS: Host._err,
    Kind.DISK: Host._fill_disk,
    Kind.SECOND: Host._start_second,
}
