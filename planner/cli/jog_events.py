"""`plan jog --events`: an arm that a program jogs. Commands arrive on standard input, and what they did leaves as lines
of JSON."""

from __future__ import annotations

import queue
import sys
import threading
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from planner.cli.events import tell
from planner.cli.jog_commands import carry_out
from planner.errors import UsageError

if TYPE_CHECKING:
    from hardware.jog.jogging import Jogging

_STOP = "stop"


class Piped:
    """Lines of standard input as commands. One that says stop overtakes all others."""

    def __init__(self) -> None:
        self._lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._stopped = False
        threading.Thread(target=self._listen, daemon=True).start()

    def watch(self) -> None:
        """Never waits. Errors: KeyboardInterrupt where a line has asked to stop at once."""
        if self._stopped:
            raise KeyboardInterrupt

    def commands(self) -> Iterator[str]:
        """One after the other, until nobody is left to say any. Errors: KeyboardInterrupt as `watch`."""
        while (line := self._lines.get()) is not None:
            self.watch()
            yield line
        self.watch()

    def _listen(self) -> None:
        for line in sys.stdin:
            if line.strip() == _STOP:
                self._stopped = True
                break
            self._lines.put(line)
        self._lines.put(None)


def follow_told(
    commands: Iterator[str], jogging: Jogging, save: Callable[[], str], is_saved: Callable[[], bool]
) -> None:
    """Carries out what a program says until it says no more. What is refused is told, and the next one is awaited.
    save: the name of the file that it wrote."""

    def told_save() -> None:
        tell("saved", file=save())

    _tell_stands(jogging, saved=is_saved())
    for command in commands:
        try:
            if not carry_out(command, jogging, told_save):
                return
        except UsageError as error:
            tell("refused", why=str(error))
        _tell_stands(jogging, saved=is_saved())


def _tell_stands(jogging: Jogging, *, saved: bool) -> None:
    """Where every joint stands, and the pen; positions in deg or mm, as in arm files."""
    arm = jogging.arm
    per = arm.per_file_unit
    rows = zip(arm.joints, jogging.positions / per, jogging.values, arm.minimum / per, arm.maximum / per, strict=True)
    tell(
        "stands",
        chosen=arm.joints[jogging.joint].name,
        joints=[
            {
                "name": joint.name,
                "at": round(float(at), 3),
                "unit": joint.file_unit,
                "min": round(float(low), 3),
                "max": round(float(high), 3),
                "told": round(float(value), 1),
                "told_unit": jogging.unit,
            }
            for joint, at, value, low, high in rows
        ],
        pen_mm=np.round(jogging.tip_mm, 2).tolist(),
        pen_is_up=jogging.pen_is_up,
        saved=saved,
    )
