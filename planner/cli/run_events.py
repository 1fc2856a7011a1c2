"""`plan run --events`: what a run does, for programs that drive it."""

from __future__ import annotations

from collections.abc import Iterable

from hardware.drivers.driver import Driver
from hardware.playback.observer import Observer, Progress
from hardware.playback.program import Program
from planner.cli.events import tell


class ToldRun(Observer):
    """What a run does, as it does it. every: set points between two of its reports."""

    def __init__(self, program: Program, driver: Driver, last_stroke: int, every: int) -> None:
        self._program, self._driver, self._last_stroke, self._every = program, driver, last_stroke, every
        self._calls = 0

    def connected(self) -> None:
        tell("connected", strokes=self._last_stroke + 1)

    def progressed(self, progress: Progress) -> None:
        self._calls += 1
        if self._calls % self._every and progress.reached < progress.total:
            return
        tell(
            "progress",
            reached=progress.reached,
            total=progress.total,
            sample=round(float(self._program.sample[progress.reached - 1]), 2),
            stroke=progress.stroke,
            left_s=round(progress.left_s, 2),
            paused=progress.paused,
            link=list(self._driver.statistics()),
        )


def tell_ended(how: str, summary: Iterable[str], *, complete: bool, parked: bool) -> None:
    """How a run ended."""
    tell("ended", how=how, complete=complete, parked=parked, summary=list(summary))
