"""From the polylines of strokes to pen paths: the smoothest curves within the tolerance, fit for rest at both ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.placement.polylines import Polylines, largest_of_parts, lines_of_parts
from planner.placement.rounded_path import rounded
from planner.placement.smoothest_path import smoothest
from planner.placement.tube import Tube, local_controls
from planner.ragged import starts_of
from planner.spline_paths import DEGREE, SplinePaths

ROUNDED_SHARE = 0.6
"""Share of the tolerance within which corners are rounded first: that fixes how long the cells are."""
_TUBE_SHARE = 0.85
"""Share of it that a tube takes unless told otherwise: between the bounded points a path strays a little further."""
_SURPLUS, _MOST = 0.75, 0.97
"""How much of what a tube leaves of the tolerance a path may take between the bounded points, and how much of the
tolerance at most: where it takes more, the tube is made narrower."""
_ROUNDS = 3
_TIGHTER, _TIGHTEST = 0.95, 0.6
"""A tube that a path strays from by more than the tolerance gets narrower around: what is aimed at, in tolerances, and
the least factor."""
_AROUND = (6, 6, 8, 8, 12, 12, 16)
"""Control points around a place where a path is moved towards where it started, round after round."""
_PER_CELL = 4
_SAMPLED = np.arange(_PER_CELL) / _PER_CELL
"""Fractions of every cell at which a path is compared with its polyline."""
_BESIDE = 2
"""Cells on both sides of one with too wide a tube that have it too."""


class PenPaths(SplinePaths):
    """Smooth paths of the pen on the paper: positions are points (2,) in mm."""

    __slots__ = ()


class ArcPaths(SplinePaths):
    """About where points of paths belong on the axis of arc length of their polylines: positions (1,) in mm."""

    __slots__ = ()


@dataclass(frozen=True, eq=False, slots=True)
class StrokePaths:
    """Pen paths, the polylines that they follow, and where along these they are.

    deviation_mm: (n_paths,) how far path and polyline are from each other at most.
    """

    line: Polylines
    pen: PenPaths
    arcs: ArcPaths
    deviation_mm: FloatArray

    def subdivided(self) -> StrokePaths:
        """The same paths with every cell cut in two."""
        return StrokePaths(self.line, self.pen.subdivided(), self.arcs.subdivided(), self.deviation_mm)

    def subset(self, chosen: BoolArray) -> StrokePaths:
        """Only the paths of the mask (n_paths,)."""
        return StrokePaths(
            self.line.subset(chosen), self.pen.subset(chosen), self.arcs.subset(chosen), self.deviation_mm[chosen]
        )


def smooth_paths(polylines: Sequence[FloatArray], tolerance_mm: float) -> PenPaths:
    """Smooth paths as `smoothed` makes them."""
    return smoothed(polylines, tolerance_mm).pen


def smoothed(polylines: Sequence[FloatArray], tolerance_mm: float, radius_mm: float | None = None) -> StrokePaths:
    """Smooth paths that stay within the tolerance of their polylines, and these of them, unless their deviation says
    otherwise: rounds of refinement come to an end.

    polylines: each (n >= 2, 2) in mm with distinct neighbours; radius_mm: of the tube that they are to be the smoothest
    in; they then leave a quarter of what is between it and the tolerance to others. Work is linear in the number of
    points.
    """
    line = Polylines.of(polylines)
    start = rounded(line, ROUNDED_SHARE * tolerance_mm)
    radius_mm = _TUBE_SHARE * tolerance_mm if radius_mm is None else radius_mm
    limit_mm = min(radius_mm + _SURPLUS * (tolerance_mm - radius_mm), _MOST * tolerance_mm)
    radius = np.full(int(start.n_cells.sum()), radius_mm)
    paths = SplinePaths(start.n_cells, start.controls.copy())
    deviation = np.full(len(polylines), np.inf)
    for _ in range(_ROUNDS):
        open_ = deviation > limit_mm
        cells, controls = np.repeat(open_, start.n_cells), np.repeat(open_, start.n_cells + DEGREE)
        some, along = paths.subset(open_), line.subset(open_)
        paths.controls[controls, :2] = smoothest(some, Tube.around(along, some, radius[cells]))
        of_cells = _deviations(along, paths.subset(open_), limit_mm)
        deviation[open_] = np.maximum.reduceat(of_cells, starts_of(some.n_cells)[:-1])
        radius[cells] *= _narrower(of_cells, limit_mm)
        if not (deviation > limit_mm).any():
            break
    else:
        _approach(line, paths, start, deviation, limit_mm)
    return StrokePaths(
        line,
        PenPaths(paths.n_cells, paths.controls[:, :2].copy()),
        ArcPaths(paths.n_cells, paths.controls[:, 2:].copy()),
        deviation,
    )


def _narrower(of_cells: FloatArray, tolerance_mm: float) -> FloatArray:
    """(cells,) factors for the radius of the tube: below 1 around cells that stray by more than the tolerance."""
    factor = np.where(of_cells > tolerance_mm, _TIGHTER * tolerance_mm / np.maximum(of_cells, 1e-12), 1.0)
    around = np.pad(np.maximum(factor, _TIGHTEST), _BESIDE, constant_values=1.0)
    factors: FloatArray = np.lib.stride_tricks.sliding_window_view(around, 2 * _BESIDE + 1).min(axis=1)
    return factors


def _approach(line: Polylines, paths: SplinePaths, start: SplinePaths, deviation: FloatArray, limit_mm: float) -> None:
    """Move paths that stray too far towards where they started: half way around where they do so, further around with
    every round, and whole paths all the way if nothing else brings them within the limit."""
    gone = paths.controls - start.controls
    for around in (*_AROUND, None):
        open_ = deviation > limit_mm
        controls = np.repeat(open_, start.n_cells + DEGREE)
        some, along = paths.subset(open_), line.subset(open_)
        gone[controls] *= (
            0.0 if around is None else _halved(some, _deviations(along, some, limit_mm) > limit_mm, around)
        )
        paths.controls[controls] = start.controls[controls] + gone[controls]
        of_cells = _deviations(along, paths.subset(open_), limit_mm)
        deviation[open_] = np.maximum.reduceat(of_cells, starts_of(some.n_cells)[:-1])
        if not (deviation > limit_mm).any():
            break


def _halved(paths: SplinePaths, cells: BoolArray, around: int) -> FloatArray:
    """(n_controls, 1) factors for control points: a half at those of the cells of the mask, from there rising to 1 over
    so many others of the same path; one factor for the five at each end, which belong together."""
    count = paths.n_cells + DEGREE
    place = np.arange(len(paths.controls)) + around * np.repeat(np.arange(len(count)), count)
    touched = np.zeros(int(place[-1]) + 1)
    touched[place[local_controls(paths)[cells].ravel()]] = 1.0
    distance = np.abs(np.arange(-around, around + 1)) / (around + 1)
    near = np.convolve(touched, 2.0 * np.minimum(1.0 - distance, 0.5))[around:][place]
    factors: FloatArray = 1.0 - 0.5 * np.minimum(near, 1.0)
    starts = starts_of(count)
    for ends in (starts[:-1, None] + np.arange(DEGREE), starts[1:, None] - 1 - np.arange(DEGREE)):
        factors[ends] = factors[ends].min(axis=1, keepdims=True)
    return factors[:, None]


def _deviations(line: Polylines, paths: SplinePaths, exact_above_mm: float) -> FloatArray:
    """(cells,) how far a path of x, y and arc length is from its polyline in each cell, both ways."""
    ends = np.cumsum(paths.n_cells) - 1
    curve = paths.positions(np.append(_SAMPLED, 1.0))
    points = np.insert(curve[:, :-1].reshape(-1, 3), _PER_CELL * (ends + 1), curve[ends, -1], axis=0)
    of_path = lines_of_parts(paths.n_cells, _PER_CELL)
    deviations = line.deviations(points[:, :2], points[:, 2], of_path, exact_above_mm)
    return largest_of_parts(deviations, paths.n_cells, _PER_CELL)
