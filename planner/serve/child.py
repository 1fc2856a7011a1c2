"""A command of the planner in a process of its own, by what it tells as it goes."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

_LONGEST_LINE = 1 << 20
_MOST_NOTES = 50
_BEHIND = 5
"""How far plans stand back: the page and the arm go first."""
_PATIENCE_S = 5.0

Told = Callable[[dict[str, Any]], None]


@dataclass(slots=True)
class Child:
    """A running command. notes: its last lines on standard error, without the program's name."""

    process: asyncio.subprocess.Process
    notes: list[str] = field(default_factory=list)

    def press(self, key: str) -> None:
        """A key for `plan run --events`; nothing where nobody reads it any more."""
        with suppress(BrokenPipeError, ConnectionResetError):
            if self.process.stdin is not None:
                self.process.stdin.write(key.encode())

    def interrupt(self) -> None:
        with suppress(ProcessLookupError):
            self.process.send_signal(signal.SIGINT)

    async def end(self) -> None:
        """Interrupted, and killed if that does not help."""
        self.interrupt()
        try:
            await asyncio.wait_for(self.process.wait(), _PATIENCE_S)
        except TimeoutError:
            with suppress(ProcessLookupError):
                self.process.kill()


async def start(
    arguments: Sequence[str], folder: Path, *, behind: bool, keys: bool = False, module: str = "planner"
) -> Child:
    """Starts `python -m MODULE ARGUMENTS` in a folder, which is the command `plan` where nothing else is said.

    behind: other processes go first. keys: it is going to be sent some. It has a session of its own, so that Ctrl-C in
    the terminal of the server does not reach it: the server decides.
    """
    process = await asyncio.create_subprocess_exec(
        sys.executable,
        "-P",  # nothing that lies in the folder is imported
        "-m",
        module,
        *arguments,
        cwd=folder,
        stdin=asyncio.subprocess.PIPE if keys else asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        limit=_LONGEST_LINE,
        start_new_session=True,
    )
    if behind and sys.platform != "win32":
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, process.pid, _BEHIND)
    return Child(process)


async def listen(child: Child, heard: Callable[[str], None]) -> int:
    """Hands on the lines that the command prints until it is over; its exit code."""
    await asyncio.gather(_printed(child, heard), _notes(child))
    return await child.process.wait()


async def follow(child: Child, told: Told) -> int:
    """The same with what it tells as events."""

    def heard(line: str) -> None:
        with suppress(ValueError):
            event = json.loads(line)
            if isinstance(event, dict):
                told(event)

    return await listen(child, heard)


async def finished(
    arguments: Sequence[str], folder: Path, begun: Callable[[Child], None] | None = None, module: str = "planner"
) -> str | None:
    """Runs a command that tells nothing. None, or why it failed."""
    child = await start(arguments, folder, behind=True, module=module)
    if begun:
        begun(child)
    code = await follow(child, lambda event: None)
    return None if code == 0 else error_of(child, code)


def error_of(child: Child, code: int) -> str:
    """What a command said as it failed."""
    errors = [note.removeprefix("error: ") for note in child.notes if note.startswith("error: ")]
    return errors[-1] if errors else child.notes[-1] if child.notes else f"it ended with exit code {code}"


async def _printed(child: Child, heard: Callable[[str], None]) -> None:
    while child.process.stdout is not None and (line := await child.process.stdout.readline()):
        heard(line.decode(errors="replace").rstrip())


async def _notes(child: Child) -> None:
    while child.process.stderr is not None and (line := await child.process.stderr.readline()):
        child.notes.append(line.decode(errors="replace").strip().removeprefix("plan: "))
        del child.notes[:-_MOST_NOTES]
