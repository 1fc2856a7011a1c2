"""The other end of a line: a model of a controller behind a real pseudo-terminal, or behind a TCP port."""

from __future__ import annotations

import contextlib
import os
import pty
import select
import socket
import threading
import time
import tty
from collections.abc import Callable, Iterator
from typing import Protocol

import serial
from serial.rfc2217 import PortManager

_QUIET_S = 0.03
"""What is written to a pseudo-terminal is there to be read well within this."""


class Model(Protocol):
    """A controller by its manual: bytes in, bytes out; anything it should never be sent is an AssertionError."""

    def receive(self, message: bytes) -> bytes: ...


class FarEnd:
    """Feeds a model from a descriptor, which `opened` waits for, in a thread of its own."""

    def __init__(self, name: str, model: Model, opened: Callable[[], int]) -> None:
        self.name, self._model, self._opened = name, model, opened
        self.received = bytearray()
        self._failure: AssertionError | None = None
        self._waker, self._alarm = os.pipe()
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def _serve(self) -> None:
        descriptor = self._opened()
        try:
            while True:
                ready, _, _ = select.select([descriptor, self._waker], [], [])
                if descriptor not in ready:
                    return
                message = os.read(descriptor, 4096)
                if not message:
                    return
                self.received += message
                answer = self._model.receive(message)
                if answer:
                    os.write(descriptor, answer)
        except AssertionError as failure:
            self._failure = failure
        except OSError:  # the near end is gone
            return
        finally:
            os.close(descriptor)

    def finish(self) -> None:
        """Once all that was sent has come."""
        before = -1
        while before < len(self.received):
            before = len(self.received)
            time.sleep(_QUIET_S)
        self.unplug()

    def unplug(self) -> None:
        """As if the cable were pulled."""
        os.write(self._alarm, b"x")
        self._thread.join()

    def end(self) -> None:
        self.unplug()
        os.close(self._waker)
        os.close(self._alarm)
        if self._failure is not None:
            raise self._failure


class Rfc2217:
    """A model behind a serial bridge that speaks RFC 2217, by pyserial's own far end of it."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._replies = bytearray()
        self._manager = PortManager(serial.serial_for_url("loop://"), self)

    def write(self, reply: bytes) -> None:
        """What the bridge itself has to say."""
        self._replies += reply

    def receive(self, message: bytes) -> bytes:
        answer = self._model.receive(b"".join(self._manager.filter(message)))
        replies = bytes(self._replies)
        self._replies.clear()
        return replies + b"".join(self._manager.escape(answer))


@contextlib.contextmanager
def pty_line(model: Model) -> Iterator[FarEnd]:
    """A device name that a driver can open, with the model behind it. What the model found wrong is raised at last."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    far = FarEnd(os.ttyname(slave), model, lambda: master)
    try:
        yield far
    finally:
        far.end()
        os.close(slave)


@contextlib.contextmanager
def tcp_line(model: Model) -> Iterator[FarEnd]:
    """A socket:// URL with the model behind it, as a serial bridge on the network is."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(20)
        far = FarEnd(f"socket://127.0.0.1:{server.getsockname()[1]}", model, lambda: server.accept()[0].detach())
        try:
            yield far
        finally:
            far.end()
