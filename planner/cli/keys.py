"""Keys as they are pressed: at a terminal, at a console of Windows, or by a program that drives this one."""

from __future__ import annotations

import os
import queue
import re
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Protocol

_MOST = 1024
_SEQUENCES = re.compile(rb"\x1b(\[[0-?]*[ -/]*[@-~]|O.)")
"""What arrows and function keys arrive as, which begins as Esc does."""


class Keys(Protocol):
    """arrived: keys since it was asked last, those of arrows and functions left out, b"" for none; None once nobody is
    left to press any. wait: until there are some."""

    def arrived(self, *, wait: bool = False) -> bytes | None:
        """Never waits, unless asked to."""
        ...


class PipedKeys:
    """Of a program, by standard input, whatever that is."""

    def __init__(self) -> None:
        self._read: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        threading.Thread(target=self._listen, args=(sys.stdin.fileno(),), daemon=True).start()

    def arrived(self, *, wait: bool = False) -> bytes | None:
        try:
            return self._read.get(block=wait)
        except queue.Empty:
            return b""

    def _listen(self, descriptor: int) -> None:
        while True:
            try:
                read = os.read(descriptor, _MOST)
            except OSError:
                read = b""
            self._read.put(read or None)
            if not read:
                return


if sys.platform == "win32":
    import msvcrt
    from time import sleep

    _PREFIXES = ("\x00", "\xe0")
    """What the code of an arrow or a function key follows."""
    _LOOK_S = 0.01

    class ConsoleKeys:
        def arrived(self, *, wait: bool = False) -> bytes | None:
            pressed = ""
            while wait and not msvcrt.kbhit():
                sleep(_LOOK_S)
            while msvcrt.kbhit():
                key = msvcrt.getwch()
                if key in _PREFIXES:
                    msvcrt.getwch()
                else:
                    pressed += key
            return pressed.encode()

    @contextmanager
    def terminal_keys() -> Iterator[Keys | None]:
        """Keys of the console, where there is one."""
        yield ConsoleKeys() if sys.stdin is not None and sys.stdin.isatty() else None

else:
    import select
    import termios
    import tty

    class TerminalKeys:
        def __init__(self, terminal: int) -> None:
            self._terminal = terminal

        def arrived(self, *, wait: bool = False) -> bytes | None:
            if not select.select([self._terminal], [], [], None if wait else 0)[0]:
                return b""
            try:
                read = os.read(self._terminal, _MOST)
            except OSError:  # EIO: its other side is closed
                read = b""
            return _SEQUENCES.sub(b"", read) if read else None

    @contextmanager
    def terminal_keys() -> Iterator[Keys | None]:
        """Keys of the terminal one by one and not shown, if standard input is one that this program has in front.

        The terminal is as it was afterwards, however that comes.
        """
        try:
            terminal = sys.stdin.fileno()
            in_front = os.isatty(terminal) and os.tcgetpgrp(terminal) == os.getpgrp()
        except (AttributeError, OSError, ValueError):  # no standard input
            in_front = False
        if not in_front:
            yield None
            return
        before = termios.tcgetattr(terminal)
        try:
            tty.setcbreak(terminal)
            yield TerminalKeys(terminal)
        finally:
            with suppress(termios.error):  # the terminal may be gone
                termios.tcsetattr(terminal, termios.TCSADRAIN, before)
