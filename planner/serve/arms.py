"""The arms that there are: those that come with the planner, and those that people have jogged or calibrated here."""

from __future__ import annotations

import asyncio
import re
from pathlib import Path

from planner.arms.arm_file import known_arms
from planner.errors import OutputError, UsageError
from planner.serve.child import finished

VIEW = "planner.serve.view"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}")


class Arms:
    """Pages speak of arms by their names alone. Errors: OutputError where the folder cannot be had."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._views: dict[str, tuple[float, asyncio.Task[str | None]]] = {}
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise OutputError(str(folder), error.strerror or str(error)) from error

    def names(self) -> tuple[str, ...]:
        own = sorted(file.stem for file in self._folder.glob("*.toml") if _NAME.fullmatch(file.stem))
        return (*known_arms(), *(name for name in own if name not in known_arms()))

    def word(self, name: object) -> str:
        """What the command line takes for an arm: its name, or its file. Errors: UsageError."""
        if not isinstance(name, str) or name not in self.names():
            raise UsageError(f"there is no arm '{name!s:.40}' here; there are {', '.join(self.names())}")
        return name if name in known_arms() else str(self._file(name))

    def file_to_write(self, name: object, *, over: str = "") -> Path:
        """Where an arm is going to be saved under a name; over: the only one that may be there already. Errors:
        UsageError."""
        if not isinstance(name, str) or not _NAME.fullmatch(name):
            raise UsageError("the name of an arm is up to 40 letters, digits, - and _, such as my_arm")
        if name in known_arms() or (name != over and name in self.names()):
            raise UsageError(f"there is an arm '{name}' already: give another name")
        return self._file(name)

    async def view(self, name: str) -> Path:
        """The file of what the page shows of an arm, worked out once for each time that it is saved. Errors:
        UsageError."""
        word, target = self.word(name), self._folder / f"{name}.view.json"
        changed = 0.0 if word == name else self._file(name).stat().st_mtime
        if name not in self._views or self._views[name][0] != changed:
            task = asyncio.create_task(finished(["arm", word, str(target)], self._folder, module=VIEW))
            self._views[name] = changed, task
        error = await self._views[name][1]
        if error is not None:
            raise UsageError(error)
        return target

    def close(self) -> None:
        for _, task in self._views.values():
            task.cancel()

    def _file(self, name: str) -> Path:
        return self._folder / f"{name}.toml"
