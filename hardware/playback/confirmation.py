"""What of a program is known to be reached, from how many set points the driver knows to be reached."""

from __future__ import annotations

from collections import deque

import numpy as np

from planner.arrays import IntArray
from planner.trajectory import TRAVELLING


class Confirmation:
    """Set points of the program and strokes wait here, in order, until they are confirmed.

    A run sends other set points too, for pauses and ramps: set points of the program are counted by `index`, all that
    were sent by `sent`. index: the last set point of the program known to be reached, 0 before the first.
    """

    def __init__(self, stroke: IntArray) -> None:
        """stroke: (n,) labels of the program's set points."""
        ends = np.flatnonzero((stroke != TRAVELLING) & (stroke != np.append(stroke[1:], TRAVELLING)))
        self._to_send = deque(zip(ends.tolist(), stroke[ends].tolist(), strict=True))  # (last index, stroke)
        self._strokes: deque[tuple[int, int]] = deque()  # (sent, stroke)
        self._indices: deque[tuple[int, int]] = deque()  # (sent, index)
        self.index = 0

    def add(self, sent: int, index: int) -> list[int]:
        """Set point `index`, or one in its place, is the last of `sent`; the strokes that are complete with it."""
        strokes = []
        while self._to_send and self._to_send[0][0] <= index:
            strokes.append(self._to_send.popleft()[1])
        self._strokes.extend((sent, stroke) for stroke in strokes)
        self._indices.append((sent, index))
        return strokes

    def cut_short(self, executed: int) -> None:
        """What was sent after so many is not going to be reached."""
        for sent in (self._indices, self._strokes):
            while sent and sent[-1][0] > executed:
                sent.pop()

    def confirm(self, executed: int) -> list[int]:
        """So many of those sent are known to be reached; the strokes that are finished with that."""
        while self._indices and self._indices[0][0] <= executed:
            self.index = self._indices.popleft()[1]
        strokes = []
        while self._strokes and self._strokes[0][0] <= executed:
            strokes.append(self._strokes.popleft()[1])
        return strokes
