"""The best tour that the search of Lin, Kernighan and Helsgaun finds (LKH 3, by the package `elkai`).

A tour of strokes is a travelling salesman's in which both ends of a stroke are towns whose road has to be taken, and
two towns more stand for where the pen comes from and where it may stay.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray, IntArray

_RESOLUTION = 100_000
"""Of the longest way: the search counts in whole numbers."""


def tour(roads: FloatArray, runs: int) -> IntArray:
    """(n,) the towns at which strokes are entered, in their order: stroke k lies between the towns 2 k + 2 and 2 k + 3.

    roads: (2 n + 2, 2 n + 2) costs, the same both ways; town 0 is where the tour begins, town 1 where it ends.
    """
    import elkai

    whole = np.rint(roads / roads.max() * _RESOLUTION).astype(np.int64) + _RESOLUTION
    for town in range(0, len(whole), 2):
        whole[town, town + 1] = whole[town + 1, town] = 0
    np.fill_diagonal(whole, 0)
    found = np.array(elkai.DistanceMatrix(whole.tolist()).solve_tsp(runs=runs)[:-1])
    found = np.roll(found, -int(np.flatnonzero(found == 0)[0]))
    if found[1] == 1:
        found = np.roll(found[::-1], 1)
    entered: IntArray = found[1:-1:2]
    assert found[-1] == 1 and (found[2:-1:2] == entered ^ 1).all()
    return entered
