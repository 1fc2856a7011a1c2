"""`plan jog` at a terminal: keys, the commands that they stand for, and the one that stops at once."""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Iterator

from planner.cli.controls import SEQUENCES

_ESCAPE = "\x1b"
_STOP = f"xX{_ESCAPE}"
_COMMAND, _ENTER, _DELETE = ":", "\r\n", "\x7f\b"
_KEYS = {
    "r": "reverse",
    "z": "zero",
    "l": "low",
    "h": "high",
    "p": "park",
    "u": "pen up",
    "d": "pen down",
    "c": "card",
    "s": "save",
    "q": "quit",
    " ": "show",
}


class Keys:
    """Keys to commands. step: deg or mm."""

    def __init__(self, step: float = 1.0) -> None:
        self.step = step

    def command(self, key: str) -> str | None:
        """None where the key says nothing, or only changes the step."""
        match key:
            case "[" | "]":
                self.step = min(max(self.step * (2.0 if key == "]" else 0.5), 0.125), 16.0)
                return None
            case "+" | "=" | "-":
                return f"move {-self.step if key == '-' else self.step:g}"
            case _ if key.isascii() and key.isdigit() and key != "0":
                return f"joint {key}"
            case _:
                return _KEYS.get(key)


class Keyboard:
    """Keys of the terminal with the descriptor `terminal`, as lines of commands."""

    def __init__(self, terminal: int) -> None:
        self._terminal = terminal
        self._pressed = ""

    def watch(self) -> None:
        """Never waits. Errors: KeyboardInterrupt where a key asks to stop at once."""
        while select.select([self._terminal], [], [], 0)[0] and self._read():
            pass
        if any(key in _STOP for key in self._pressed):
            raise KeyboardInterrupt

    def agrees(self) -> bool:
        """Whether the next key is y. Errors: KeyboardInterrupt as `watch`."""
        return self._next() in ("y", "Y")

    def commands(self) -> Iterator[str]:
        """One after the other, until the terminal is gone. Errors: KeyboardInterrupt as `watch`."""
        keys = Keys()
        while (key := self._next()) is not None:
            command = self._typed() if key == _COMMAND else keys.command(key)
            if command is not None:
                yield command

    def _typed(self) -> str:
        """A command that is typed, letter by letter, shown as it grows."""
        line = ""
        while True:
            print(f"\r\x1b[K:{line}", end="", file=sys.stderr, flush=True)
            key = self._next(_ESCAPE)  # a joint may have an x in its name
            if key is None or key in _ENTER:
                print(file=sys.stderr)
                return line
            line = line[:-1] if key in _DELETE else line + key

    def _next(self, stop: str = _STOP) -> str | None:
        while not self._pressed:
            if not self._read():
                return None
        key, self._pressed = self._pressed[0], self._pressed[1:]
        if key in stop:
            raise KeyboardInterrupt
        return key

    def _read(self) -> bool:
        """Wait for keys, of which what arrows and function keys arrive as is passed over; whether any came."""
        try:
            arrived = os.read(self._terminal, 64)
        except OSError:  # the terminal is gone
            return False
        self._pressed += SEQUENCES.sub(b"", arrived).decode("utf-8", errors="replace")
        return bool(arrived)
