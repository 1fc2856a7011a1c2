"""The arm, one joint at a time, by `plan jog` in a process of its own."""

from __future__ import annotations

import asyncio
import shlex
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from hardware.drivers.table import MUJOCO
from planner.errors import UsageError
from planner.serve.arms import Arms
from planner.serve.asked import number_of, port_words
from planner.serve.child import Child, error_of, follow, start
from planner.serve.turn import Turn

_HOLDING_S = 5.0
_PLAIN = ("reverse", "low", "high", "park", "pen up", "pen down", "save", "quit")
_WITH_NUMBER = ("move", "to", "zero", "card")


class Stand(StrEnum):
    """What jogging does."""

    IDLE = "idle"
    STARTING = "starting"
    READY = "ready"
    MOVING = "moving"


@dataclass(slots=True)
class Jogged:
    """Where jogging is. arm: by name; target: the arm that save writes. joints, pen_mm, pen_is_up, saved: as `plan jog
    --events` tells them. refused: why the last command was; ended: how it did, and lines about it."""

    stand: Stand = Stand.IDLE
    arm: str = ""
    target: str = ""
    driver: str = ""
    command: str = ""
    joints: list[dict[str, Any]] = field(default_factory=list)
    pen_mm: list[float] = field(default_factory=list)
    pen_is_up: bool = False
    saved: bool = True
    refused: str = ""
    ended: str = ""
    lines: list[str] = field(default_factory=list)


class Jog:
    """changed: called when it has. arm_saved: when an arm file has been written."""

    def __init__(
        self,
        folder: Path,
        arms: Arms,
        drivers: Sequence[str],
        turn: Turn,
        changed: Callable[[], None],
        arm_saved: Callable[[], None],
    ) -> None:
        self._folder, self._arms, self._turn = folder, arms, turn
        self._drivers = [name for name in drivers if name != MUJOCO]
        self._changed, self._arm_saved = changed, arm_saved
        self.jogged = Jogged()
        self._waiting = 0
        self._child: Child | None = None
        self._task: asyncio.Task[None] | None = None

    def state(self) -> dict[str, Any]:
        return asdict(self.jogged)

    def begin(self, asked: Mapping[str, Any]) -> None:
        """Errors: UsageError where the arm is busy, or what is asked means nothing."""
        word = self._arms.word(asked.get("arm"))
        target = self._arms.file_to_write(asked.get("target"), over=str(asked["arm"]))
        driver = asked.get("driver", "sim")
        if driver not in self._drivers:
            raise UsageError(f"there is no driver '{driver!s:.40}' here; there are {', '.join(self._drivers)}")
        words = [f"--arm={word}", f"--output={target}", f"--driver={driver}", *port_words(asked)]
        if asked.get("from-middle") is True:
            words.append("--from-middle")
        self._turn.take("being jogged")
        self.jogged = Jogged(
            Stand.STARTING, str(asked["arm"]), target.stem, str(driver), shlex.join(["plan", "jog", *words])
        )
        self._task = asyncio.get_running_loop().create_task(self._jog(words))
        self._changed()

    def do(self, asked: Mapping[str, Any]) -> None:
        """One command, of a joint where it says which. Errors: UsageError for what is none, and where nothing is
        jogged."""
        lines = _lines_of(asked, [joint["name"] for joint in self.jogged.joints])
        if self._child is None or self.jogged.stand not in (Stand.READY, Stand.MOVING):
            raise UsageError("no arm is being jogged")
        self.jogged.refused = ""
        self.jogged.stand = Stand.MOVING
        self._waiting += len(lines)
        for line in lines:
            self._child.press(f"{line}\n")
        self._changed()

    def stop(self) -> None:
        """The arm holds at once, and jogging is over. Errors: UsageError where nothing is jogged."""
        if self._task is None:
            raise UsageError("no arm is being jogged")
        if self._child is None:  # it has not even begun
            self._task.cancel()
        elif self.jogged.stand is Stand.STARTING:
            self._child.interrupt()
        else:
            self._child.press("stop\n")

    async def close(self) -> None:
        """The arm holds before this returns."""
        if self._task is None:
            return
        with suppress(UsageError):
            self.stop()
        done, _ = await asyncio.wait([self._task], timeout=_HOLDING_S)
        if not done:
            self._task.cancel()
            await asyncio.wait([self._task])

    async def _jog(self, words: Sequence[str]) -> None:
        jogged = self.jogged
        child: Child | None = None
        try:
            child = await start(["jog", "--events", *words], self._folder, behind=False, keys=True)
            self._child, self._waiting = child, 0
            code = await follow(child, self._told)
            jogged.ended = jogged.ended or (error_of(child, code) if code else "done: the arm holds")
            jogged.lines = [note for note in child.notes if note != "interrupted" and not note.startswith("error: ")]
        except asyncio.CancelledError:
            jogged.ended = "stopped"
            if child is not None:
                await child.end()
        except OSError as error:
            jogged.ended = str(error)
        finally:
            self._child = self._task = None
            self._turn.give_back()
            jogged.stand = Stand.IDLE
            self._changed()

    def _told(self, event: dict[str, Any]) -> None:
        jogged = self.jogged
        match event.get("event"):
            case "stands":
                for name in ("joints", "pen_mm", "pen_is_up", "saved"):
                    setattr(jogged, name, event[name])
                self._waiting -= jogged.stand is Stand.MOVING
                jogged.stand = Stand.MOVING if self._waiting > 0 else Stand.READY
            case "refused":
                jogged.refused = str(event["why"])
            case "saved":
                self._arm_saved()
            case "stopped":
                jogged.ended = "stopped: the arm holds where it is"
        self._changed()


def _lines_of(asked: Mapping[str, Any], joints: Sequence[str]) -> list[str]:
    """Errors: UsageError."""
    command, joint, number = asked.get("command"), asked.get("joint"), asked.get("number")
    lines = []
    if joint is not None:
        if joint not in joints:
            raise UsageError(f"there is no joint '{joint!s:.40}'; there are {', '.join(joints)}")
        lines.append(f"joint {joint}")
    if command in _PLAIN:
        return [*lines, str(command)]
    if command not in _WITH_NUMBER:
        raise UsageError(f"there is no command '{command!s:.40}' here")
    return [*lines, f"{command} {number_of(f'that of {command}', number):.6f}"]
