"""How fast the pen may go along its paths: its own speed, and what straight lines between samples may cut off."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.placement.pen_path import PenPaths
from planner.ragged import starts_of
from planner.settings import PlanSettings

_STEP = 0.85
"""Ratio of the speeds that are tried, one after the other."""
_GAP_MM = 1e4
_PARTS = 2
"""Parts of a cell at whose ends chords are tried: a hairpin may turn in the middle of one."""


def pen_speed_mm_s(arm: Arm, settings: PlanSettings) -> float:
    """The cap on the pen's speed on the paper: what is asked for, or the arm's own."""
    return settings.speed_mm_s or arm.pen.speed_mm_s


def rate_limit(
    paths: PenPaths, fractions: FloatArray, speed_mm_s: float, chord_error_mm: float, rate_hz: float
) -> FloatArray:
    """(total cells, n_fractions) cap on dsigma/dt at fractions of every cell.

    Controllers join samples by straight lines. A line that spans a length l of path cuts a corner in its middle by the
    chord error of the chord from l/2 before to l/2 behind; so within l/2 of a point where that chord would cut too much
    the pen may not go faster than l per sample period.
    """
    speeds = _chord_speeds(paths, speed_mm_s, chord_error_mm, rate_hz)
    between = np.maximum(1.0 - np.abs(_PARTS * fractions - np.arange(_PARTS + 1)[:, None]), 0.0)
    slope = paths.positions(fractions, 1)
    with np.errstate(divide="ignore"):
        cap: FloatArray = speeds @ between / np.hypot(slope[..., 0], slope[..., 1])
    return cap


def _chord_speeds(paths: PenPaths, speed_mm_s: float, chord_error_mm: float, rate_hz: float) -> FloatArray:
    """(total cells, _PARTS + 1) the speeds that chords allow at the ends of the parts of every cell."""
    ends = paths.positions(np.linspace(0.0, 1.0, _PARTS + 1))
    steps = np.hypot(*np.moveaxis(np.diff(ends, axis=1), 2, 0)).ravel()
    n_parts = _PARTS * paths.n_cells
    first = starts_of(n_parts)[:-1]
    # One axis of arc length for all paths, with the end of each path as a point of its own and a gap behind it.
    last = first + n_parts - 1
    points = np.insert(ends[:, :-1].reshape(-1, 2), last + 1, ends[np.cumsum(paths.n_cells) - 1, -1], axis=0)
    steps = np.insert(steps, last + 1, _GAP_MM)
    along = np.concatenate(([0.0], np.cumsum(steps)[:-1]))
    is_left = np.ones(len(points), dtype=bool)
    is_left[last + 1 + np.arange(len(last))] = False
    begin = np.repeat(along[first + np.arange(len(first))], n_parts + 1)
    end = np.repeat(along[last + 1 + np.arange(len(last))], n_parts + 1)
    allowed = np.full(len(points), speed_mm_s)
    open_points = np.arange(len(points))  # where the chord of the speed at hand still cuts too much
    slowest = min(2 * chord_error_mm * rate_hz, speed_mm_s)  # half of a chord so short cannot stray further
    speed = speed_mm_s
    while len(open_points) and speed > slowest:
        half = 0.5 * speed / rate_hz
        at = along[open_points]
        before = _at(np.maximum(at - half, begin[open_points]), along, points)
        behind = _at(np.minimum(at + half, end[open_points]), along, points)
        cut = _distance_to_chord(points[open_points], before, behind) > chord_error_mm
        if speed < speed_mm_s:
            _restrict(allowed, speed, along, at[~cut], half)
        open_points = open_points[cut]
        speed = max(_STEP * speed, slowest)
    _restrict(allowed, speed, along, along[open_points], 0.5 * speed / rate_hz)
    left, right = (side.reshape(-1, _PARTS) for side in (allowed[is_left], allowed[1:][is_left[:-1]]))
    return np.column_stack((left, right[:, -1]))


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
