"""The doorway to pyserial: a line to a controller, by device name or pyserial URL."""

from __future__ import annotations

import serial

from planner.errors import HardwareError


class Port:
    """An open line. Every failure is a HardwareError that names it."""

    def __init__(self, line: serial.SerialBase, name: str) -> None:
        self._line, self._name = line, name

    def read(self, n: int, timeout: float) -> bytes:
        """Up to `n` bytes, waiting for them for no longer than `timeout` seconds."""
        try:
            self._line.timeout = timeout
            return bytes(self._line.read(n))
        except (serial.SerialException, OSError) as error:
            raise self._failed(error) from error

    def write(self, message: bytes) -> None:
        try:
            self._line.write(message)
        except (serial.SerialException, OSError) as error:
            raise self._failed(error) from error

    def close(self) -> None:
        self._line.close()

    def _failed(self, error: Exception) -> HardwareError:
        return HardwareError(f"{self._name}: the line failed ({error}); check the cable, then go on with --resume")


def open_port(url: str, baud: int) -> Port:
    try:
        return Port(serial.serial_for_url(url, baudrate=baud, timeout=0, write_timeout=2), url)
    except (serial.SerialException, OSError, ValueError) as error:
        raise HardwareError(f"{url} cannot be opened: {error}") from error
