"""Smooth paths of many strokes at once: uniform quintic splines, laid end to end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.spline import evaluate, evaluate_at, first_controls, subdivided

DEGREE = 5


@dataclass(frozen=True, eq=False, slots=True)
class SplinePaths:
    """Paths over a parameter sigma that runs from 0 to `n_cells` on each.

    n_cells: (n_paths,) cells of each path; controls: (total cells + 5 n_paths, d) control points.
    """

    n_cells: IntArray
    controls: FloatArray

    def positions(self, fractions: FloatArray, derivative: int = 0) -> FloatArray:
        """(total cells, n_fractions, d) positions, or derivatives by sigma, at fractions of every cell."""
        return evaluate(self.controls, first_controls(self.n_cells, DEGREE), fractions, DEGREE, derivative)

    def at(self, cells: IntArray, fractions: FloatArray, derivative: int = 0) -> FloatArray:
        """(n, d) at one fraction in each of the named cells (counted over all paths)."""
        return evaluate_at(self.controls, first_controls(self.n_cells, DEGREE)[cells], fractions, DEGREE, derivative)

    def subdivided(self) -> Self:
        """The same paths with every cell cut in two, sigma counting the new cells."""
        return type(self)(2 * self.n_cells, subdivided(self.controls, self.n_cells, DEGREE))

    def subset(self, chosen: BoolArray) -> Self:
        """Only the paths of the mask (n_paths,)."""
        return type(self)(self.n_cells[chosen], self.controls[np.repeat(chosen, self.n_cells + DEGREE)])
