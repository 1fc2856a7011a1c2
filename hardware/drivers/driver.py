"""What plays set points: the simulated arm, or a controller at the end of a line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from hardware.measurements import Measurements
from planner.arrays import FloatArray


class Driver(Protocol):
    """An arm that goes to commanded positions, (n_joints,) in chain order, rad or mm.

    Every method may raise HardwareError.
    """

    ahead_s: float
    """How long before its time a set point has to be sent: 0 for controllers without a queue, which move at once. A
    queue sets the pace of playing, not the host's clock."""

    def open(self) -> None:
        """Open the line, if it is not open yet, without a byte on it."""

    def connect(self, pose: FloatArray) -> None:
        """Open the line, attach the servos one after another, and return when they are at `pose`.

        Hobby servos jump to the pose, so it should be where the arm was parked; servos that measure their position go
        there slowly.
        """

    def send(self, positions: FloatArray, duration_s: float) -> None:
        """Have the joints reach `positions` `duration_s` after they reach those sent before.

        Waits while the controller's queue is full.
        """

    def executed(self) -> int:
        """How many set points sent so far are known to have been reached: the controller has said so, or has answered
        after it had the time to reach them. A set point that is only written to the line does not count."""

    def flush(self) -> None:
        """Return when everything sent is known to have been reached. Errors: HardwareError if the controller does not
        confirm it."""

    def emergency_stop(self) -> None:
        """Stop moving now and hold. Never raises because the arm is stopped already."""

    def close(self) -> None:
        """Hold the last set point and let go of the line. Allowed at any time, and more than once."""

    def statistics(self) -> list[str]:
        """Lines about the link for people: frames, retransmissions, under-runs."""


@runtime_checkable
class Measuring(Driver, Protocol):
    """A driver that can tell where the joints are while it plays."""

    def measure(self) -> None:
        """Do so from now on. Before `connect`."""

    def measured(self) -> Measurements:
        """What was measured so far."""


@dataclass(frozen=True, slots=True)
class Tally:
    """How a controller counts what it does in a run, so that another host can read its count: the run's number, the
    count before the first set point, and how many set points go into one count."""

    run: int
    first: int
    each: int


@runtime_checkable
class Halting(Driver, Protocol):
    """A driver with a queue that can brake before what is in it has been played."""

    def halt(self) -> FloatArray:
        """Brake along the path at once, and forget what was sent and not reached: (n_joints,) where the arm then rests.

        That is at the last set point that was `executed`, or between it and the next. What is sent from now on is
        counted on from there.
        """


@runtime_checkable
class Remembering(Driver, Protocol):
    """A driver whose controller goes on counting when its host is lost, and remembers the count."""

    def tally(self, period_s: float) -> Tally:
        """How the set points of this run, `period_s` apart, are counted; once connected."""

    def recall(self, earlier: Tally | None) -> int | None:
        """How many set points of the run `earlier` were reached, None where the controller remembers another run or
        none, or nothing is asked but whether it is there. Before `connect`, which makes it forget; returns once the arm
        is at rest."""
