"""How far a picture of a paper goes, and the paper itself, and where on it the base of the arm is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.trajectory import Trajectory

_MARGIN_MM = 5.0


def base_of(paper: PaperPose) -> tuple[float, float]:
    """Where on the paper the base is, seen square to it."""
    x, y, _ = paper.T_paper_base[:3, 3].tolist()
    return x, y


def view_mm(
    points: Sequence[FloatArray], reach_mm: tuple[float, float] | None, base_mm: tuple[float, float] | None
) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest arm x and y (2,) to show: all points (n, 2), the half ring, the base where it is to be seen,
    and a margin."""
    base = np.array([] if base_mm is None else [base_mm]).reshape(-1, 2)
    ring = [] if reach_mm is None else [base + np.array([[0.0, -reach_mm[1]], [reach_mm[1], reach_mm[1]]])]
    everything = np.concatenate([*points, *ring, base])
    low, high = np.nanmin(everything, axis=0), np.nanmax(everything, axis=0)
    margin = max(0.03 * float((high - low).max()), 5.0)
    return low - margin, high + margin


def paper_sides_mm(trajectory: Trajectory, xy: FloatArray) -> tuple[float, float, float, float]:
    """Near, far, right and left side of the paper: what the header tells, or else what the ink needs. xy: (n_samples,
    2) of the tip."""
    if trajectory.placement.canvas_mm is not None:
        return trajectory.placement.canvas_mm
    ink = xy[trajectory.pen] if trajectory.pen.any() else xy
    (near, right), (far, left) = ink.min(axis=0) - _MARGIN_MM, ink.max(axis=0) + _MARGIN_MM
    return float(near), float(far), float(right), float(left)
