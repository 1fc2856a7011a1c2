"""The pen path against the drawing, both ways: nothing extra, nothing missing, nothing twice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from planner.affine import scale_of
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.checking.between import Sweep
from planner.checking.check_result import Finding, Place
from planner.checking.chosen import told_by
from planner.checking.mapping import map_findings, map_trouble
from planner.checking.pen import place_of
from planner.checking.polyline import DenseLines, dense_lines, joined_lines
from planner.checking.repeats import most_repeated
from planner.checking.sheet import on_the_sheet
from planner.checking.tone import tone_findings
from planner.checking.wanted import WantedLines, wanted_lines
from planner.counted import counted
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import flatten_all
from planner.drawing.image.lines import image_lines
from planner.errors import UsageError
from planner.head import NOTHING_LEFT_OUT, LeftOut
from planner.trajectory import Trajectory

FLATTENING_MM = 0.002
"""Chord error of the wanted lines, allowed beside the tolerance."""

SPACING_MM = 0.02
_MOST_POINTS = 2_000_000
_TOLD_SHARE = 0.005
"""By how much more than the header says may be missing: lengths are measured on other chords."""
_HIDDEN = 4.0
"""Tolerances of line that a single short stroke may be near other ink with, at both of its ends."""


def drawing_findings(
    trajectory: Trajectory, drawing: Drawing, sweeps: Sequence[Sweep], tolerance_mm: float
) -> list[Finding]:
    """Compare the tip while the pen is down, at and between samples, with the drawing's outlines where
    `svg_to_arm_mm` puts them."""
    trouble = map_trouble(trajectory, drawing)
    if trouble:
        return [Finding("svg_to_arm_mm", False, remark=trouble)]
    affine = trajectory.svg_to_arm
    lines = _wanted(trajectory, drawing)
    pen_lines = [_pen_lines(sweep) for sweep in sweeps]
    shape = map_findings(trajectory, drawing, tolerance_mm)
    if not len(pen_lines[0].points_mm):
        missing_mm = float(_dense(lines.allowed).length_at_points_mm().sum())
        return [
            *shape,
            Finding("nothing missing", False, remark=f"the pen is never down: all {missing_mm:.1f} mm are missing"),
        ]
    work = trajectory.path_work
    limit = tolerance_mm + FLATTENING_MM + work.simplify_mm
    allowed = _dense(lines.allowed)
    off_mm = [allowed.distance_mm(pen.points_mm) for pen in pen_lines]
    extra_mm = [_off_bridges(pen, off, limit, work.join_mm or 0.0) for pen, off in zip(pen_lines, off_mm, strict=True)]
    return [
        *shape,
        _extra(trajectory, pen_lines, extra_mm, sweeps, limit, affine),
        _missing(trajectory, lines.required, pen_lines, limit + work.dedup_mm, affine),
        _drawn_once(
            trajectory,
            _with_joints(lines.allowed, work.join_mm or 0.0),
            pen_lines[0],
            off_mm[0] > limit,
            sweeps[0],
            limit,
            affine,
        ),
        *tone_findings(trajectory, drawing, pen_lines[0], _outlines(trajectory, drawing)),
    ]


def distance_from_drawing(trajectory: Trajectory, drawing: Drawing, tip_mm: FloatArray) -> FloatArray:
    """(n_samples,) mm from the tip (n_samples, 2 or more) to the drawing's outlines where `svg_to_arm_mm` puts them,
    seen from above, or to the gaps that it was to draw across; 0 while the pen is up. Errors: UsageError where that map
    means nothing."""
    trouble = map_trouble(trajectory, drawing)
    if trouble:
        raise UsageError(f"svg_to_arm_mm of the trajectory {trouble}")
    distance = np.zeros(trajectory.n_samples)
    lines, join_mm = _wanted(trajectory, drawing).allowed, trajectory.path_work.join_mm
    if join_mm:
        down = np.flatnonzero(trajectory.pen)
        pen = _with_bounded_spacing(tip_mm[down, :2], np.diff(down, append=-1) == 1, down)
        lines = [*lines, *_bridges(pen, _dense(lines).distance_mm(pen.points_mm), join_mm / 4, join_mm)]
    distance[trajectory.pen] = _dense(lines).distance_mm(tip_mm[trajectory.pen, :2])
    return distance


def _wanted(trajectory: Trajectory, drawing: Drawing) -> WantedLines:
    """The lines of what the header tells that was drawn, as often as it was, and of it what its sheet holds."""
    affine, copies, tile = trajectory.svg_to_arm, trajectory.placement.copies, trajectory.placement.tile
    shift = np.zeros(2) if tile is None else np.array(tile.shift_mm)
    affine = np.column_stack((affine[:, :2], affine[:, 2] - shift))  # of the whole, which fills are laid out for
    of_pictures = image_lines(drawing, affine) if drawing.reading.image.is_on else []
    is_wanted = told_by(trajectory.chosen, replace(drawing, outlines=(*drawing.outlines, *of_pictures)), affine)
    if not trajectory.fill.draws_anything:
        lines = wanted_lines(drawing, affine, FLATTENING_MM, is_wanted)
    else:
        from planner.drawing.fill.fill import fill_lines, is_wide

        mm_per_unit = scale_of(affine)
        lines = wanted_lines(
            drawing,
            affine,
            FLATTENING_MM,
            lambda line: is_wanted(line) and not is_wide(line, trajectory.fill, mm_per_unit),
        )
        filling = [line for line in fill_lines(drawing, trajectory.fill, affine) if is_wanted(line)]
        within = flatten_all(filling, affine, FLATTENING_MM)
        lines = WantedLines([*lines.allowed, *within], [*lines.required, *within])
    if of_pictures:
        within = flatten_all([line for line in of_pictures if is_wanted(line)], affine, FLATTENING_MM)
        lines = WantedLines([*lines.allowed, *within], [*lines.required, *within])
    if copies is not None:
        lines = _repeated(lines, copies.steps_mm)
    return lines if tile is None else on_the_sheet(_repeated(lines, shift[None]), tile, FLATTENING_MM)


def _repeated(lines: WantedLines, steps: FloatArray) -> WantedLines:
    """The lines once for each of the steps (n, 2), moved by it."""
    return WantedLines(*([line + step for step in steps for line in some] for some in (lines.allowed, lines.required)))


def _outlines(trajectory: Trajectory, drawing: Drawing) -> list[FloatArray]:
    """The lines that are no picture's, where there are pictures to be held against these."""
    if not drawing.reading.image.is_on:
        return []
    tile = trajectory.placement.tile
    lines = flatten_all(drawing.outlines, trajectory.svg_to_arm, FLATTENING_MM)
    return lines if tile is None else [*lines, *tile.mark_lines()]


