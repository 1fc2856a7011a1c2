"""The firmware in simavr as a thing that tests can hold: built, started, talked to, its pins read."""

from __future__ import annotations

import math
import os
import shutil
import signal
import struct
import subprocess
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from planner.arrays import FloatArray, IntArray

FIRMWARE = Path(__file__).parents[3] / "hardware" / "firmware"
CYCLES_PER_S = 16_000_000
_GOES_FIRST = -10
_NO_CHANNEL = 255
_LONGEST_PULSE_CYCLES = 2601 * 16
_MISSING = [
    tool
    for tool, there in {
        "gcc-avr": shutil.which("avr-gcc"),
        "gcc": shutil.which("gcc"),
        "make": shutil.which("make"),
        "avr-libc": any(Path(base, "avr/io.h").exists() for base in ("/usr/lib/avr/include", "/usr/avr/include")),
        "libsimavr-dev": Path("/usr/include/simavr/sim_avr.h").exists(),
        "libelf-dev": Path("/usr/include/libelf.h").exists(),
    }.items()
    if not there
]


def require_tools() -> None:
    """Skip where there is no cross-compiler or simulator; in CI that is a failure."""
    if _MISSING:
        reason = f"needs the system packages {', '.join(_MISSING)}"
        if os.environ.get("CI"):
            pytest.fail(reason)
        pytest.skip(reason)


def build(folder: Path) -> Build:
    """The firmware by its own Makefile, and the emulator."""
    require_tools()
    subprocess.run(["make", "-s", "-C", FIRMWARE, f"BUILD={folder}"], check=True, capture_output=True)
    emulator = folder / "emulator"
    subprocess.run(
        [
            "gcc",
            "-std=gnu11",
            "-O2",
            "-o",
            emulator,
            Path(__file__).with_name("emulator.c"),
            "-lsimavr",
            "-lelf",
            "-lutil",
        ],
        check=True,
        capture_output=True,
    )
    return Build(folder / "firmware.elf", emulator)


@dataclass(frozen=True)
class Build:
    firmware: Path
    emulator: Path


@dataclass(frozen=True)
class Faults:
    """Chances of a byte, both ways."""

    flip: float = 0.0
    drop: float = 0.0
    duplicate: float = 0.0
    seed: int = 1

    def options(self) -> list[str]:
        return [
            part for name in ("flip", "drop", "duplicate", "seed") for part in (f"--{name}", str(getattr(self, name)))
        ]


@dataclass(frozen=True, eq=False)
class Pulses:
    """Pulses of one channel: rising edges and widths, in seconds of the controller and in us."""

    starts_s: FloatArray
    widths_us: FloatArray


@dataclass
class Emulator:
    """A running controller. `send_signal` per emulator.c."""

    process: subprocess.Popen[bytes]
    pins: Path
    stack_report: str = field(default="", init=False)

    def _send(self, what: signal.Signals) -> None:
        os.kill(self.process.pid, what)  # Popen.send_signal does nothing in a process that was forked from its own

    def reset(self) -> None:
        self._send(signal.SIGUSR1)

    def lose_power(self) -> None:
        """For a moment: as a reset, but its memory is lost."""
        self._send(signal.SIGPWR)

    def move_cable(self) -> None:
        """Pull it, or put it back."""
        self._send(signal.SIGHUP)

    def stop_timer(self) -> None:
        self._send(signal.SIGUSR2)

    def end(self) -> None:
        if self.stack_report:
            return
        if self.process.poll() is None:
            self.process.terminate()
        if self.process.stdin and not self.process.stdin.closed:
            self.process.stdin.close()
        assert self.process.stderr is not None
        self.stack_report = self.process.stderr.read().decode()
        self.process.wait(10)
        self.process.stderr.close()
        if self.process.stdout:
            self.process.stdout.close()

    def pulses(self, channel: int) -> Pulses:
        """All pulses so far, of one that lasts what there has been of it; left out are those that a reset cut short,
        and one that is under way and may still end in time."""
        changes = np.fromfile(self.pins, dtype=[("cycle", "<u8"), ("channel", "u1"), ("level", "u1"), ("pad", "V6")])
        mine = changes[changes["channel"] == channel]
        cycles: IntArray = mine["cycle"].astype(np.int64)
        assert (mine["level"] == np.arange(len(mine)) % 2 ^ 1).all()
        if len(cycles) % 2:
            now = int(changes["cycle"][-1])
            cycles = np.append(cycles, now) if now - cycles[-1] > _LONGEST_PULSE_CYCLES else cycles[:-1]
        resets = changes["cycle"][(changes["channel"] == _NO_CHANNEL) & (changes["level"] == 1)]
        rises, falls = cycles.reshape(-1, 2)[~np.isin(cycles[1::2], resets)].T
        return Pulses(rises / CYCLES_PER_S, (falls - rises) / CYCLES_PER_S * 1e6)


def on_pty(built: Build, folder: Path, faults: Faults = Faults()) -> tuple[Emulator, Path]:
    """A controller in real time, and the device name of its line."""
    pty, pins = folder / "tty", folder / "pins.bin"
    process = subprocess.Popen(
        [built.emulator, built.firmware, pins, "--pty", pty, *faults.options()], stderr=subprocess.PIPE
    )
    with suppress(PermissionError):  # a controller shares its core with nobody: where it may, it goes first
        os.setpriority(os.PRIO_PROCESS, process.pid, _GOES_FIRST)
    deadline_s = time.monotonic() + 10
    while not pty.exists() and time.monotonic() < deadline_s and process.poll() is None:
        time.sleep(0.01)
    return Emulator(process, pins), pty


@dataclass
class LockStep:
    """A controller whose time passes only while its line is read or its clock slept by: a line and a clock in one."""

    emulator: Emulator
    cycle: int = 0
    _out: bytes = b""
    _in: bytes = b""

    def write(self, message: bytes) -> None:
        self._out += message

    def read(self, n: int, timeout: float) -> bytes:
        deadline = self.cycle + math.ceil(timeout * CYCLES_PER_S)
        while not self._in and self.cycle < deadline:
            self._run(deadline - self.cycle)
        taken, self._in = self._in[:n], self._in[n:]
        return taken

    def close(self) -> None:
        """The line can be opened again; the controller runs on."""

    def now_s(self) -> float:
        return self.cycle / CYCLES_PER_S

    def sleep_until(self, deadline_s: float) -> None:
        while self.now_s() < deadline_s:
            self._run(max(round(deadline_s * CYCLES_PER_S) - self.cycle, 1))

    def catch_up(self) -> None:
        """With what another process, which had this controller for a while, has made of it."""
        self._in = self._out = b""
        self._run(1)

    def _run(self, cycles: int) -> None:
        stdin, stdout = self.emulator.process.stdin, self.emulator.process.stdout
        assert stdin is not None and stdout is not None
        now, self._out = self._out[:0xFFFF], self._out[0xFFFF:]
        stdin.write(struct.pack("<IH", cycles, len(now)) + now)
        stdin.flush()
        self.cycle, n = struct.unpack("<QH", stdout.read(10))
        self._in += stdout.read(n)


def in_lock_step(built: Build, folder: Path, faults: Faults = Faults()) -> LockStep:
    process = subprocess.Popen(
        [built.emulator, built.firmware, folder / "pins.bin", "--lockstep", *faults.options()],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    return LockStep(Emulator(process, folder / "pins.bin"))
