"""Cubic Bezier curves: points of them, parts of them, and chords for them."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray, IntArray


def at(control: FloatArray, t: FloatArray) -> FloatArray:
    """Points (n, 2) of cubics (n, 4, 2) at parameters (n, 1), or (n, 2) for each coordinate its own."""
    s = 1.0 - t
    point: FloatArray = (
        s * s * s * control[:, 0]
        + 3.0 * s * s * t * control[:, 1]
        + 3.0 * s * t * t * control[:, 2]
        + t * t * t * control[:, 3]
    )
    return point


def velocity(control: FloatArray, t: FloatArray) -> FloatArray:
    """The derivatives (..., 2) of cubics (..., 4, 2) at parameters (..., 1)."""
    d0, d1, d2 = np.moveaxis(np.diff(control, axis=-2), -2, 0)
    s = 1.0 - t
    slope: FloatArray = 3.0 * (s * s * d0 + 2.0 * s * t * d1 + t * t * d2)
    return slope


def part(control: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """The parts (n, 4, 2) of cubics (n, 4, 2) between parameters (n,): the ends on the curve, the handles along its
    velocity there. A part that is the whole of its curve is the curve itself."""
    start, end = start[:, np.newaxis], end[:, np.newaxis]
    first, last, third = at(control, start), at(control, end), (end - start) / 3.0
    parts = np.stack(
        (first, first + third * velocity(control, start), last - third * velocity(control, end), last), axis=1
    )
    is_whole = (start[:, 0] == 0.0) & (end[:, 0] == 1.0)
    parts[is_whole] = control[is_whole]
    return parts


def chord_counts(control: FloatArray, tolerance: float) -> FloatArray:
    """Into how many chords (n,) at equal parameters cubics (n, 4, 2) split for none to be further from its curve than
    `tolerance`; a whole number each, or infinite.

    A cubic with second differences D takes sqrt(6 |D| / (8 tolerance)): its second derivative is at most 6 |D|, and a
    chord over dt misses it by at most dt^2 / 8 of that.
    """
    bend = np.linalg.norm(np.diff(control, n=2, axis=1), axis=2).max(axis=1)
    # Rounding must not bend a straight line.
    bend[bend < 1e-12 * np.abs(control).max(axis=(1, 2))] = 0.0
    counts: FloatArray = np.maximum(1.0, np.ceil(np.sqrt(0.75 * bend / tolerance)))
    return counts


def chord_ends(counts: IntArray) -> tuple[IntArray, FloatArray]:
    """The curve and the parameter at which each chord ends, for curves of so many chords (n,)."""
    curve = np.repeat(np.arange(len(counts)), counts)
    chord = np.arange(len(curve)) - np.repeat(np.cumsum(counts) - counts, counts) + 1
    return curve, chord / counts[curve]
