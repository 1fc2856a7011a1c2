"""How fast the pen may go along its paths: its own speed, and what straight lines between samples may cut off."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.placement.pen_path import StrokePaths
from planner.placement.polylines import lines_of_parts
from planner.placement.segments import to_segments
from planner.ragged import starts_of
from planner.settings import PlanSettings

_STEP = 0.85
"""Ratio of the speeds that are tried, one after the other."""
_GAP_MM = 1e4
_SHORTEST = 0.2
"""Half of the shortest chord that is tried, in errors: what misses by more misses by the path itself."""
_LEAST_ROOM = 0.03
"""Share of the error that is left for a chord where the path itself takes all."""
_PASSED_MM = 0.5
_PARTS = 2
"""Parts of a cell at whose ends chords are tried: a hairpin may turn in the middle of one."""


def pen_speed_mm_s(arm: Arm, settings: PlanSettings) -> float:
    """The cap on the pen's speed on the paper: what is asked for, or the arm's own."""
    return settings.speed_mm_s or arm.pen.speed_mm_s


def rate_limit(
    paths: StrokePaths, fractions: FloatArray, speed_mm_s: float, error_mm: FloatArray, rate_hz: float
) -> FloatArray:
    """(total cells, n_fractions) cap on dsigma/dt at fractions of every cell; error_mm: (n_paths,).

    Controllers join samples by straight lines. A line that spans a length l of path passes its middle by the chord from
    l/2 before to l/2 behind; so within l/2 of a point whose place on the stroke that chord would miss by more than the
    error the pen may not go faster than l per sample period.
    """
    speeds = _chord_speeds(paths, speed_mm_s, error_mm, rate_hz)
    between = np.maximum(1.0 - np.abs(_PARTS * fractions - np.arange(_PARTS + 1)[:, None]), 0.0)
    slope = paths.pen.positions(fractions, 1)
    with np.errstate(divide="ignore"):
        cap: FloatArray = speeds @ between / np.hypot(slope[..., 0], slope[..., 1])
    return cap


def _chord_speeds(paths: StrokePaths, speed_mm_s: float, error_mm: FloatArray, rate_hz: float) -> FloatArray:
    """(total cells, _PARTS + 1) the speeds that chords allow at the ends of the parts of every cell."""
    n_cells, ends = paths.pen.n_cells, paths.pen.positions(np.linspace(0.0, 1.0, _PARTS + 1))
    steps = np.hypot(*np.moveaxis(np.diff(ends, axis=1), 2, 0)).ravel()
    n_parts = _PARTS * n_cells
    first = starts_of(n_parts)[:-1]
    # One axis of arc length for all paths, with the end of each path as a point of its own and a gap behind it.
    last = first + n_parts - 1
    points = np.insert(ends[:, :-1].reshape(-1, 2), last + 1, ends[np.cumsum(n_cells) - 1, -1], axis=0)
    wanted = _places_on_strokes(paths, points)
    error_by_point = np.repeat(error_mm, n_parts + 1)
    error_by_point = np.maximum(error_by_point, np.hypot(*(points - wanted).T) + _LEAST_ROOM * error_by_point)
    steps = np.insert(steps, last + 1, _GAP_MM)
    along = np.concatenate(([0.0], np.cumsum(steps)[:-1]))
    is_left = np.ones(len(points), dtype=bool)
    is_left[last + 1 + np.arange(len(last))] = False
    begin = np.repeat(along[first + np.arange(len(first))], n_parts + 1)
    end = np.repeat(along[last + 1 + np.arange(len(last))], n_parts + 1)
    allowed = np.full(len(points), speed_mm_s)
    open_points = np.arange(len(points))  # where the chord of the speed at hand still cuts too much
    slowest = min(_SHORTEST * 2 * float(error_mm.min()) * rate_hz, speed_mm_s)
    speed = speed_mm_s
    while len(open_points) and speed > slowest:
        half = 0.5 * speed / rate_hz
        at = along[open_points]
        before = _at(np.maximum(at - half, begin[open_points]), along, points)
        behind = _at(np.minimum(at + half, end[open_points]), along, points)
        cut = to_segments(wanted[open_points], before, behind) > error_by_point[open_points]
        if speed < speed_mm_s:
            _restrict(allowed, speed, along, at[~cut], half)
        open_points = open_points[cut]
        speed = max(_STEP * speed, slowest)
    _restrict(allowed, speed, along, along[open_points], 0.5 * speed / rate_hz)
    left, right = (side.reshape(-1, _PARTS) for side in (allowed[is_left], allowed[1:][is_left[:-1]]))
    return np.column_stack((left, right[:, -1]))


def _places_on_strokes(paths: StrokePaths, points: FloatArray) -> FloatArray:
    """(n, 2) where the ends (n, 2) of the parts of all paths belong on their strokes: the nearest point, or a vertex
    that is passed there and further away."""
    line, ends = paths.line, paths.arcs.positions(np.linspace(0.0, 1.0, _PARTS + 1))[..., 0]
    n_cells = paths.arcs.n_cells
    last = _PARTS * np.cumsum(n_cells)
    arc_mm = np.insert(ends[:, :-1].ravel(), last, ends[np.cumsum(n_cells) - 1, -1])
    foot_mm, distance_mm = line.feet(points, arc_mm, lines_of_parts(n_cells, _PARTS))
    wanted = line.at(foot_mm)
    foot_mm = np.maximum.accumulate(foot_mm)
    behind = np.clip(np.searchsorted(foot_mm, line.arc_mm), 1, len(points) - 1)
    gaps = [np.hypot(*(points[behind - k] - line.points_mm).T) for k in (0, 1)]
    nearest, gap = np.where(gaps[1] < gaps[0], behind - 1, behind), np.minimum(*gaps)
    passed = np.flatnonzero((gap > distance_mm[nearest]) & (gap < _PASSED_MM))
    passed = passed[np.argsort(gap[passed], kind="stable")]  # of several the furthest
    wanted[nearest[passed]] = line.points_mm[passed]
    return wanted


def _at(along_mm: FloatArray, axis_mm: FloatArray, points: FloatArray) -> FloatArray:
    return np.column_stack([np.interp(along_mm, axis_mm, column) for column in points.T])


def _restrict(allowed: FloatArray, speed: float, along: FloatArray, centres_mm: FloatArray, half_mm: float) -> None:
    """Cap the speed within half_mm of the centres."""
    if not len(centres_mm):
        return
    depth = np.zeros(len(along) + 1)
    np.add.at(depth, np.searchsorted(along, centres_mm - half_mm), 1)
    np.add.at(depth, np.searchsorted(along, centres_mm + half_mm, side="right"), -1)
    covered = np.cumsum(depth[:-1]) > 0
    allowed[covered] = np.minimum(allowed[covered], speed)
