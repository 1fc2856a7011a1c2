"""How playing a program ended, and what there is to say of it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from planner.counted import counted


class End(Enum):
    """How playing ended, in a word."""

    PLAYED = "played"
    STOPPED = "stopped"
    EMERGENCY_STOPPED = "emergency stop"


@dataclass(frozen=True, slots=True)
class PlaybackResult:
    """How playing a program went.

    sent: set points of the program sent, of `total`. duration_s: from the first set point to the last, stops and pauses
    included. late_s: how long after its time a set point was handed over, at the median, for 99 of 100, and at worst;
    zeros where a controller's queue sets the pace. stalls: stalls of the host, after each of which the rest was played
    later. pen_height_mm: where the tip was left above the paper; parked: whether that is the park pose. link: what the
    driver says of its line.
    """

    end: End
    sent: int
    total: int
    duration_s: float
    late_s: tuple[float, float, float]
    stalls: int
    pen_height_mm: float
    parked: bool
    link: tuple[str, ...]

    @property
    def complete(self) -> bool:
        return self.end is End.PLAYED

    def lines(self) -> list[str]:
        """The same in words."""
        rests = f"the pen rests {round(self.pen_height_mm, 2) + 0.0:.2f} mm above the paper"
        where = "the arm is parked" if self.parked else "the arm holds where it is"
        words = [
            f"{self.end.value} after {self.sent} of {counted(self.total, 'set point')} and "
            f"{self.duration_s:.2f} s; {rests}, {where}"
        ]
        if any(self.late_s):
            median, most, worst = (late_s * 1e3 for late_s in self.late_s)
            words.append(
                f"set points were late by {median:.2f} ms (median), {most:.2f} ms (99 of 100) and "
                f"{worst:.2f} ms (worst)"
            )
        if self.stalls:
            words.append(f"playing stalled {self.stalls} time(s) and went on later")
        return [*words, *self.link]
