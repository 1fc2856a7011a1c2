"""Where cubics cross straight edges: all roots, each found on the cubic itself."""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.drawing.cubics import at

_MOST_STEPS, _SAME = 80, 1e-15


def crossings(
    control: FloatArray, start: FloatArray, end: FloatArray, edges: FloatArray, reach: float
) -> tuple[IntArray, FloatArray]:
    """The crossings of cubics (n, 4, 2), between parameters start and end (n,), with edges (n, 2, 2): which of the n
    pairs each belongs to, and its parameter on the cubic. An edge counts as longer by `reach` at both ends.

    The distance of a cubic from an edge's line is a cubic polynomial; its extrema cut the interval into at most three
    where it only rises or only falls, and a root in one of these is found by Newton's method, kept in the bracket.
    """
    along = edges[:, 1] - edges[:, 0]
    length = np.hypot(*along.T)
    offsets = control - edges[:, np.newaxis, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        direction = np.nan_to_num(along / length[:, np.newaxis])
    f = offsets[..., 1] * direction[:, :1] - offsets[..., 0] * direction[:, 1:]
    power = np.stack(  # f(t) = p0 + p1 t + p2 t^2 + p3 t^3
        (
            f[:, 0],
            3.0 * (f[:, 1] - f[:, 0]),
            3.0 * (f[:, 2] - 2.0 * f[:, 1] + f[:, 0]),
            f[:, 3] - f[:, 0] + 3.0 * (f[:, 1] - f[:, 2]),
        )
    )
    borders = np.sort(np.stack((start, *_extrema(power, start, end), end)), axis=0)
    low, high = borders[:-1], borders[1:]
    pair = np.broadcast_to(np.arange(len(control)), low.shape)
    has_root = (_value(power, low) > 0.0) != (_value(power, high) > 0.0)
    pair = pair[has_root]
    t = _root(power[:, pair], low[has_root], high[has_root])
    place = np.sum(at(offsets[pair], t[:, np.newaxis]) * direction[pair], axis=1)
    is_on_edge: BoolArray = (place >= -reach) & (place <= length[pair] + reach)
    return pair[is_on_edge], t[is_on_edge]


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
