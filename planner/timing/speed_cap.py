"""How fast the pen may go along its paths: its own speed, and what straight lines between samples may cut off."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.placement.pen_path import PenPaths
from planner.ragged import starts_of

_STEP = 0.85
"""Ratio of the speeds that are tried, one after the other."""
_SLOWEST = 0.01
_GAP_MM = 1e4
_ENDS = np.array([0.0, 1.0])


def rate_cap(paths: PenPaths, fractions: FloatArray, speed_mm_s: float, sagitta_mm: float, rate_hz: float
             ) -> FloatArray:
    """(total cells, n_fractions) cap on dsigma/dt at fractions of every cell.

    Controllers join samples by straight lines. A line that spans a length l of path cuts a corner in its middle by the
    sagitta of the chord from l/2 before to l/2 behind; so within l/2 of a point where that chord would cut too much the
    pen may not go faster than l per sample period.
    """
    left, right = _chord_speed(paths, speed_mm_s, sagitta_mm, rate_hz)
    slope = paths.points(fractions, 1)
    with np.errstate(divide="ignore"):
        cap: FloatArray = (left[:, None] + fractions * (right - left)[:, None]) / np.hypot(slope[..., 0], slope[..., 1])
    return cap


def _chord_speed(paths: PenPaths, speed_mm_s: float, sagitta_mm: float, rate_hz: float
                 ) -> tuple[FloatArray, FloatArray]:
    """(total cells,) the speeds that chords allow at the left and the right end of every cell."""
    ends = paths.points(_ENDS)
    steps = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    first = starts_of(paths.n_cells)[:-1]
    # One axis of arc length for all paths, with the end of each path as a point of its own and a gap behind it.
    last = first + paths.n_cells - 1
    points = np.insert(ends[:, 0], last + 1, ends[last, 1], axis=0)
    steps = np.insert(steps, last + 1, _GAP_MM)
    along = np.concatenate(([0.0], np.cumsum(steps)[:-1]))
    is_left = np.ones(len(points), dtype=bool)
    is_left[last + 1 + np.arange(len(last))] = False
    begin = np.repeat(along[first + np.arange(len(first))], paths.n_cells + 1)
    end = np.repeat(along[last + 1 + np.arange(len(last))], paths.n_cells + 1)
    allowed = np.full(len(points), speed_mm_s)
    open_points = np.arange(len(points))  # where the chord of the speed at hand still cuts too much
    speed = speed_mm_s
    while len(open_points) and speed > _SLOWEST * speed_mm_s:
        half = 0.5 * speed / rate_hz
        at = along[open_points]
        before = _at(np.maximum(at - half, begin[open_points]), along, points)
        behind = _at(np.minimum(at + half, end[open_points]), along, points)
        cut = _distance_to_chord(points[open_points], before, behind) > sagitta_mm
        if speed < speed_mm_s:
            _restrict(allowed, speed, along, at[~cut], half)
        open_points = open_points[cut]
        speed *= _STEP
    _restrict(allowed, speed, along, along[open_points], 0.5 * speed / rate_hz)
    return allowed[is_left], allowed[1:][is_left[:-1]]


def _at(along_mm: FloatArray, axis_mm: FloatArray, points: FloatArray) -> FloatArray:
    return np.column_stack([np.interp(along_mm, axis_mm, column) for column in points.T])


def _distance_to_chord(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """(n,) from points to the segments, not the lines, from start to end: round a hairpin the line may miss nothing."""
    chord, offset = end - start, points - start
    along = np.einsum("ij,ij->i", chord, offset) / np.maximum(np.einsum("ij,ij->i", chord, chord), 1e-18)
    off = offset - np.clip(along, 0.0, 1.0)[:, None] * chord
    distance: FloatArray = np.hypot(off[:, 0], off[:, 1])
    return distance


def _restrict(allowed: FloatArray, speed: float, along: FloatArray, centres_mm: FloatArray, half_mm: float) -> None:
    """Cap the speed within half_mm of the centres."""
    if not len(centres_mm):
        return
    depth = np.zeros(len(along) + 1)
    np.add.at(depth, np.searchsorted(along, centres_mm - half_mm), 1)
    np.add.at(depth, np.searchsorted(along, centres_mm + half_mm, side="right"), -1)
    covered = np.cumsum(depth[:-1]) > 0
    allowed[covered] = np.minimum(allowed[covered], speed)
