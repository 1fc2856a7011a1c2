"""A square grid over the paper, and how a field of configurations goes on over its nodes.

A field is an array (..., n_nodes, n_independent) with flags (..., n_nodes) that tell where it is known.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray

_OFFSETS = ((1, 0), (-1, 0), (0, 1), (0, -1))


@dataclass(frozen=True, eq=False)
class PaperGrid:
    """Nodes at `origin_mm` (2,) and every `spacing_mm` from there, `shape` of them along x and y; node (i, j) is number
    `i * shape[1] + j`."""

    origin_mm: FloatArray
    spacing_mm: float
    shape: tuple[int, int]

    @property
    def n_nodes(self) -> int:
        return self.shape[0] * self.shape[1]

    @cached_property
    def tips_mm(self) -> FloatArray:
        """(n_nodes, 3) the nodes, on the paper."""
        x, y = np.meshgrid(*(np.arange(count) * self.spacing_mm for count in self.shape), indexing="ij")
        return np.column_stack((x.ravel() + self.origin_mm[0], y.ravel() + self.origin_mm[1], np.zeros(x.size)))

    @cached_property
    def neighbours(self) -> IntArray:
        """(4, n_nodes) numbers of the nodes beside each; `n_nodes`, which is none, beyond the edge."""
        i, j = np.divmod(np.arange(self.n_nodes), self.shape[1])
        beside = []
        for along, across in _OFFSETS:
            inside = (i + along >= 0) & (i + along < self.shape[0]) & (j + across >= 0) & (j + across < self.shape[1])
            beside.append(np.where(inside, (i + along) * self.shape[1] + j + across, self.n_nodes))
        return np.array(beside)

    def amid(self, known: BoolArray) -> BoolArray:
        """(..., n_nodes) which of the nodes that are known have only such around them, corners included."""
        wide = np.pad(known.reshape(*known.shape[:-1], *self.shape), [(0, 0)] * (known.ndim - 1) + [(1, 1)] * 2)
        columns, rows = self.shape
        around = [wide[..., i : i + columns, j : j + rows] for i in range(3) for j in range(3)]
        inner: BoolArray = np.all(around, axis=0).reshape(known.shape)
        return inner

    def nearest(self, points_mm: FloatArray) -> IntArray:
        """(n,) numbers of the nodes nearest to points (n, 2) or more columns."""
        at = np.rint((points_mm[:, :2] - self.origin_mm) / self.spacing_mm).astype(np.int64)
        i, j = np.clip(at, 0, np.array(self.shape) - 1).T
        numbers: IntArray = i * self.shape[1] + j
        return numbers

    def carried_on(
        self, field: FloatArray, known: BoolArray, rows: IntArray, nodes: IntArray
    ) -> tuple[FloatArray, FloatArray, BoolArray]:
        """What a field (k, n_nodes, n) suggests for nodes (m,) of its rows (m,): the mean of the straight lines on from
        the neighbours that are known, (m, n); these neighbours themselves, (4, m, n), and which of them are known,
        (4, m)."""
        beside = self.neighbours[:, nodes]
        beyond = np.take_along_axis(_with_none(self.neighbours), beside, axis=1)
        padded, flags = np.pad(field, ((0, 0), (0, 1), (0, 0))), np.pad(known, ((0, 0), (0, 1)))
        near, near_known = padded[rows, beside], flags[rows, beside]
        far_known = near_known & flags[rows, beyond]
        lines = near + np.where(far_known[..., None], near - padded[rows, beyond], 0.0)
        counted = np.where(far_known.any(axis=0), far_known, near_known)  # no line, where there is none: the value
        mean: FloatArray = (lines * counted[..., None]).sum(axis=0) / np.maximum(counted.sum(axis=0), 1)[:, None]
        return mean, near, near_known

    def filled(self, field: FloatArray, known: BoolArray) -> FloatArray:
        """The field (n_nodes, n) carried on from the nodes where it is known, some at least, to all others."""
        whole, known = field[None].copy(), known[None].copy()
        while not known.all():
            reached = np.pad(known, ((0, 0), (0, 1)))[0, self.neighbours].any(axis=0) & ~known[0]
            nodes = np.flatnonzero(reached)
            rows = np.zeros(len(nodes), dtype=np.int64)
            mean, near, near_known = self.carried_on(whole, known, rows, nodes)
            # On a straight line for a node or two, which is as far as it matters; further out that would run away.
            level = (near * near_known[..., None]).sum(axis=0) / near_known.sum(axis=0)[:, None]
            whole[0, nodes] = 0.5 * (mean + level)
            known[0, nodes] = True
        filled: FloatArray = whole[0]
        return filled


def _with_none(neighbours: IntArray) -> IntArray:
    """With a last column for the node that is none, whose neighbours are none."""
    return np.pad(neighbours, ((0, 0), (0, 1)), constant_values=neighbours.shape[1])
