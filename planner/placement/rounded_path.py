"""From polylines to rounded ones: C4 curves within a tolerance that start and end fit for rest.

Each path is a uniform quintic B-spline in sigma whose control points are points of the polyline, sharpened: moved away
from the mean of their neighbours (as in a quasi-interpolant; de Boor, A Practical Guide to Splines, chapter XII). The
curve passes corners inside and, a little before and behind them, outside; what it strays is proportional to the local
spacing of control points, so the spacing is made fine where the polyline turns and coarse where it is straight.
Near both ends the arc length grows with sigma cubed, as it grows with time cubed when a constant jerk
starts a motion: sigma then moves at a finite rate even where the pen is at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.placement.polylines import Polylines
from planner.ragged import starts_of, within
from planner.spline_paths import DEGREE, SplinePaths

_LONGEST_CELL_MM = 0.8
_GRADING = 0.6
"""How fast the spacing of control points may grow, mm per mm of path."""
_RAMP_CELLS = 4
"""Cells over which sigma changes from cubic to proportional to arc length, at each end."""
_FEWEST_CELLS = 12
_SHARPENING = 0.3
"""Share of the second difference that control points are moved by. 1/4 would reproduce cubics; a little more balances
what corners are cut with what is overshot beside them, and lets the pen pass them quicker than either side alone."""
_CORNER_GAIN = 0.25
"""A lone corner of turning angle t strays by 0.21 sin(t / 2) of the spacing where a control point lies on it, by 0.36
at worst: the spacing to begin with is for a corner between the two."""
_SLOW, _FIRM = (0.93, 0.95), (0.8, 0.85)
"""Share of the tolerance that a refined spacing aims at, and the largest factor that it takes: first little by little,
as every corner that is finer than it need be costs speed, then so that rounds come to an end."""
_SLOW_ROUNDS, _ROUNDS = 5, 30
_SAMPLED = np.array([0.0, 0.25, 0.5, 0.75])
"""Fractions of every cell at which a path is compared with its polyline."""
_FIRST_OFFSETS = np.array([-5.0, 0.5, 0.0, -0.5, 5.0])
"""Control points of sigma cubed on a uniform quintic spline with a knot at zero (its blossom)."""


def rounded(line: Polylines, tolerance_mm: float) -> SplinePaths:
    """Paths of x, y and the arc length that they keep pace with, within the tolerance of the polylines unless rounds of
    refinement come to an end before. Work is linear in the number of points."""
    anchors_mm, spacings_mm = line.arc_mm, _corner_spacings(line, tolerance_mm)
    for count in range(_ROUNDS):
        spacing = _Spacing.of(line, anchors_mm, spacings_mm)
        paths = _sampled(line, spacing)
        cut_mm, at_mm, used_mm = _deviation(line, paths, spacing)
        worst = cut_mm > tolerance_mm
        if not worst.any():
            break
        # A lone corner is cut in proportion to the spacing, a bend in proportion to its square.
        share, most = _SLOW if count < _SLOW_ROUNDS else _FIRM
        finer = used_mm[worst] * np.clip(share * tolerance_mm / cut_mm[worst], 0.25, most)
        anchors_mm = np.concatenate((anchors_mm, at_mm[worst]))
        spacings_mm = np.concatenate((spacings_mm, finer))
    return paths


def expected_cells(polylines: Sequence[FloatArray], tolerance_mm: float) -> list[FloatArray]:
    """(n,) for each polyline: about how many cells its smooth path has up to each of its points, as far as lone corners
    tell."""
    line = Polylines.of(polylines)
    spacing = _Spacing.of(line, line.arc_mm, _corner_spacings(line, tolerance_mm))
    cells = np.interp(line.arc_mm, spacing.node_mm, spacing.cells)
    return [along - along[0] for along in np.split(cells, line.first[1:])]


def _corner_spacings(line: Polylines, tolerance_mm: float) -> FloatArray:
    """(n,) the spacing with which each point of the polylines is cut by the tolerance if alone."""
    tight = 0.5 * _CORNER_GAIN * line.turns
    return np.minimum(0.95 * tolerance_mm / np.maximum(tight, 1e-9), _LONGEST_CELL_MM)


@dataclass(frozen=True, eq=False, slots=True)
class _Spacing:
    """Spacing of control points as a piecewise linear function of arc length, and the cells it makes.

    node_mm, spacing_mm: the function; cells: its cumulated number of cells, the integral of 1 / spacing.
    """

    node_mm: FloatArray
    spacing_mm: FloatArray
    cells: FloatArray
    begin: FloatArray
    total: FloatArray

    @staticmethod
    def of(line: Polylines, anchors_mm: FloatArray, spacings_mm: FloatArray) -> _Spacing:
        order = np.argsort(anchors_mm, kind="stable")
        at, wanted = anchors_mm[order], spacings_mm[order]
        forward = np.minimum.accumulate(wanted - _GRADING * at) + _GRADING * at
        backward = np.minimum.accumulate((wanted + _GRADING * at)[::-1])[::-1] - _GRADING * at
        wanted = np.minimum(forward, backward)
        keep = np.concatenate(([True], np.diff(at) > 1e-9))
        at, wanted = at[keep], wanted[keep]
        # Between two anchors the spacing rises, stays at its largest, and falls.
        length, a, b = np.diff(at), wanted[:-1], wanted[1:]
        top = np.minimum(0.5 * (a + b + _GRADING * length), _LONGEST_CELL_MM)
        rise, fall = np.maximum(top - a, 0) / _GRADING, np.maximum(top - b, 0) / _GRADING
        node = np.empty(3 * len(length) + 1)
        value = np.empty_like(node)
        node[0::3], value[0::3] = at, wanted
        node[1::3], value[1::3] = at[:-1] + rise, np.maximum(top, np.minimum(a, b))
        node[2::3], value[2::3] = at[1:] - fall, np.maximum(top, np.minimum(a, b))
        node = np.maximum.accumulate(node)
        step, slope = np.diff(node), np.diff(value)
        level = np.abs(slope) <= 1e-9 * value[:-1]
        inverse = np.where(level, 1 / value[:-1], np.log(value[1:] / value[:-1]) / np.where(level, 1.0, slope))
        cells = np.concatenate(([0.0], np.cumsum(step * inverse)))
        begin = np.interp(line.begin_mm, node, cells)
        return _Spacing(node, value, cells, begin, np.interp(line.end_mm, node, cells) - begin)

    def arc_mm(self, cells: FloatArray) -> FloatArray:
        """Position on the axis of arc length after so many cells: the exact inverse of `cells`."""
        k = np.clip(np.searchsorted(self.cells, cells, side="right") - 1, 0, len(self.cells) - 2)
        step = self.node_mm[k + 1] - self.node_mm[k]
        slope = (self.spacing_mm[k + 1] - self.spacing_mm[k]) / np.maximum(step, 1e-12)
        into = cells - self.cells[k]
        flat = np.abs(slope * into) < 1e-9
        growth = np.where(flat, into, np.expm1(slope * into) / np.where(flat, 1.0, slope))
        arc: FloatArray = self.node_mm[k] + np.clip(self.spacing_mm[k] * growth, 0.0, step)
        return arc

    def at(self, arc_mm: FloatArray) -> FloatArray:
        spacing: FloatArray = np.interp(arc_mm, self.node_mm, self.spacing_mm)
        return spacing


def _sampled(line: Polylines, spacing: _Spacing) -> SplinePaths:
    """The splines with that spacing."""
    n_cells = np.maximum(np.ceil(spacing.total).astype(np.int64) + _RAMP_CELLS, _FEWEST_CELLS)
    count = n_cells + DEGREE
    sigma = within(count).astype(np.float64) - 2.0
    per_control = np.repeat(np.arange(len(n_cells)), count)
    stretch = spacing.total / (n_cells - _RAMP_CELLS)

    def arc_at(sigma: FloatArray) -> FloatArray:
        cells = spacing.begin[per_control] + stretch[per_control] * _ramped(sigma, n_cells[per_control])
        return spacing.arc_mm(cells)

    three_mm = [arc_at(sigma + step) for step in (-1, 0, 1)]
    arc, controls = _sharpened(*three_mm), _sharpened(*map(line.at, three_mm))
    starts = starts_of(count)
    half_mm = 0.5 * (line.end_mm - line.begin_mm)
    for ends_mm, first, sign, point, neighbour in (
        (line.begin_mm, starts[:-1], 1, line.first, line.first + 1),
        (line.end_mm, starts[1:] - 1, -1, line.last, line.last - 1),
    ):
        cubic_mm = np.minimum(stretch / _RAMP_CELLS**2 * spacing.at(ends_mm), half_mm / 50)
        tangent = line.points_mm[neighbour] - line.points_mm[point]
        tangent /= np.hypot(*tangent.T)[:, None]
        for k, offset in enumerate(_FIRST_OFFSETS):
            controls[first + sign * k] = line.points_mm[point] + (offset * cubic_mm)[:, None] * tangent
            arc[first + sign * k] = ends_mm + sign * offset * cubic_mm
    return SplinePaths(n_cells, np.column_stack((controls, arc)))


def _sharpened(before: FloatArray, at: FloatArray, behind: FloatArray) -> FloatArray:
    sharpened: FloatArray = at - _SHARPENING * (before - 2 * at + behind)
    return sharpened


def _ramped(sigma: FloatArray, n_cells: IntArray) -> FloatArray:
    """Cells of uniform rate passed at sigma: of slope x^2 (3 - 2 x), x = sigma / ramp, near both ends, else 1."""

    def short_of(distance: FloatArray) -> FloatArray:
        x = np.clip(distance / _RAMP_CELLS, 0.0, 1.0)
        return _RAMP_CELLS * (x**3 - 0.5 * x**4 - x + 0.5)  # integral of slope - 1, zero from the ramp's end on

    inside = np.clip(sigma, 0.0, n_cells)
    ramped: FloatArray = inside + short_of(inside) - short_of(n_cells - inside) - 0.5 * _RAMP_CELLS
    return ramped


def _deviation(line: Polylines, paths: SplinePaths, spacing: _Spacing) -> tuple[FloatArray, FloatArray, FloatArray]:
    """How far each sampled curve point is from the polyline point of the same arc length, and each vertex from
    the curve there: upper bounds of the distance both ways. Also where on the axis of arc length that is,
    and the spacing used there."""
    curve = paths.positions(_SAMPLED).reshape(-1, 3)
    at = curve[:, 2]
    gap = curve[:, :2] - line.at(at)
    # A corner is furthest from the curve, and mostly lies between samples.
    passed = np.interp(line.arc_mm, at, np.arange(len(at))) / len(_SAMPLED)
    cell = passed.astype(np.int64)
    corner_gap = paths.at(cell, passed - cell)[:, :2] - line.points_mm
    at = np.concatenate((at, line.arc_mm))
    return np.hypot(*np.concatenate((gap, corner_gap)).T), at, spacing.at(at)
