"""How long the order of strokes leaves the way of the lifted pen, beside the best tour that the search of Lin,
Kernighan and Helsgaun finds.

    pip install elkai  # LKH, free for research; the planner does not use it
    python benchmarks/tours.py

Prints the figures that tests/drawing/test_tour_lengths.py holds the planner to. A tour of strokes is a travelling
salesman's in which both ends of a stroke are towns whose road has to be taken, and a town beside the start, from which
every road is free, makes the end free.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import elkai
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from planner.arrays import FloatArray
from planner.drawing.metric import Metric
from planner.drawing.order import order_strokes, travel
from tests.drawing.stroke_sets import METRICS, ORIGIN, STROKE_SETS

_RUNS = 20
_RESOLUTION = 100_000
"""Of the longest way: the search counts in whole numbers."""


def strong_length(strokes: list[FloatArray], metric: Metric) -> float:
    """Length of the best tour found."""
    ends = np.array([ORIGIN, ORIGIN, *(stroke[at] for stroke in strokes for at in (0, -1))])
    vectors = metric.embed(ends)
    apart = metric.distance(vectors[:, None], vectors[None])
    roads = np.rint(apart / apart.max() * _RESOLUTION).astype(np.int64) + _RESOLUTION
    roads[1, :] = roads[:, 1] = _RESOLUTION  # from anywhere back to the town beside the start, for nothing
    for town in range(0, len(ends), 2):
        roads[town, town + 1] = roads[town + 1, town] = 0
    np.fill_diagonal(roads, 0)
    tour = np.array(elkai.DistanceMatrix(roads.tolist()).solve_tsp(runs=_RUNS)[:-1])
    tour = np.roll(tour, -int(np.flatnonzero(tour == 0)[0]))
    if tour[1] == 1:
        tour = np.roll(tour[::-1], 1)
    entered = tour[1:-1:2]
    assert tour[-1] == 1 and (tour[2:-1:2] == entered ^ 1).all()
    found = [strokes[town // 2 - 1][:: -1 if town % 2 else 1] for town in entered.tolist()]
    return travel(found, ORIGIN, metric)


def main() -> None:
    print(f"{'strokes':10s} {'metric':10s} {'planner':>9s} {'strong':>9s}")
    for name, strokes in STROKE_SETS.items():
        for kind, metric in METRICS.items():
            began = time.perf_counter()
            strong = strong_length(strokes, metric)
            planned = travel(order_strokes(strokes, ORIGIN, metric), ORIGIN, metric)
            took_s = time.perf_counter() - began
            print(f"{name:10s} {kind:10s} {planned:9.2f} {strong:9.2f} {planned / strong - 1:+7.2%} {took_s:6.1f} s")


if __name__ == "__main__":
    main()
