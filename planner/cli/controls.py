"""What people at the arm want of it: keys of the terminal or of a program, Ctrl-C, a request to terminate, a terminal
that closes."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from types import FrameType

from hardware.playback.request import Request
from planner.cli.keys import Keys, PipedKeys, terminal_keys

KEYS = "space or p pauses and resumes, q or Ctrl-C stops and parks, x or Esc stops at once and holds"

_PAUSE, _STOP, _EMERGENCY_STOP = b" pP", b"qQ", (b"x", b"X", b"\x1b")
_SEVERITY = (Request.GO, Request.PAUSE, Request.STOP, Request.EMERGENCY_STOP)


class Controls:
    """The request that holds now; it only ever gets more severe, pausing and going on aside."""

    def __init__(self) -> None:
        self._request = Request.GO
        self._keys: Keys | None = None
        self._by_program = False
        self._awaits = False

    @property
    def has_keys(self) -> bool:
        return self._keys is not None

    def await_key(self) -> None:
        """The next key that pauses is an answer instead."""
        self._awaits = True

    def is_awaiting(self) -> bool:
        """Whether it has not been pressed yet."""
        self.request()
        return self._awaits

    def request(self) -> Request:
        """Looks whether a key has been pressed, and never waits."""
        keys = self._keys.arrived() if self._keys is not None else b""
        if keys is None:  # nobody is left to press a key
            self._keys = None
            if self._by_program:
                self._demand(Request.STOP)
        else:
            self._press(keys)
        return self._request

    def _press(self, keys: bytes) -> None:
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
    def keyboard(self, *, by_program: bool = False) -> Iterator[Keys | None]:
        """Keys count until this ends: of the terminal, or by standard input from a program, whose end stops the arm."""
        with nullcontext(PipedKeys()) if by_program else terminal_keys() as keys:
            self._keys, self._by_program = keys, by_program
            try:
                yield keys
            finally:
                self._keys = None


@contextmanager
def controls(*, by_program: bool = False) -> Iterator[Controls]:
    """Keys and signals become requests until this ends. by_program: one presses the keys."""
    wishes = Controls()
    with (
        _handling({"SIGINT": wishes.interrupt, "SIGTERM": wishes.interrupt, "SIGHUP": wishes.hang_up}),
        wishes.keyboard(by_program=by_program),
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
