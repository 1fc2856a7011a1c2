"""What people at the arm want of it: keys of the terminal or of a program, Ctrl-C, a request to terminate, a terminal
that closes."""

from __future__ import annotations

import os
import re
import select
import signal
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from types import FrameType

from hardware.playback.request import Request

KEYS = "space or p pauses and resumes, q or Ctrl-C stops and parks, x or Esc stops at once and holds"

_PAUSE, _STOP, _EMERGENCY_STOP = b" pP", b"qQ", (b"x", b"X", b"\x1b")
SEQUENCES = re.compile(rb"\x1b(\[[0-?]*[ -/]*[@-~]|O.)")
"""What arrows and function keys arrive as, which begins as Esc does."""
_SEVERITY = (Request.GO, Request.PAUSE, Request.STOP, Request.EMERGENCY_STOP)


class Controls:
    """The request that holds now; it only ever gets more severe, pausing and going on aside."""

    def __init__(self) -> None:
        self._request = Request.GO
        self._keyboard: int | None = None
        self._is_pipe = False
        self._awaits = False

    @property
    def has_keys(self) -> bool:
        return self._keyboard is not None

    def await_key(self) -> None:
        """The next key that pauses is an answer instead."""
        self._awaits = True

    def is_awaiting(self) -> bool:
        """Whether it has not been pressed yet."""
        self.request()
        return self._awaits

    def request(self) -> Request:
        """Looks whether a key has been pressed, and never waits."""
        if self._keyboard is not None and select.select([self._keyboard], [], [], 0)[0]:
            try:
                keys = os.read(self._keyboard, 1024)
            except OSError:  # EIO: its other side is closed
                keys = b""
            if not keys:  # the other side is gone: nobody is left to press a key
                self._keyboard = None
                if self._is_pipe:
                    self._demand(Request.STOP)
            self._press(keys)
        return self._request

    def _press(self, keys: bytes) -> None:
        keys = SEQUENCES.sub(b"", keys)
        for key in (keys[place : place + 1] for place in range(len(keys))):
            if key in _EMERGENCY_STOP:
                self._demand(Request.EMERGENCY_STOP)
            elif key in _STOP:
                self._demand(Request.STOP)
            elif key in _PAUSE and self._awaits:
                self._awaits = False
            elif key in _PAUSE:
                self._demand(Request.GO if self._request is Request.PAUSE else Request.PAUSE)

    def _demand(self, request: Request) -> None:
        if request is Request.GO or _SEVERITY.index(request) > _SEVERITY.index(self._request):
            self._request = request

    def interrupt(self, number: int, frame: FrameType | None) -> None:
        """The first signal stops, the second stops at once, and a third breaks in wherever it may be."""
        if self._request is Request.EMERGENCY_STOP:
            raise KeyboardInterrupt
        self._demand(Request.EMERGENCY_STOP if self._request is Request.STOP else Request.STOP)

    def hang_up(self, number: int, frame: FrameType | None) -> None:
        """The terminal has been closed, of which the system and the shell may both tell: nobody asks for more than a
        stop."""
        self._demand(Request.STOP)

    @contextmanager
    def pipe(self) -> Iterator[None]:
        """Keys come by standard input, whatever that is, from a program; once it is gone, the arm is to stop."""
        self._keyboard, self._is_pipe = sys.stdin.fileno(), True
        try:
            yield
        finally:
            self._keyboard = None

    @contextmanager
    def keyboard(self) -> Iterator[None]:
        """Keys are read one by one and not shown, if standard input is a terminal and this program has it in front.

        The terminal is as it was afterwards, however that comes.
        """
        try:
            import termios
            import tty

            terminal = sys.stdin.fileno()
            in_front = os.isatty(terminal) and os.tcgetpgrp(terminal) == os.getpgrp()
        except (ImportError, AttributeError, OSError, ValueError):  # no terminals of this kind, or no standard input
            in_front = False
        if not in_front:
            yield
            return
        before = termios.tcgetattr(terminal)
        try:
            tty.setcbreak(terminal)
            self._keyboard = terminal
            yield
        finally:
            self._keyboard = None
            with suppress(termios.error):  # the terminal may be gone
                termios.tcsetattr(terminal, termios.TCSADRAIN, before)


@contextmanager
def controls(*, by_pipe: bool = False) -> Iterator[Controls]:
    """Keys and signals become requests until this ends. by_pipe: a program presses the keys."""
    wishes = Controls()
    with (
        _handling({"SIGINT": wishes.interrupt, "SIGTERM": wishes.interrupt, "SIGHUP": wishes.hang_up}),
        wishes.pipe() if by_pipe else wishes.keyboard(),
    ):
        yield wishes


@contextmanager
def breaking_off() -> Iterator[None]:
    """A request to terminate and a terminal that closes end the program as Ctrl-C does, until this ends: while nothing
    moves, what is open only has to be closed."""
    with _handling({"SIGTERM": _break_off, "SIGHUP": _break_off}):
        yield


def _break_off(number: int, frame: FrameType | None) -> None:
    raise KeyboardInterrupt


@contextmanager
def _handling(handlers: Mapping[str, Callable[[int, FrameType | None], None]]) -> Iterator[None]:
    """Signals by name, those that this system has, go to their handlers until this ends."""
    before = {}
    try:
        for name, handler in handlers.items():
            number = getattr(signal, name, None)
            if number is None or (name == "SIGHUP" and signal.getsignal(number) is signal.SIG_IGN):  # nohup asks for it
                continue
            before[number] = signal.signal(number, handler)
        yield
    finally:
        for number, earlier in before.items():
            signal.signal(number, earlier)
