"""The arm: one run at a time, whoever asks for it, by the command in a process of its own."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from planner.errors import UsageError
from planner.serve.asked import number_of, port_words
from planner.serve.child import Child, error_of, follow, start
from planner.serve.turn import Turn

_PARKING_S = 120.0
"""What an arm may take to lift its pen and go home."""


class Stand(StrEnum):
    """What the arm does."""

    IDLE = "idle"
    STARTING = "starting"
    PLAYING = "playing"
    PAUSED = "paused"
    AWAITING_PEN = "awaiting pen"
    STOPPING = "stopping"


class Wish(StrEnum):
    """What people at a page may ask of a run, by the key of `plan run`."""

    PAUSE = "pause"
    RESUME = "resume"
    PEN = "pen"
    STOP = "stop"
    HOLD = "hold"


@dataclass(frozen=True, slots=True)
class Playable:
    """What can be run. key: of the job, or of what else it belongs to. folder, file: where the trajectory is. options:
    that such a run always has. ended: called with how a run of it did, and whether it drew all; not for a frame."""

    key: str
    name: str
    folder: Path
    file: str
    ended: Callable[[str, bool], None]
    options: tuple[str, ...] = ()


@dataclass(slots=True)
class Running:
    """Where a run is. job: the key of what is run, "" before the first; name: of that. sample: of the trajectory; pen:
    the one to be put in; ended: how the last one did, and lines about it."""

    stand: Stand = Stand.IDLE
    job: str = ""
    name: str = ""
    driver: str = ""
    reached: int = 0
    total: int = 0
    sample: float = 0.0
    stroke: int = -1
    left_s: float = 0.0
    link: list[str] = field(default_factory=list)
    pen: str = ""
    ended: str = ""
    complete: bool = False
    lines: list[str] = field(default_factory=list)


class Arm:
    """changed: called when the run has."""

    def __init__(self, drivers: Sequence[str], turn: Turn, changed: Callable[[], None]) -> None:
        self._drivers, self._turn, self._changed = drivers, turn, changed
        self.running = Running()
        self._child: Child | None = None
        self._task: asyncio.Task[None] | None = None

    def runs(self, key: str) -> bool:
        """Whether this is being run."""
        return self._task is not None and self.running.job == key

    def state(self) -> dict[str, Any]:
        return asdict(self.running)

    def begin(self, what: Playable, asked: Mapping[str, Any]) -> None:
        """Errors: UsageError where the arm is busy, or what is asked means nothing."""
        words = [*what.options, *self._arguments(asked)]
        self._turn.take("drawing")
        self.running = Running(Stand.STARTING, what.key, what.name, str(asked.get("driver", "sim")))
        self._task = asyncio.get_running_loop().create_task(self._run(what, words))
        self._changed()

    def wish(self, wish: Wish) -> None:
        """Errors: UsageError where nothing runs."""
        if self._child is None or self._child.process.returncode is not None:
            if self._task is not None and wish in (Wish.STOP, Wish.HOLD):  # it has not even begun
                self._task.cancel()
                return
            raise UsageError("nothing is being drawn")
        stand = self.running.stand
        if wish is Wish.HOLD:
            self._child.press("x")
            self._stand(Stand.STOPPING)
        elif wish is Wish.STOP:
            self._child.press("q")
            self._stand(Stand.STOPPING)
        elif wish is Wish.PEN and stand is Stand.AWAITING_PEN:
            self.running.pen = ""
            self._child.press(" ")
            self._stand(Stand.PLAYING)
        elif (wish is Wish.PAUSE and stand is Stand.PLAYING) or (wish is Wish.RESUME and stand is Stand.PAUSED):
            self._child.press("p")

    async def close(self) -> None:
        """The pen is lifted and the arm parked before this returns."""
        if self._task is None:
            return
        with suppress(UsageError):
            self.wish(Wish.STOP)
        done, _ = await asyncio.wait([self._task], timeout=_PARKING_S)
        if not done:
            self._task.cancel()
            await asyncio.wait([self._task])

    def _arguments(self, asked: Mapping[str, Any]) -> list[str]:
        driver = asked.get("driver", "sim")
        if driver not in self._drivers:
            raise UsageError(f"there is no driver '{driver!s:.40}' here; there are {', '.join(self._drivers)}")
        words = [f"--driver={driver}", *port_words(asked)]
        factor = asked.get("speed-factor")
        if factor is not None:
            words.append(f"--speed-factor={number_of('speed-factor', factor):g}")
        words += [f"--{name}" for name in ("resume", "frame", "fast") if asked.get(name) is True]
        return words

    async def _run(self, what: Playable, words: Sequence[str]) -> None:
        running = self.running
        child: Child | None = None
        try:
            child = await start(["run", what.file, "--events", *words], what.folder, behind=False, keys=True)
            self._child = child
            code = await follow(child, self._told)
            if not running.ended:
                running.ended = error_of(child, code) if code else "done"
                running.complete = code == 0
            running.lines += [note for note in child.notes if note not in running.lines]
        except asyncio.CancelledError:
            running.ended = "stopped before it began"
            if child is not None:
                await child.end()
        except OSError as error:
            running.ended = str(error)
        finally:
            self._child = self._task = None
            self._turn.give_back()
            running.stand, running.pen = Stand.IDLE, ""
            if "--frame" not in words:
                what.ended(running.ended, running.complete)
            self._changed()

    def _told(self, event: dict[str, Any]) -> None:
        running = self.running
        match event.get("event"):
            case "connected":
                running.stand = Stand.PLAYING if running.stand is Stand.STARTING else running.stand
            case "progress":
                for name in ("reached", "total", "sample", "stroke", "left_s", "link"):
                    setattr(running, name, event[name])
                if running.stand in (Stand.PLAYING, Stand.PAUSED):
                    running.stand = Stand.PAUSED if event["paused"] else Stand.PLAYING
            case "insert":
                running.pen = str(event["pen"])
                if running.stand is not Stand.STOPPING:
                    running.stand = Stand.AWAITING_PEN
            case "ended":
                running.ended, running.complete = str(event["how"]), bool(event["complete"])
                running.lines = [str(line) for line in event["summary"]]
        self._changed()

    def _stand(self, stand: Stand) -> None:
        self.running.stand = stand
        self._changed()
