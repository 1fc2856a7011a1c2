"""Polylines with their corners rounded, so that a pen need not stop at them."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray

_ROUND = 2.0
"""A corner that is cut so far from it on both sides is off by half of that at most."""


def rounded(points: FloatArray, within_mm: float = np.inf) -> FloatArray:
    """(n, 4, 2) cubics along a polyline (n, 2), n > 1, closed where it ends as it begins: from each corner, an arc of a
    parabola no further from it than `within_mm`; between them, straight lines. Without a bound, the arcs meet in the
    middle of the edges, as those of a quadratic B-spline."""
    is_closed = len(points) > 3 and bool(np.all(points[0] == points[-1]))
    edges = np.diff(points, axis=0)
    lengths: FloatArray = np.linalg.norm(edges, axis=1)
    reach = np.minimum(lengths / 2.0, _ROUND * within_mm)[:, None]
    heading = edges / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    # What is left of each edge between the arcs at its ends.
    begin, end = points[:-1] + reach * heading, points[1:] - reach * heading
    if not is_closed:
        begin[0], end[-1] = points[0], points[-1]
    corner = points[1:] if is_closed else points[1:-1]
    to = np.roll(begin, -1, axis=0) if is_closed else begin[1:]
    start = end if is_closed else end[:-1]
    arcs = np.stack((start, start + (corner - start) * 2.0 / 3.0, to + (corner - to) * 2.0 / 3.0, to), axis=1)
    lines = np.stack((begin, begin + (end - begin) / 3.0, end - (end - begin) / 3.0, end), axis=1)
    curves = np.empty((len(lines) + len(arcs), 4, 2))
    curves[0::2], curves[1::2] = lines, arcs
    has_length = np.any(curves != curves[:, :1], axis=(1, 2))
    kept: FloatArray = curves[has_length] if has_length.any() else curves[:1]
    return kept
