"""From a trajectory's samples to what a picture shows of them: derivatives, envelopes, spans, a window of time.

All are linear in the number of samples.
"""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.errors import UsageError
from planner.trajectory import Trajectory


def require_joints(trajectory: Trajectory, arm: Arm) -> None:
    """Errors: UsageError where the trajectory's joints are not the arm's."""
    if trajectory.columns != arm.column_names:
        raise UsageError(
            f"the trajectory moves {', '.join(trajectory.columns)}, but arm '{arm.name}' has "
            f"{', '.join(arm.column_names)}; it was planned for arm '{trajectory.arm}'"
        )


def window_s(trajectory: Trajectory, from_s: float | None, to_s: float | None) -> tuple[float, float]:
    """The part of the trajectory's time between two times, each open where None.

    Errors: UsageError where no two samples are in it.
    """
    begin_s, end_s = max(from_s or 0.0, 0.0), trajectory.duration_s
    if to_s is not None:
        end_s = min(to_s, end_s)
    if trajectory.n_samples > 1 and end_s - begin_s < 1 / trajectory.rate_hz:
        raise UsageError(
            f"there is nothing to show from {begin_s:g} to {end_s if to_s is None else to_s:g} s: "
            f"the trajectory lasts {trajectory.duration_s:.4g} s, a sample "
            f"{1 / trajectory.rate_hz:g} s"
        )
    return begin_s, end_s


def joined_while_drawing(trajectory: Trajectory) -> BoolArray:
    """(n_samples - 1,) whether the pen draws a line from each sample to the next."""
    pen, stroke = trajectory.pen, trajectory.stroke
    joined: BoolArray = pen[:-1] & pen[1:] & (stroke[:-1] == stroke[1:])
    return joined


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
    """`spans_where` of the samples (n,) at which the pen is down; each stands for the sample interval around it."""
    spans: FloatArray = spans_where(pen, rate_hz, n_spans) - np.array([0.5, 0.5, 0.0]) / rate_hz
    return spans


def spans_where(flags: BoolArray, rate_hz: float, n_spans: int) -> FloatArray:
    """(k, 3) rows of start (s), end (s) and the share of that time (0 to 1) that the flags (n,) of consecutive
    sample intervals are set, the first of which begins at time 0.

    Where they are set more than n_spans times, the duration is cut into n_spans equal parts instead, each
    with its own share.
    """
    padded = np.concatenate(([False], flags, [False]))
    edges = np.flatnonzero(padded[1:] != padded[:-1]).reshape(-1, 2)
    if len(edges) <= n_spans:
        return np.column_stack((edges / rate_hz, np.ones(len(edges))))
    cuts = np.linspace(0, len(flags), n_spans + 1).astype(np.int64)
    share = np.add.reduceat(flags.astype(np.float64), cuts[:-1]) / np.diff(cuts)
    spans: FloatArray = np.column_stack((cuts[:-1] / rate_hz, cuts[1:] / rate_hz, share))[share > 0]
    return spans
