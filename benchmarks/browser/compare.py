"""Two sets of lines, compared as sets of points both ways."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from planner.arrays import FloatArray

_TOLERANCE = 0.002
"""Of the longer side of the page."""
_STRAY = 3.0
"""Tolerances of length that may be off before lines disagree, and the share of the whole that may."""
_STRAY_SHARE = 0.003
_MOST_SAMPLES = 2_000_000


@dataclass(frozen=True, slots=True)
class Verdict:
    """less_mm: length of the reference that is not drawn; more_mm: length drawn that is not in the reference.
    kind: "agree", "less", "more" or "moved"."""

    kind: str
    less_mm: float
    more_mm: float
    reference_mm: float
    drawn_mm: float


def compare(
    reference: Sequence[FloatArray],
    sure: Sequence[FloatArray],
    drawn: Sequence[FloatArray],
    page_mm: tuple[float, float],
    slack: float = 1.0,
) -> Verdict:
    """Lines (n, 2) in mm against those of a reference; a line of no length is a dot. sure: the lines of the reference
    that must be there, the others may. slack: times the tolerance."""
    tolerance = slack * _TOLERANCE * max(page_mm)
    total = sum(_length(line) for line in (*reference, *drawn))
    step = max(tolerance / 2.0, total / _MOST_SAMPLES)
    ours, theirs = _samples(drawn, step, tolerance), _samples(reference, step, tolerance)
    less = _uncovered(_samples(sure, step, tolerance), ours, tolerance)
    more = _uncovered(ours, theirs, tolerance)
    allowed = max(_STRAY * tolerance, _STRAY_SHARE * theirs[1].sum())
    kinds = {(False, False): "agree", (True, False): "less", (False, True): "more", (True, True): "moved"}
    kind = kinds[less > allowed, more > allowed]
    return Verdict(kind, less, more, float(theirs[1].sum()), float(ours[1].sum()))


def without_background(lines: Sequence[FloatArray], page: tuple[float, float]) -> list[FloatArray]:
    """Lines but those that run around all that is on the page: the edge of a background."""
    slack = 0.02 * max(page)
    return [
        line for line in lines if (line.min(axis=0) > slack).any() or (line.max(axis=0) < np.array(page) - slack).any()
    ]


def _length(line: FloatArray) -> float:
    return float(np.hypot(*np.diff(line, axis=0).T).sum()) if len(line) > 1 else 0.0


def _samples(lines: Sequence[FloatArray], step: float, dot: float) -> tuple[FloatArray, FloatArray]:
    """Points (n, 2) along lines and the length that each stands for; a dot counts as a line that is just too long to
    be overlooked."""
    points, weights = [np.empty((0, 2))], [np.empty(0)]
    for line in lines:
        length = _length(line)
        if length < 1e-9:
            points.append(line[:1])
            weights.append(np.array([(_STRAY + 1.0) * dot]))
            continue
        along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
        count = max(int(np.ceil(length / step)), 1) + 1
        at = np.linspace(0.0, length, count)
        points.append(np.column_stack([np.interp(at, along, line[:, axis]) for axis in (0, 1)]))
        weights.append(np.full(count, length / count))
    return np.concatenate(points), np.concatenate(weights)


def _uncovered(these: tuple[FloatArray, FloatArray], those: tuple[FloatArray, FloatArray], tolerance: float) -> float:
    points, weights = these
    if len(points) == 0 or len(those[0]) == 0:
        return float(weights.sum())
    distances, _ = cKDTree(those[0]).query(points, distance_upper_bound=tolerance * 1.05)
    return float(weights[~np.isfinite(distances)].sum())
