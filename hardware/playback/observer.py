"""What a player tells while it plays, to whoever listens: a display, a journal."""

from __future__ import annotations

from dataclasses import dataclass

from planner.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Progress:
    """`reached` of `total` set points of the program have been reached, as far as the controller tells.

    stroke: the one being drawn there, or TRAVELLING. left_s: time until the end, without pauses.
    """

    reached: int
    total: int
    stroke: int
    left_s: float
    paused: bool


class Observer:
    """Every method is called from the loop that plays, so it has to be quick. Here they do nothing."""

    def connected(self) -> None:
        """The arm is ready to play."""

    def planned(self, first: int, samples: FloatArray) -> None:
        """Set points from number `first` on, counted from 1, will be at these `samples` (n,) of the trajectory,
        whatever was planned before for them. They have not been sent yet."""

    def sent(self, stroke: int) -> None:
        """All of stroke `stroke` has been sent."""

    def finished(self, stroke: int) -> None:
        """Stroke `stroke` is known to be drawn."""

    def reached(self, executed: int, sent: int) -> None:
        """So many set points are known to have been reached, of so many sent."""

    def progressed(self, progress: Progress) -> None:
        """Another set point has been sent."""
