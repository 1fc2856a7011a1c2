"""Cutting strokes down to the part of the paper that the arm reaches."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from planner.arrays import BoolArray, FloatArray

_STEP_MM = 0.25


def clip_strokes(strokes: Sequence[FloatArray], reachable: Callable[[FloatArray], BoolArray]
                 ) -> tuple[list[FloatArray], float, int]:
    """The reachable runs of strokes (n, 2), the length left out in mm, and the strokes and taps left out whole.

    reachable: points (n, 2) to (n,). Strokes are probed every quarter of a millimetre.
    """
    kept: list[FloatArray] = []
    lost_mm, lost_whole = 0.0, 0
    for stroke in strokes:
        points = densified(stroke)
        inside = reachable(points)
        if inside.all():
            kept.append(stroke)
            continue
        runs = [run for run in _true_runs(points, inside) if len(run) > 1]
        lost_whole += not runs
        lost_mm += _length(points) - sum(map(_length, runs))
        kept.extend(runs)
    return kept, lost_mm, lost_whole


def densified(stroke: FloatArray) -> FloatArray:
    """The stroke's own points with more between them, so that none is further than a step from the next."""
    if len(stroke) == 1:
        return stroke
    steps = np.hypot(*np.diff(stroke, axis=0).T)
    counts = np.maximum(np.ceil(steps / _STEP_MM).astype(np.int64), 1)
    index = np.repeat(np.arange(len(steps)), counts)
    fraction = (np.arange(len(index)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[index]
    between = stroke[index] + fraction[:, None] * (stroke[index + 1] - stroke[index])
    return np.concatenate((between, stroke[-1:]))


def _true_runs(points: FloatArray, inside: BoolArray) -> list[FloatArray]:
    edges = np.flatnonzero(np.diff(np.concatenate(([0], inside.astype(np.int8), [0]))))
    return [points[first:last] for first, last in zip(edges[0::2], edges[1::2], strict=True)]


def _length(points: FloatArray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum()) if len(points) > 1 else 0.0
