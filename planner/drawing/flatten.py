"""Curves to polylines within a chord error, and the true extent of curves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.cubics import at, chord_counts, chord_ends
from planner.errors import PlanError

POINT_LIMIT = 5_000_000


class Curves(Protocol):
    """Consecutive cubics."""

    @property
    def beziers(self) -> FloatArray:
        """(n_curves, 4, 2)."""


def flatten_all(outlines: Sequence[Curves], user_to_arm: FloatArray, tolerance_mm: float) -> list[FloatArray]:
    """Outlines as polylines (n, 2) in the frame that `user_to_arm` (2, 3) leads to; a tap gives (1, 2). Curve and
    polyline are nowhere further apart than `tolerance_mm`. Errors: PlanError where that comes to more points than the
    limit.
    """
    if not outlines:
        return []
    control = _transformed(outlines, user_to_arm)
    needed = chord_counts(control, tolerance_mm)
    if not needed.sum() <= POINT_LIMIT:
        raise PlanError(
            f"at this size and tolerance the drawing comes to more than {POINT_LIMIT} points; make it"
            " smaller (--fit), or the --tolerance larger"
        )
    n_chords = needed.astype(np.int64)
    curve, t = chord_ends(n_chords)
    ends = at(control[curve], t[:, np.newaxis])
    is_last = t == 1.0
    ends[is_last] = control[curve[is_last], 3]

    n_curves = np.array([len(outline.beziers) for outline in outlines])
    first_curves = np.cumsum(n_curves) - n_curves
    n_points = np.add.reduceat(n_chords, first_curves)
    starts = np.cumsum(n_points) - n_points
    points = np.insert(ends, starts, control[first_curves, 0], axis=0)
    starts += np.arange(len(outlines))
    is_new = np.ones(len(points), dtype=np.bool_)
    is_new[1:] = np.any(points[1:] != points[:-1], axis=1)
    is_new[starts] = True
    kept_starts = np.cumsum(is_new)[starts] - 1
    return np.split(points[is_new], kept_starts[1:])


def extent(outlines: Sequence[Curves], affine: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest x and y, (2,) each, that the curves truly reach after `affine` (2, 3).

    Beside their ends, curves turn where the derivative of a coordinate is zero. Needs at least one outline.
    """
    control = _transformed(outlines, affine)
    d0, d1, d2 = np.moveaxis(np.diff(control, axis=1), 1, 0)
    # B'(t) / 3 = (d0 - 2 d1 + d2) t^2 - 2 (d0 - d1) t + d0; the roots in the form that survives a -> 0.
    a, half_b = d0 - 2.0 * d1 + d2, d1 - d0
    root = np.sqrt(np.maximum(half_b * half_b - a * d0, 0.0))
    q = -(half_b + np.copysign(root, half_b))
    with np.errstate(divide="ignore", invalid="ignore"):
        turns = [np.nan_to_num(np.clip(t, 0.0, 1.0)) for t in (q / a, d0 / q)]
    reached = np.stack([control[:, 0], control[:, 3], *(at(control, t) for t in turns)])
    return reached.min(axis=(0, 1)), reached.max(axis=(0, 1))


def _transformed(outlines: Sequence[Curves], affine: FloatArray) -> FloatArray:
    """All curves of all outlines, (n, 4, 2)."""
    control = np.concatenate([outline.beziers for outline in outlines])
    moved: FloatArray = control @ affine[:, :2].T + affine[:, 2]
    return moved
