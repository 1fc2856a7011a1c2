"""How long the order of strokes leaves the way of the lifted pen, beside the best tour that the search of Lin,
Kernighan and Helsgaun finds.

    python benchmarks/tours.py

Prints the figures that tests/drawing/test_tour_lengths.py holds the planner to.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks.targets import lkh
from planner.arrays import FloatArray
from planner.drawing.metric import Metric
from planner.drawing.order import order_strokes, travel
from tests.drawing.stroke_sets import METRICS, ORIGIN, STROKE_SETS

_RUNS = 20


def strong_length(strokes: list[FloatArray], metric: Metric) -> float:
    """Length of the best tour found."""
    ends = np.array([ORIGIN, ORIGIN, *(stroke[at] for stroke in strokes for at in (0, -1))])
    vectors = metric.embed(ends)
    apart = metric.distance(vectors[:, None], vectors[None])
    apart[1, :] = apart[:, 1] = 0.0  # from anywhere back to the town beside the start, for nothing
    entered = lkh.tour(apart, _RUNS)
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