def _with_joints(lines: Sequence[FloatArray], join_mm: float) -> DenseLines:
    """The lines, and straight ones between ends of them that may be joined where the header tells of it, be it over a
    line that is that near to both: along this, what joins them is drawn beside it."""
    if not join_mm:
        return _dense(lines)
    ends = np.array([end for line in lines if len(line) > 1 for end in (line[0], line[-1])]).reshape(-1, 2)
    pairs = cKDTree(ends).query_pairs(2.0 * join_mm * (1.0 + 1e-6), output_type="ndarray")
    return _dense([*lines, *ends[pairs]])


def _bridges(pen: DenseLines, off_mm: FloatArray, limit: float, join_mm: float) -> list[FloatArray]:
    """(2, 2) the straight ways across gaps that are no wider, where the header tells of joined lines: wherever the pen
    path leaves the drawing, all within a stroke, and is back on it that near."""
    if not join_mm:
        return []
    edge = np.diff((off_mm > limit).astype(np.int8), prepend=0, append=0)
    before, after = np.flatnonzero(edge > 0) - 1, np.flatnonzero(edge < 0)
    line: IntArray = np.cumsum(~pen.joined) - ~pen.joined
    is_inside = (before >= 0) & (after < len(line))
    before, after = before[is_inside], after[is_inside]
    ways = np.stack((pen.points_mm[before], pen.points_mm[after]), axis=1)
    is_gap = (line[before] == line[after]) & (np.hypot(*(ways[:, 1] - ways[:, 0]).T) <= join_mm)
    return list(ways[is_gap])


def _off_bridges(pen: DenseLines, off_mm: FloatArray, limit: float, join_mm: float) -> FloatArray:
    """(n,) how far each point of the pen path is off the drawing and the ways across its gaps."""
    bridges = _bridges(pen, off_mm, limit, join_mm)
    return np.minimum(off_mm, _dense(bridges).distance_mm(pen.points_mm)) if bridges else off_mm


