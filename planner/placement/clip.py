"""Cutting strokes down to the part of the paper that the arm reaches."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.polyline_length import polyline_length

_STEP_MM = 0.25


def clip_strokes(
    strokes: Sequence[FloatArray], reachable: Callable[[FloatArray], BoolArray], reach_mm: float
) -> tuple[list[FloatArray], float, int]:
    """The reachable runs of strokes (n, 2), the length left out in mm, and the strokes and taps left out whole.

    reachable: points (n, 2) to (n,); none further than `reach_mm` from the base along either axis is. Strokes are
    probed every quarter of a millimetre, where they come as near as that.
    """
    kept: list[FloatArray] = []
    lost_mm, lost_whole = 0.0, 0
    for stroke in strokes:
        points = densified(_cut_at_border(stroke, reach_mm), reach_mm)
        inside = reachable(points)
        if inside.all():
            kept.append(stroke)
            continue
        runs = [run for run in _true_runs(points, inside) if len(run) > 1]
        lost_whole += not runs
        lost_mm += polyline_length(points) - sum(map(polyline_length, runs))
        kept.extend(runs)
    return kept, lost_mm, lost_whole


def densified(stroke: FloatArray, reach_mm: float = np.inf) -> FloatArray:
    """The stroke's own points with more between them, so that none is further than a step from the next: but for lines
    whose middle is further than `reach_mm` from the base along an axis, which stay as they are."""
    if len(stroke) == 1:
        return stroke
    steps = np.hypot(*np.diff(stroke, axis=0).T)
    steps[(np.abs(stroke[:-1] + stroke[1:]) > 2.0 * reach_mm).any(axis=1)] = 0.0
    counts = np.maximum(np.ceil(steps / _STEP_MM).astype(np.int64), 1)
    index = np.repeat(np.arange(len(steps)), counts)
    fraction = (np.arange(len(index)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[index]
    between = stroke[index] + fraction[:, None] * (stroke[index + 1] - stroke[index])
    return np.concatenate((between, stroke[-1:]))


def _cut_at_border(stroke: FloatArray, reach_mm: float) -> FloatArray:
    """The stroke with a point where it crosses the border of the square of `reach_mm` around the base, so that a line
    that comes from miles away need not be probed all along (Liang and Barsky, 1984)."""
    begins, steps = stroke[:-1], np.diff(stroke, axis=0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # steps may be next to nothing
        crossings = np.stack([(side * reach_mm - begins) / steps for side in (-1.0, 1.0)])
    enters = np.nan_to_num(crossings.min(axis=0), nan=-np.inf).max(axis=1, initial=0.0)
    leaves = np.nan_to_num(crossings.max(axis=0), nan=np.inf).min(axis=1, initial=1.0)
    passes = enters < leaves
    lines = np.concatenate([np.flatnonzero(passes & (enters > 0.0)), np.flatnonzero(passes & (leaves < 1.0))])
    share = np.concatenate([enters[passes & (enters > 0.0)], leaves[passes & (leaves < 1.0)]])
    in_order = np.lexsort((share, lines))
    lines, share = lines[in_order], share[in_order]
    return np.insert(stroke, lines + 1, begins[lines] + share[:, None] * steps[lines], axis=0)


def _true_runs(points: FloatArray, inside: BoolArray) -> list[FloatArray]:
    edges = np.flatnonzero(np.diff(np.concatenate(([0], inside.astype(np.int8), [0]))))
    return [points[first:last] for first, last in zip(edges[0::2], edges[1::2], strict=True)]
