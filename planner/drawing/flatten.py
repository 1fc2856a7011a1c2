"""Curves to polylines within a chord error, and the true extent of curves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.drawing import Outline
from planner.errors import PlanError

POINT_LIMIT = 5_000_000


def flatten_all(outlines: Sequence[Outline], user_to_arm: FloatArray, tolerance_mm: float) -> list[FloatArray]:
    """Outlines as polylines (n, 2) in the frame that `user_to_arm` (2, 3) leads to; a tap gives (1, 2). Curve and
    polyline are nowhere further apart than `tolerance_mm`.

    A cubic with second differences D splits at equal parameters into sqrt(6 |D| / (8 tolerance)) chords, since its
    second derivative is at most 6 |D| and a chord over dt misses it by at most dt^2 / 8 of that. Errors: PlanError
    where that comes to more points than the limit.
    """
    if not outlines:
        return []
    control = _transformed(outlines, user_to_arm)
    bend = np.linalg.norm(np.diff(control, n=2, axis=1), axis=2).max(axis=1)
    # Rounding must not bend a straight line.
    bend[bend < 1e-12 * np.abs(control).max(axis=(1, 2))] = 0.0
    n_chords = np.maximum(1.0, np.ceil(np.sqrt(0.75 * bend / tolerance_mm)))
    if not n_chords.sum() <= POINT_LIMIT:
        raise PlanError(
            f"at this size and tolerance the drawing comes to more than {POINT_LIMIT} points; make it"
            " smaller (--fit), or the --tolerance larger"
        )
    n_chords = n_chords.astype(np.int64)
    curve = np.repeat(np.arange(len(control)), n_chords)
    chord = np.arange(len(curve)) - np.repeat(np.cumsum(n_chords) - n_chords, n_chords) + 1
    ends = _at(control[curve], (chord / n_chords[curve])[:, np.newaxis])
    is_last = chord == n_chords[curve]
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


def extent(outlines: Sequence[Outline], affine: FloatArray) -> tuple[FloatArray, FloatArray]:
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
    reached = np.stack([control[:, 0], control[:, 3], *(_at(control, t) for t in turns)])
    return reached.min(axis=(0, 1)), reached.max(axis=(0, 1))


def _transformed(outlines: Sequence[Outline], affine: FloatArray) -> FloatArray:
    """All curves of all outlines, (n, 4, 2)."""
    control = np.concatenate([outline.beziers for outline in outlines])
    moved: FloatArray = control @ affine[:, :2].T + affine[:, 2]
    return moved


def _at(control: FloatArray, t: FloatArray) -> FloatArray:
    """Points (n, 2) of cubics (n, 4, 2) at parameters (n, 1), or (n, 2) for each coordinate its own."""
    s = 1.0 - t
    point: FloatArray = (
        s * s * s * control[:, 0]
        + 3.0 * s * s * t * control[:, 1]
        + 3.0 * s * t * t * control[:, 2]
        + t * t * t * control[:, 3]
    )
    return point
