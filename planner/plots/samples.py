"""From a trajectory's samples to what a picture shows of them: derivatives, envelopes, pen-down spans.

All are linear in the number of samples.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray


def finite_difference(positions: FloatArray, rate_hz: float, order: int) -> tuple[FloatArray, FloatArray]:
    """The derivative of that order from (n_samples, n_joints) positions: times in s, (n_samples + order,),
    and values in the positions' unit per s^order, (n_samples + order, n_joints).

    A plain difference of order k is a mean of the k-th derivative over k sample intervals, so it never
    shows a limit broken that the motion keeps. Its place is the middle of those intervals. A trajectory
    begins and ends at rest: the arm is taken to stand still before and after, and so one that starts or
    stops with a jerk shows it.
    """
    standing = np.pad(positions, ((order, order), (0, 0)), mode="edge")
    values: FloatArray = np.diff(standing, n=order, axis=0) * rate_hz**order
    times_s: FloatArray = (np.arange(len(values), dtype=np.float64) - order / 2) / rate_hz
    return times_s, values


def min_max_envelope(times_s: FloatArray, values: FloatArray, n_bins: int) -> tuple[FloatArray, FloatArray]:
    """At most 2 n_bins + 2 of the samples (n,): the least and the greatest in each of n_bins spans of
    time, and the first and last, in order. Drawn as a line no wider than n_bins pixels it looks like
    the whole, peaks of a single sample included. A short series comes back as it is.
    """
    n = len(values)
    if n <= 2 * n_bins + 2:
        return times_s, values
    size = -(-n // n_bins)
    starts = np.arange(0, n, size)
    spans = np.pad(values, (0, len(starts) * size - n), mode="edge").reshape(-1, size)
    # The last span is filled up with the last sample, which is kept in any case.
    extremes = np.concatenate((starts + spans.argmin(axis=1), starts + spans.argmax(axis=1)))
    kept = np.unique(np.concatenate(([0, n - 1], np.minimum(extremes, n - 1))))
    return times_s[kept], values[kept]


def pen_down_spans(pen: BoolArray, rate_hz: float, n_spans: int) -> FloatArray:
    """(k, 3) rows of start (s), end (s) and the share of that time (0 to 1) the pen is down.

    Each sample stands for the sample interval around it. Where the pen comes down more than n_spans
    times, the duration is cut into n_spans equal parts instead, each with its own share.
    """
    padded = np.concatenate(([False], pen, [False]))
    edges = np.flatnonzero(padded[1:] != padded[:-1]).reshape(-1, 2)
    if len(edges) <= n_spans:
        spans = np.column_stack(((edges - 0.5) / rate_hz, np.ones(len(edges))))
    else:
        cuts = np.linspace(0, len(pen), n_spans + 1).astype(np.int64)
        share = np.add.reduceat(pen.astype(np.float64), cuts[:-1]) / np.diff(cuts)
        spans = np.column_stack(((cuts[:-1] - 0.5) / rate_hz, (cuts[1:] - 0.5) / rate_hz, share))[share > 0]
    return spans
