"""The pen path against the drawing, both ways: nothing extra, nothing missing, nothing twice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import FloatArray
from planner.checking.between import Sweep
from planner.checking.pen import place_of
from planner.checking.polyline import DenseLines, dense_lines
from planner.checking.verdict import Finding, Place
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import flatten_all
from planner.errors import UsageError
from planner.trajectory import Trajectory

FLATTENING_MM = 0.002
"""Chord error of the wanted lines, allowed beside the tolerance."""

SPACING_MM = 0.02
_MOST_POINTS = 2_000_000
_LARGEST_DRAWING_MM = 10_000.0


def drawing_findings(
        trajectory: Trajectory, drawing: Drawing, sweeps: Sequence[Sweep], tolerance_mm: float) -> list[Finding]:
    """Compare the tip while the pen is down, at and between samples, with the drawing's outlines where
    `svg_to_arm_mm` puts them."""
    user_to_arm = _user_to_arm(trajectory)
    trouble = _map_trouble(drawing, user_to_arm)
    if trouble:
        return [Finding("svg_to_arm_mm", False, remark=trouble)]
    wanted_lines = flatten_all(drawing.outlines, user_to_arm, FLATTENING_MM)
    wanted = _dense(wanted_lines)
    pen_lines = [_pen_lines(sweep) for sweep in sweeps]
    if not len(pen_lines[0].points_mm):
        missing_mm = float(wanted.length_at_points_mm().sum())
        return [Finding("nothing missing", False, remark=f"the pen is never down: all {missing_mm:.1f} mm are missing")]
    limit = tolerance_mm + FLATTENING_MM
    return [
        _extra(trajectory, wanted, pen_lines, sweeps, limit, user_to_arm),
        _missing(wanted, wanted_lines, pen_lines, limit, user_to_arm),
        _drawn_once(trajectory, wanted, pen_lines[0], len(wanted_lines), tolerance_mm),
    ]


def distance_from_drawing(trajectory: Trajectory, drawing: Drawing, tip_mm: FloatArray) -> FloatArray:
    """(n_samples,) mm from the tip (n_samples, 2 or more) to the drawing's outlines where `svg_to_arm_mm` puts them,
    seen from above; 0 while the pen is up. Errors: UsageError where that map means nothing."""
    user_to_arm = _user_to_arm(trajectory)
    trouble = _map_trouble(drawing, user_to_arm)
    if trouble:
        raise UsageError(f"svg_to_arm_mm of the trajectory {trouble}")
    distance = np.zeros(trajectory.n_samples)
    wanted = _dense(flatten_all(drawing.outlines, user_to_arm, FLATTENING_MM))
    distance[trajectory.pen] = wanted.distance_mm(tip_mm[trajectory.pen, :2])
    return distance


def _user_to_arm(trajectory: Trajectory) -> FloatArray:
    a, b, c, d, e, f = trajectory.svg_to_arm_mm
    return np.array([[a, c, e], [b, d, f]])


def _map_trouble(drawing: Drawing, user_to_arm: FloatArray) -> str:
    linear = user_to_arm[:, :2]
    if abs(np.linalg.det(linear)) <= 1e-9 * np.abs(linear).max() ** 2:
        return "squeezes the drawing to a line"
    corners = np.concatenate([outline.beziers.reshape(-1, 2) for outline in drawing.outlines])
    corners = corners @ linear.T + user_to_arm[:, 2]
    size_mm = float(np.ptp(corners, axis=0).max())
    return f"makes the drawing {size_mm:.4g} mm large" if size_mm > _LARGEST_DRAWING_MM else ""


def _dense(lines: Sequence[FloatArray]) -> DenseLines:
    points = np.concatenate(lines)
    joined = np.ones(len(points), dtype=bool)
    joined[np.cumsum([len(line) for line in lines]) - 1] = False
    return _with_bounded_spacing(points, joined, np.arange(len(points)))


def _pen_lines(sweep: Sweep) -> DenseLines:
    """The tip seen from above while the pen is down; `source` is the point of the sweep."""
    point = np.flatnonzero(sweep.down)
    joined = np.diff(point, append=-1) == 1
    return _with_bounded_spacing(sweep.tip_mm[point, :2], joined, point)


def _with_bounded_spacing(points: FloatArray, joined: np.ndarray, source: np.ndarray) -> DenseLines:
    """Cut at SPACING_MM, or wider where a very long drawing would take too much memory."""
    if not len(points):
        return DenseLines(points, joined, source)
    length = float((np.linalg.norm(np.diff(points, axis=0), axis=1) * joined[:-1]).sum())
    dense = dense_lines(points, joined, max(SPACING_MM, length / _MOST_POINTS))
    return DenseLines(dense.points_mm, dense.joined, source[dense.source])


def _user(arm_mm: FloatArray, user_to_arm: FloatArray) -> tuple[float, float]:
    u, v = np.linalg.solve(user_to_arm[:, :2], arm_mm - user_to_arm[:, 2])
    return float(u), float(v)


def _extra(trajectory: Trajectory, wanted: DenseLines, pen_lines: Sequence[DenseLines], sweeps: Sequence[Sweep],
           limit: float, user_to_arm: FloatArray) -> Finding:
    worst, best_place, remark = -1.0, Place(), ""
    for sweep, pen in zip(sweeps, pen_lines, strict=True):
        distance = wanted.distance_mm(pen.points_mm)
        index = int(np.argmax(distance))
        if distance[index] > worst:
            worst = float(distance[index])
            point = int(pen.source[index])
            place = place_of(trajectory, int(sweep.sample[point]), point, sweep)
            best_place = Place(place.time_s, place.sample, place.line, stroke=place.stroke, tip_mm=place.tip_mm,
                               svg_user=_user(pen.points_mm[index], user_to_arm))
            extra_mm = float(pen.length_at_points_mm()[distance > limit].sum())
            remark = f"from the drawing, {sweep.interpolation.value} joints"
            remark += f"; {extra_mm:.2f} mm of line are extra" if worst > limit else ""
    return Finding("nothing extra", worst <= limit, worst, limit, "mm", best_place, remark)


def _missing(wanted: DenseLines, wanted_lines: Sequence[FloatArray], pen_lines: Sequence[DenseLines], limit: float,
             user_to_arm: FloatArray) -> Finding:
    distance = np.max([pen.distance_mm(wanted.points_mm) for pen in pen_lines], axis=0)
    index = int(np.argmax(distance))
    worst = float(distance[index])
    ends = np.cumsum([len(line) for line in wanted_lines])
    outline = int(np.searchsorted(ends, wanted.source[index], side="right"))
    remark = f"from the pen path, outline {outline}"
    if worst > limit:
        missing_mm = float(wanted.length_at_points_mm()[distance > limit].sum())
        taps = np.array([len(line) == 1 for line in wanted_lines])
        missed = int(taps[np.searchsorted(ends, wanted.source[distance > limit], side="right")].sum())
        remark += f"; {missing_mm:.2f} mm of line are missing"
        remark += f" and {missed} tap{'' if missed == 1 else 's'}" if missed else ""
    x, y = wanted.points_mm[index].tolist()
    place = Place(tip_mm=(x, y), svg_user=_user(wanted.points_mm[index], user_to_arm))
    return Finding("nothing missing", worst <= limit, worst, limit, "mm", place, remark)


def _drawn_once(trajectory: Trajectory, wanted: DenseLines, pen: DenseLines, n_outlines: int,
                tolerance_mm: float) -> Finding:
    """Length on the paper against the drawing's. A hundredth is allowed, and at each end of an outline or
    stroke the tolerance, since ends that touch may be joined by that much."""
    wanted_mm, drawn_mm = (float(lines.length_at_points_mm().sum()) for lines in (wanted, pen))
    ends = 2 * (n_outlines + len(np.unique(trajectory.stroke[trajectory.pen])))
    limit = 1.01 * wanted_mm + ends * tolerance_mm
    return Finding("nothing twice", drawn_mm <= limit, drawn_mm, limit, "mm",
                   remark=f"drawn; the drawing has {wanted_mm:.1f} mm of line")
