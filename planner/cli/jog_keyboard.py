"""`plan jog` at a terminal: keys, the commands that they stand for, and the one that stops at once."""

from __future__ import annotations

import sys
from collections.abc import Iterator

from planner.cli.keys import Keys

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


class KeyCommands:
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
    """Keys as lines of commands."""

    def __init__(self, keys: Keys) -> None:
        self._keys = keys
        self._pressed = ""

    def watch(self) -> None:
        """Never waits. Errors: KeyboardInterrupt where a key asks to stop at once."""
        self._read(wait=False)
        if any(key in _STOP for key in self._pressed):
            raise KeyboardInterrupt

    def agrees(self) -> bool:
        """Whether the next key is y. Errors: KeyboardInterrupt as `watch`."""
        return self._next() in ("y", "Y")

    def commands(self) -> Iterator[str]:
        """One after the other, until the terminal is gone. Errors: KeyboardInterrupt as `watch`."""
        keys = KeyCommands()
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

    def _read(self, *, wait: bool = True) -> bool:
        """Whether somebody is still there to press keys."""
        arrived = self._keys.arrived(wait=wait)
        self._pressed += (arrived or b"").decode("utf-8", errors="replace")
        return arrived is not None
