"""The only user of pyserial: lines to controllers, by device name or URL. Each failure is one clear sentence."""

from __future__ import annotations

import errno
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import serial
from serial.tools import list_ports

from planner.errors import HardwareError

_FAILURES: tuple[type[Exception], ...] = (OSError, TypeError)
"""What a line that fails raises: pyserial's own errors are OSErrors; TypeError where another thread closed it."""
if sys.platform != "win32":
    import termios

    _FAILURES = (*_FAILURES, termios.error)

_REFUSALS: tuple[type[Exception], ...] = (*_FAILURES, ValueError)
"""What opening a line may raise: ValueError for a URL or a speed that means nothing."""

_WRITE_TIMEOUT_S = 1.0
"""A line that takes nothing for so long is dead: a controller's own buffer empties in milliseconds."""
_WITHOUT_WRITE_TIMEOUT = "rfc2217://"
"""The one kind of URL for which pyserial has none."""


@dataclass(frozen=True, slots=True)
class Line:
    """Where a controller is: a device name or a pyserial URL (socket://, rfc2217://, loop://), and how fast it talks.

    baud: None for what the controller comes with.
    """

    name: str
    baud: int | None = None

    def open(self, usual_baud: int) -> Port:
        """An open port at `baud`, or at the one that is usual for the controller. Errors: HardwareError."""
        try:
            return Port(
                self.name,
                serial.serial_for_url(
                    self.name,
                    baudrate=self.baud or usual_baud,
                    timeout=0.0,
                    exclusive=True,
                    write_timeout=None if self.name.startswith(_WITHOUT_WRITE_TIMEOUT) else _WRITE_TIMEOUT_S,
                ),
            )
        except _REFUSALS as error:
            raise HardwareError(f"{self.name}: {_why_not(self.name, error)}") from error


class Port:
    """An open line. Every failure of it is a HardwareError that names it."""

    def __init__(self, name: str, opened: serial.Serial) -> None:
        self.name = name
        self._serial = opened

    def seconds(self, size: int) -> float:
        """How long `size` bytes are on the line: ten bits each. 0 over a network, where no one here knows."""
        return 0.0 if "://" in self.name else 10 * size / float(self._serial.baudrate)

    def read(self, size: int, timeout_s: float = 0.0) -> bytes:
        """As many as `size` bytes, fewer where no more have come within `timeout_s`."""
        with self._failures_named():
            if self._serial.timeout != timeout_s:
                self._serial.timeout = timeout_s
            return bytes(self._serial.read(size))

    def write(self, message: bytes) -> None:
        with self._failures_named():
            self._serial.write(message)

    def discard_input(self) -> None:
        """Forget what has come and was not read."""
        with self._failures_named():
            self._serial.reset_input_buffer()

    def close(self) -> None:
        """Let go of the line, whatever state it is in. Allowed more than once."""
        held = getattr(self._serial, "_socket", None)  # which pyserial forgets to close once the other end is gone
        with suppress(*_FAILURES):
            self._serial.close()
        if held is not None:
            held.close()

    @contextmanager
    def _failures_named(self) -> Iterator[None]:
        try:
            yield
        except serial.SerialTimeoutException as error:
            raise HardwareError(
                f"{self.name}: the controller takes no more bytes; is it powered, and does the line "
                "need another --baud?"
            ) from error
        except _FAILURES as error:
            raise HardwareError(
                f"{self.name}: the line failed ({_reason(error)}); check the cable and the power of the controller"
            ) from error


@dataclass(frozen=True, slots=True)
class PluggedIn:
    """A serial device of this computer. usb_id: (vendor, product), None where it is not on USB."""

    device: str
    description: str
    usb_id: tuple[int, int] | None


def plugged_in() -> list[PluggedIn]:
    """The serial devices of this computer, by name."""
    return [
        PluggedIn(
            port.device,
            port.description if port.description != "n/a" else "",
            None if port.vid is None or port.pid is None else (port.vid, port.pid),
        )
        for port in sorted(list_ports.comports())
    ]


def _why_not(name: str, error: Exception) -> str:
    """What keeps a line from being opened, and what to do about it."""
    number = error.errno if isinstance(error, OSError) else None
    if number is None and error.__context__ is not None and error.__context__.args:  # a termios.error has no errno
        number = error.__context__.args[0]
    if number in (errno.ENOTTY, errno.EISDIR):
        return "this is not a serial port; plan ports lists those there are"
    if number in (errno.ENOENT, errno.ENODEV, errno.ENXIO):
        devices = ", ".join(port.device for port in plugged_in())
        return "there is no such port; " + (f"plugged in: {devices}" if devices else "nothing is plugged in")
    if number in (errno.EACCES, errno.EPERM):
        return f"no permission to open it; {_permission(Path(name))}"
    if number in (errno.EBUSY, errno.EAGAIN):
        return "another program has it open; close that first"
    return f"cannot be opened ({_reason(error)}); plan ports lists what is plugged in"


def _permission(device: Path) -> str:
    group = "root"
    if sys.platform != "win32":
        with suppress(OSError, KeyError):
            group = device.group()
    if group == "root":
        return "ask whoever administers this computer"
    return f"join the group that may open it: sudo usermod -aG {group} $USER, then log in again"


def _reason(error: Exception) -> str:
    """The operating system's words where there are any, on one line."""
    while isinstance(error.__context__, OSError) and not (isinstance(error, OSError) and error.errno):
        error = error.__context__
    words = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return " ".join(words.split())
