"""Which spot of ink is which mark.

An arm that was never calibrated draws its marks several millimetres off, but not at random: by the sum of a few modes,
ways in which all marks move together. Their amounts are found together with the assignment: expectation maximisation
with the scatter beside them shrinking (as in coherent point drift; Myronenko and Song, "Point set registration", 2010),
from many shifts to begin with; then the best assignment one to one. The likeliest is taken, misses and amounts counted.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import cdist

from planner.arrays import BoolArray, FloatArray, IntArray

_SCATTERS_MM = (6.0, 5.0, 4.0, 3.2, 2.6, 2.1, 1.8, 1.5, 1.2, 1.2)
_SCATTER_MM = 1.2  # beside the modes: slack, and configurations that differ
_GATE_MM = 4.0
_MISS = _GATE_MM**2 / (2 * _SCATTER_MM**2)
_NO_DOT = np.exp(-_MISS)
_WARP_SD_MM = np.array([4.0, 2.0, 2.0, 1.0, 1.0, 1.0])  # shift, linear and quadratic, over half the extent
_SHIFTS_MM = np.array([(x, y) for x in range(-9, 10, 3) for y in range(-9, 10, 3) if np.hypot(x, y) < 9.5])


def smooth_modes(meant_mm: FloatArray) -> FloatArray:
    """(12, n, 2): how far each mark is moved by one standard deviation of each mode, if nothing is known of the arm:
    shifts, and linear and quadratic warps of the sheet."""
    low, high = meant_mm.min(axis=0), meant_mm.max(axis=0)
    x, y = ((meant_mm - (low + high) / 2) / max(float((high - low).max()) / 2, 1.0)).T
    warps = _WARP_SD_MM[:, None] * np.stack((np.ones_like(x), x, y, x * x, x * y, y * y))
    nil = np.zeros_like(warps)
    modes: FloatArray = np.concatenate((np.stack((warps, nil), axis=-1), np.stack((nil, warps), axis=-1)))
    return modes


def assign(meant_mm: FloatArray, places_mm: FloatArray, may_be: BoolArray, modes_mm: FloatArray) -> IntArray:
    """(n,): index of the spot that each of n marks is, -1 where there is none.

    meant (n, 2), places (m, 2): of marks and of spots. may_be (n, m): whether a mark can be a spot.
    modes (k, n, 2): how far marks are moved by one standard deviation of each.
    """
    if not may_be.any():
        return np.full(len(meant_mm), -1)
    by_amount = modes_mm.reshape(len(modes_mm), -1).T
    found = [_assigned(meant_mm, places_mm, may_be, by_amount, shift) for shift in _SHIFTS_MM]
    return min(found, key=lambda each: each[1])[0]


def _assigned(
    meant: FloatArray, places: FloatArray, may_be: BoolArray, by_amount: FloatArray, shift: FloatArray
) -> tuple[IntArray, float]:
    """The assignment that is found from a shift to begin with, and its negative log likelihood. by_amount: (2 n, k)."""
    moved, amounts = meant + shift, np.zeros(by_amount.shape[1])
    for scatter in _SCATTERS_MM:
        likely = np.where(may_be, np.exp(-cdist(moved, places, "sqeuclidean") / (2 * scatter**2)), 0.0)
        share = likely / (_NO_DOT + np.maximum(likely.sum(axis=0), likely.sum(axis=1)[:, None]))
        weight = share.sum(axis=1)
        pull = (share @ places - weight[:, None] * meant).ravel()
        normal = by_amount.T @ (np.repeat(weight, 2)[:, None] * by_amount) + scatter**2 * np.eye(len(amounts))
        amounts = np.linalg.solve(normal, by_amount.T @ pull)
        moved = meant + (by_amount @ amounts).reshape(-1, 2)
    cost = np.where(may_be, np.minimum(cdist(moved, places, "sqeuclidean") / (2 * _SCATTER_MM**2), _MISS), _MISS)
    marks, chosen = linear_sum_assignment(cost)
    told = cost[marks, chosen] < _MISS
    assignment = np.full(len(meant), -1)
    assignment[marks[told]] = chosen[told]
    energy = cost[marks[told], chosen[told]].sum() + _MISS * (len(meant) - told.sum()) + 0.5 * np.square(amounts).sum()
    return assignment, float(energy)
