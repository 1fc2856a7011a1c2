"""`plan run`: pens are changed while a trajectory with several is played."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

import numpy as np

from hardware.clock import Clock
from planner.arrays import FloatArray
from planner.cli.controls import Controls
from planner.cli.events import tell
from planner.cli.terminal import print_note
from planner.trajectory import Trajectory


class PenChanges:
    """Asks for the next pen and waits for a key; knows afterwards which pen was in the holder when."""

    def __init__(
        self, trajectory: Trajectory, first_stroke: int, clock: Clock, insert: Callable[[float], None]
    ) -> None:
        """first_stroke: the first that is drawn; the pens before its own are changed already. insert: is told how far
        the tip sticks out of each pen that comes."""
        self._pens, self._clock, self._insert = trajectory.pens, clock, insert
        n_strokes = len(trajectory.pen_of_stroke)
        first = int(trajectory.pen_of_stroke[min(first_stroke, n_strokes - 1)]) if self._pens else 0
        self._changed_s = np.full(len(trajectory.pen_changes), inf)
        self._changed_s[:first] = -inf
        if self._pens:
            insert(self._pens[first].height_mm)

    def waiting_for(self, wishes: Controls | None, *, tells: bool) -> Callable[[int], bool]:
        """Whether a halt, by its number, still waits for somebody. wishes: None where nobody is asked. tells: as an
        event, to a program."""

        def waiting(halt: int) -> bool:
            if self._changed_s[halt] == inf:
                self._changed_s[halt] = self._clock.now_s()
                self._insert(self._pens[halt + 1].height_mm)
                if wishes is not None:
                    wishes.await_key()
                    pen = self._pens[halt + 1]
                    if tells:
                        tell("insert", pen=pen.name, colour=pen.colour, number=halt + 1)
                    else:
                        print_note(f"insert {pen.name}, then press space")
            return wishes is not None and wishes.is_awaiting()

        return waiting

    def heights_mm(self, times_s: FloatArray) -> FloatArray:
        """(n,) how much further the tip of the pen sticks out that is in the holder at each time."""
        if not self._pens:
            return np.zeros(len(times_s))
        which = np.searchsorted(self._changed_s, times_s, side="right")
        heights: FloatArray = np.array([pen.height_mm for pen in self._pens])[which]
        return heights
