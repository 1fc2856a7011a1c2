"""What a calibration leaves unknown of an arm."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Accuracy:
    """Standard deviations that a calibration leaves.

    marks: how many it rests on. tip_mm: of the tip's place along each axis of the paper, at rest anywhere on it;
    height_mm: of its height. slack: of each joint's slack, rad or mm.
    """

    marks: int
    tip_mm: float
    height_mm: float
    slack: tuple[float, ...]
