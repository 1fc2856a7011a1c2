"""What plays set points: the simulated arm, or a controller at the end of a line."""

from __future__ import annotations

from typing import Protocol

from planner.arrays import FloatArray


class Driver(Protocol):
    """An arm that goes where it is told. Positions are (n_joints,) in chain order, rad or mm.

    Every method may raise HardwareError.
    """

    def connect(self, start: FloatArray) -> None:
        """Open the line and stand still at `start`, pen up, ready for set points."""

    def send(self, positions: FloatArray) -> None:
        """The joints are to be at `positions` now."""

    def close(self) -> None:
        """Hold the last set point and let go of the line. Allowed at any time, and more than once."""
