"""The tube around polylines that a path has to stay in, as bounds on linear forms of its control points.

A point of the path may leave its place on the polyline across it by the radius, and along it by little, never past a
sharp vertex: so a path that keeps the bounds is nowhere far from the polyline, and the polyline nowhere from the path.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.placement.polylines import Polylines
from planner.ragged import starts_of
from planner.spline import first_controls, weights
from planner.spline_paths import DEGREE, SplinePaths

_FRACTIONS = np.array([0.0, 0.5])
"""Points of each cell that are bounded; and one vertex, the sharpest that the cell passes."""
_NO_TURN, _SHARP = 1e-3, 0.1
"""Turns (2 sin of half the angle) from which on a vertex is bounded, and no point of the path may slide past it."""
_SLIDE_CELLS = 0.3
_LEAST_SLIDE, _VERTEX_SLIDE = 0.2, 0.2
"""How far points may slide along the polyline: in lengths of their cell, at least and at a hairpin in radii."""


@dataclass(frozen=True, eq=False, slots=True)
class Tube:
    """Bounds -below <= rows . (control points of the cell) - centre <= above, for each cell of all paths.

    rows: (cells, n_bounds, 12), x and y of six control points in turn; centre, below, above: (cells, n_bounds).
    """

    rows: FloatArray
    centre: FloatArray
    below: FloatArray
    above: FloatArray

    @staticmethod
    def around(line: Polylines, paths: SplinePaths, radius_mm: FloatArray) -> Tube:
        """Of polylines, for paths of x, y and the arc length near which each point belongs; radius_mm: (cells,)."""
        n_cells = len(radius_mm)
        of_cell = np.repeat(np.arange(len(paths.n_cells)), paths.n_cells)
        points = paths.positions(_FRACTIONS)
        foot_mm = line.feet(
            points[..., :2].reshape(-1, 2), points[..., 2].ravel(), np.repeat(of_cell, len(_FRACTIONS))
        )[0].reshape(n_cells, -1)
        along = line.directions[line.segments(foot_mm, of_cell[:, None])]
        length_mm = np.hypot(*(points[:, -1, :2] - points[:, 0, :2]).T) / (_FRACTIONS[-1] - _FRACTIONS[0])

        sharp_mm = line.arc_mm[line.turns > _SHARP]
        sharp_mm = np.concatenate(([-np.inf], sharp_mm, [np.inf]))
        behind = np.searchsorted(sharp_mm, foot_mm)
        slide_mm, least_mm = _SLIDE_CELLS * length_mm[:, None], _LEAST_SLIDE * radius_mm[:, None]
        forth_mm = np.maximum(np.minimum(sharp_mm[behind] - foot_mm, slide_mm), least_mm)
        back_mm = np.maximum(np.minimum(foot_mm - sharp_mm[behind - 1], slide_mm), least_mm)

        vertex, place = _sharpest_vertices(line, paths)
        turn = line.turns[vertex]
        bounded = turn > _NO_TURN
        axis = line.directions[np.minimum(vertex, len(line.directions) - 1)] - line.directions[vertex - 1]
        axis *= (bounded / np.maximum(np.hypot(*axis.T), 1e-12))[:, None]
        vertex_slide_mm = np.minimum(
            2.0 * _VERTEX_SLIDE * radius_mm / np.maximum(turn, _NO_TURN), np.maximum(slide_mm, least_mm)[:, 0]
        )

        at = np.concatenate((line.at(foot_mm), line.points_mm[vertex][:, None]), axis=1)
        along = np.concatenate((along, np.stack((axis[:, 1], -axis[:, 0]), axis=-1)[:, None]), axis=1)
        across = np.stack((-along[..., 1], along[..., 0]), axis=-1)
        value = np.concatenate(
            (np.broadcast_to(weights(DEGREE, _FRACTIONS), (n_cells, len(_FRACTIONS), DEGREE + 1)),
             weights(DEGREE, place)[:, None]), axis=1
        )  # fmt: skip
        directions = np.concatenate((across, along), axis=1)
        radius = np.broadcast_to(radius_mm[:, None], across.shape[:2])
        return Tube(
            (np.concatenate((value, value), axis=1)[..., None] * directions[:, :, None]).reshape(n_cells, -1, 12),
            (np.concatenate((at, at), axis=1) * directions).sum(axis=-1),
            np.concatenate((radius, back_mm, vertex_slide_mm[:, None]), axis=1),
            np.concatenate((radius, forth_mm, vertex_slide_mm[:, None]), axis=1),
        )


def local_controls(paths: SplinePaths) -> IntArray:
    """(cells, 6) the control points of each cell."""
    return first_controls(paths.n_cells, DEGREE)[:, None] + np.arange(DEGREE + 1)


def _sharpest_vertices(line: Polylines, paths: SplinePaths) -> tuple[IntArray, FloatArray]:
    """The sharpest vertex that each cell passes, (cells,), and at which fraction of the cell; where it passes none,
    the beginning of its polyline."""
    starts = starts_of(paths.n_cells)
    knots_mm = np.maximum.accumulate(paths.positions(np.zeros(1))[:, 0, 2])
    cell = np.clip(np.searchsorted(knots_mm, line.arc_mm, side="right") - 1, 0, len(knots_mm) - 1)
    vertex = np.repeat(line.first, paths.n_cells)
    order = np.lexsort((line.turns, cell))
    last = np.flatnonzero(np.diff(cell[order], append=-1))
    vertex[cell[order][last]] = order[last]
    end_mm = np.append(knots_mm[1:], np.inf)
    end_mm[starts[1:] - 1] = line.end_mm
    fraction = (line.arc_mm[vertex] - knots_mm) / np.maximum(end_mm - knots_mm, 1e-12)
    return vertex, np.clip(fraction, 0.0, 1.0)
