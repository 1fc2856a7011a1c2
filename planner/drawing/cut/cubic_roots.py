"""Roots of cubic polynomials, many at once."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray, IntArray

_MOST_STEPS, _SAME = 80, 1e-15


def sign_changes(power: FloatArray, start: FloatArray, end: FloatArray) -> tuple[IntArray, FloatArray]:
    """Where polynomials p0 + p1 t + p2 t^2 + p3 t^3, `power` (4, n), change their sign between start and end (n,):
    which of the n each place belongs to, and t.

    The extrema cut the interval into at most three in which a polynomial only rises or only falls. A root in one of
    these is found by Newton's method, kept in its bracket.
    """
    borders = np.sort(np.stack((start, *_extrema(power, start, end), end)), axis=0)
    low, high = borders[:-1], borders[1:]
    has_root = (_value(power, low) > 0.0) != (_value(power, high) > 0.0)
    which = np.broadcast_to(np.arange(power.shape[1]), low.shape)[has_root]
    return which, _root(power[:, which], low[has_root], high[has_root])


def _extrema(power: FloatArray, start: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The parameters (n,) where a polynomial turns, within start and end; either of these where it does not."""
    _, c, half_b, a = power[0], power[1], power[2], 3.0 * power[3]
    root = np.sqrt(np.maximum(half_b * half_b - a * c, 0.0))
    q = -(half_b + np.copysign(root, half_b))  # the form that survives a -> 0
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        first, second = np.nan_to_num(q / a), np.nan_to_num(c / q)
    return np.clip(first, start, end), np.clip(second, start, end)


def _value(power: FloatArray, t: FloatArray) -> FloatArray:
    value: FloatArray = power[0] + t * (power[1] + t * (power[2] + t * power[3]))
    return value


def _root(power: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Where monotone polynomials (4, m) change their sign between low and high (m,)."""
    rises = _value(power, high) > 0.0
    t = 0.5 * (low + high)
    for _ in range(_MOST_STEPS):
        value = _value(power, t)
        is_beyond = (value > 0.0) == rises
        high, low = np.where(is_beyond, t, high), np.where(is_beyond, low, t)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            newton = t - value / (power[1] + t * (2.0 * power[2] + 3.0 * t * power[3]))
        is_within = (newton >= low) & (newton <= high)
        following = np.where(is_within, newton, 0.5 * (low + high))
        if np.all(np.abs(following - t) <= _SAME):
            return following
        t = following
    return t