def _dense(lines: Sequence[FloatArray]) -> DenseLines:
    points, joined = joined_lines(lines)
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


def _user(arm_mm: FloatArray, affine: FloatArray) -> tuple[float, float]:
    u, v = np.linalg.solve(affine[:, :2], arm_mm - affine[:, 2])
    return float(u), float(v)


def _extra(
    trajectory: Trajectory,
    pen_lines: Sequence[DenseLines],
    off_mm: Sequence[FloatArray],
    sweeps: Sequence[Sweep],
    limit: float,
    affine: FloatArray,
) -> Finding:
    worst, best_place, remark = -1.0, Place(), ""
    for sweep, pen, distance in zip(sweeps, pen_lines, off_mm, strict=True):
        index = int(np.argmax(distance))
        if distance[index] > worst:
            worst = float(distance[index])
            point = int(pen.source[index])
            place = place_of(trajectory, int(sweep.sample[point]), point, sweep)
            best_place = replace(place, svg_user=_user(pen.points_mm[index], affine))
            extra_mm = float(pen.length_at_points_mm()[distance > limit].sum())
            remark = f"from the drawing, {sweep.interpolation.value} joints"
            remark += f"; {extra_mm:.2f} mm of line are extra" if worst > limit else ""
    return Finding("nothing extra", worst <= limit, worst, limit, "mm", best_place, remark)


def _missing(
    trajectory: Trajectory,
    required: Sequence[FloatArray],
    pen_lines: Sequence[DenseLines],
    limit: float,
    affine: FloatArray,
) -> Finding:
    """What is missing may be as much as the header says was left out; it has to be at least half of that, since lines
    that cross or cover it may hide some."""
    if not required:
        return Finding("nothing missing", True, remark="nothing has to be there: all is on the edge of what is seen")
    wanted = _dense(required)
    distance = np.max([pen.distance_mm(wanted.points_mm) for pen in pen_lines], axis=0)
    index = int(np.argmax(distance))
    worst = float(distance[index])
    ends = np.cumsum([len(line) for line in required])
    outline = int(np.searchsorted(ends, wanted.source[index], side="right"))
    is_missing = distance > limit
    taps = np.array([len(line) == 1 for line in required])
    missing = LeftOut(
        float(wanted.length_at_points_mm()[is_missing].sum()),
        int(taps[np.searchsorted(ends, wanted.source[is_missing], side="right")].sum()),
    )
    told = trajectory.left_out
    as_asked = (
        0.5 * told.length_mm - _HIDDEN * limit <= missing.length_mm <= (1 + _TOLD_SHARE) * told.length_mm + limit
        and 0.5 * told.taps <= missing.taps <= told.taps
    )
    x, y = wanted.points_mm[index].tolist()
    place = Place(tip_mm=(x, y), svg_user=_user(wanted.points_mm[index], affine))
    remark = f"from the pen path, outline {outline}"
    if told == NOTHING_LEFT_OUT:
        remark += f"; {missing.length_mm:.2f} mm of line are missing" if worst > limit else ""
        remark += f" and {counted(missing.taps, 'tap')}" if missing.taps else ""
        return Finding("nothing missing", worst <= limit, worst, limit, "mm", place, remark)
    if as_asked:
        return Finding("nothing missing", True, remark=f"left out as asked: {missing}", place=place)
    return Finding(
        "nothing missing",
        False,
        missing.length_mm,
        told.length_mm,
        "mm",
        place,
        f"of line: {missing} are missing, and the header says that {told} were left out",
    )


def _drawn_once(
    trajectory: Trajectory,
    wanted: DenseLines,
    pen: DenseLines,
    is_extra: BoolArray,
    sweep: Sweep,
    limit: float,
    affine: FloatArray,
) -> Finding:
    found = most_repeated(wanted, pen, is_extra, limit)
    point = int(pen.source[found.point])
    place = replace(
        place_of(trajectory, int(sweep.sample[point]), point, sweep), svg_user=_user(pen.points_mm[found.point], affine)
    )
    limit_of_passes = trajectory.path_work.passes * found.limit
    return Finding(
        "nothing twice", found.figure <= limit_of_passes, found.figure, limit_of_passes, found.unit, place, found.remark
    )
