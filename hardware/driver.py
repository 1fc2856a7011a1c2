"""What plays set points: the simulated arm, or a controller at the end of a line."""

from __future__ import annotations

from typing import Protocol

from planner.arrays import FloatArray


class Driver(Protocol):
    """An arm that goes where it is told. Positions are (n_joints,) in chain order, rad or mm.

    Every method may raise HardwareError.
    """

    ahead_s: float
    """How long before its time a set point has to be handed over: 0 for controllers without a queue, which move at
    once. Where there is a queue, playing is paced by it, not by the host's clock."""

    def connect(self, pose: FloatArray) -> None:
        """Open the line, attach the servos one after another at `pose` and stand there.

        Hobby servos leap to the pose, so it should be where the arm was parked; servos that tell where they are go
        there slowly.
        """

    def send(self, positions: FloatArray, duration_s: float) -> None:
        """The joints are to reach `positions` `duration_s` after they reached those sent before.

        Waits while the controller's queue is full.
        """

    def executed(self) -> int:
        """How many set points sent so far are known to have been reached: the controller has said so, or has answered
        after it had the time to reach them. What a line has taken is not known to have been reached."""

    def flush(self) -> None:
        """Return when everything sent is known to have been reached. Errors: HardwareError where that is not heard."""

    def emergency_stop(self) -> None:
        """Stop moving now and hold. Never raises because the arm is stopped already."""

    def close(self) -> None:
        """Hold the last set point and let go of the line. Allowed at any time, and more than once."""

    def statistics(self) -> list[str]:
        """Lines about the link for people: frames, retransmissions, under-runs, lateness."""
