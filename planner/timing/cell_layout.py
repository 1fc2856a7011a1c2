"""Where the cells and the unknowns of many paths stand in arrays that hold them all, and sums and minima by path."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.ragged import starts_of, within

PAIRS = np.tril_indices(4)
"""Rows and columns of the entries that the four unknowns of a cell have in a symmetric matrix."""


class CellLayout:
    """Paths laid end to end; the unknowns of a path are b and b' at each of its n_cells + 1 knots in turn.

    first_cell: (n_paths,); path_of_cell: (cells,); path_of_unknown: (n_unknowns,); first_unknown: (cells,) of the four
    that belong to each cell, the last two of which it shares with the next.
    """

    def __init__(self, n_cells: IntArray) -> None:
        n_unknowns = 2 * n_cells + 2
        self.n_cells = n_cells
        self.n_paths = len(n_cells)
        self.n_unknowns = int(n_unknowns.sum())
        self.first_unknown = np.repeat(starts_of(n_unknowns)[:-1], n_cells) + 2 * within(n_cells)
        self.first_cell = starts_of(n_cells)[:-1]
        self.path_of_cell = np.repeat(np.arange(self.n_paths), n_cells)
        self._unknown = (self.first_unknown + np.arange(4)[:, None]).ravel()
        rows, columns = (index[:, None] for index in PAIRS)
        self._entry = ((rows - columns) * self.n_unknowns + self.first_unknown + columns).ravel()
        self.path_of_unknown = np.repeat(np.arange(self.n_paths), n_unknowns)

    def unknowns_of_cells(self, b: FloatArray) -> FloatArray:
        """(4, cells) b and b' at the left end of each cell, then at its right."""
        return np.stack([b[self.first_unknown + k] for k in range(4)])

    def unknowns_of(self, of_cells: FloatArray) -> FloatArray:
        """(n_unknowns,) sums of what cells have of each of their unknowns (4, cells)."""
        return np.bincount(self._unknown, of_cells.ravel(), self.n_unknowns).astype(np.float64, copy=False)

    def band_of(self, entries: FloatArray) -> FloatArray:
        """(4, n_unknowns) the lower band of a matrix, entry (i + k, i) at [k, i], from what cells have of the entries
        of PAIRS (10, cells)."""
        band = np.bincount(self._entry, entries.ravel(), 4 * self.n_unknowns).reshape(4, -1)
        return band.astype(np.float64, copy=False)

    def total(self, per_cell: Iterable[FloatArray]) -> FloatArray:
        """(n_paths,) sums over all that belongs to a path, of arrays (..., cells)."""
        sums: FloatArray = np.add.reduceat(
            sum(part.reshape(-1, part.shape[-1]).sum(axis=0) for part in per_cell), self.first_cell
        )
        return sums

    def smallest(self, per_cell: FloatArray) -> FloatArray:
        """(n_paths,) minima over all that belongs to a path, of an array (..., cells)."""
        minima: FloatArray = np.minimum.reduceat(
            per_cell.reshape(-1, per_cell.shape[-1]).min(axis=0, initial=np.inf), self.first_cell
        )
        return minima

    def steps_until_zero(self, values: Iterable[FloatArray], changes: Iterable[FloatArray]) -> FloatArray:
        """(n_paths,) how many such changes the positive values (..., cells) of each path survive."""
        fastest = np.minimum.reduceat(
            np.minimum.reduce(
                [
                    (change / value).reshape(-1, value.shape[-1]).min(axis=0, initial=0.0)
                    for value, change in zip(values, changes, strict=True)
                ]
            ),
            self.first_cell,
        )
        steps: FloatArray = -1.0 / np.minimum(fastest, -1e-9)
        return steps
