"""One array for each family of limits: slacks, their multipliers, and what is computed of the two."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from planner.arrays import BoolArray, FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class PerLimit:
    """Joint acceleration and jerk are limited above and below, so each has two families.

    rate: (5, cells) at the points of each cell, of the velocity limits of all joints and of the pen;
    acceleration_above, acceleration_below: (2, n joints that can reach that limit, cells) at the left end and the
    middle; jerk_above, jerk_below: (5, n_joints, cells) at the points.
    """

    rate: FloatArray
    acceleration_above: FloatArray
    acceleration_below: FloatArray
    jerk_above: FloatArray
    jerk_below: FloatArray

    def __iter__(self) -> Iterator[FloatArray]:
        yield self.rate
        yield self.acceleration_above
        yield self.acceleration_below
        yield self.jerk_above
        yield self.jerk_below

    def of_cells(self, cells: BoolArray) -> PerLimit:
        """Only the cells of the mask (cells,)."""
        return PerLimit(*(family[..., cells] for family in self))


def per_limit(function: Callable[..., FloatArray], *arguments: PerLimit) -> PerLimit:
    """The function of the arrays of each family."""
    return PerLimit(*map(function, *arguments))
