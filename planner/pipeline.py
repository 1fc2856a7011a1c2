"""The whole story on one page: an SVG becomes strokes, pen paths, joint paths, and a trajectory."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from planner.affine import compose, rotation
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arms.canvas import canvas_of
from planner.arms.kinematics import kinematics_of
from planner.arms.posture_field import posture_field
from planner.arrays import BoolArray, FloatArray
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import extent, flatten_all
from planner.drawing.join import join_strokes
from planner.drawing.order import order_strokes
from planner.drawing.svg import read_drawing
from planner.errors import PlanError, TargetOutOfReach, UsageError
from planner.inverse_kinematics.stroke_postures import Obstacle, exact_postures, joint_paths, postures_at
from planner.placement.clip import clip_strokes
from planner.placement.fit import fit_to_canvas
from planner.placement.pen_path import smooth_paths
from planner.settings import PlanSettings
from planner.summary import PhaseTimes, PlanSummary
from planner.timing.hops import Hop, HopRules, Touch, plan_hops
from planner.timing.limits import Limits
from planner.timing.path_timing import FRACTIONS, TimingProblem, minimum_time
from planner.timing.speed_cap import rate_cap
from planner.timing.stroke_motion import motions
from planner.trajectory import TRAVELLING, Trajectory

Report = Callable[[str, int, int], None]
"""Told the stage, how much of it is done, and how much there is."""

_FLATTEN_SHARE, _JOIN_SHARE, _SMOOTH_SHARE, _SAMPLE_SHARE = 0.1, 0.1, 0.5, 0.4
"""Shares of the tolerance: chords for curves, gaps that are closed, rounded corners, and the straight
lines between samples."""

_CHUNK_POINTS = 6000
_TIMING_HALVINGS = 2
"""How often the cells of a path are cut in two before it is timed: jerk switches at cell ends only, and cells as
long as the corners that they go round are too coarse for that."""
_TAP_S = 0.05
"""How long a tap rests on the paper at least: a pen needs a moment to leave a dot."""


@dataclass(frozen=True, eq=False, slots=True)
class Plan:
    trajectory: Trajectory
    summary: PlanSummary


@dataclass(frozen=True, eq=False, slots=True)
class _TimedStroke:
    """A stroke ready to be drawn: joint samples (n, n_joints) and where it touches down and lifts off."""

    joints: FloatArray
    first: Touch
    last: Touch
    dwell_samples: int


def plan(drawing_file: Path, settings: PlanSettings, report: Report) -> Plan:
    """Plan one drawing. Errors: PlannerError, before any result exists."""
    arm = load_arm(settings.arm)
    lift_mm = arm.pen.lift_mm if settings.lift_mm is None else settings.lift_mm
    if lift_mm < arm.pen.clearance_mm:
        raise UsageError(f"a lift of {lift_mm:g} mm is below the arm's pen clearance of {arm.pen.clearance_mm:g} mm")
    report("reading", 0, 1)
    drawing = read_drawing(drawing_file)
    svg_to_arm, scale, size_mm = _placed(drawing, arm, settings, lift_mm)
    report("ordering strokes", 0, 1)
    strokes, warnings = _strokes(drawing, svg_to_arm, arm, settings)
    timed, lost = _timed_strokes(arm, strokes, settings, report)
    warnings += lost
    report("travels", 0, len(timed) + 1)
    hops = _hops(arm, timed, settings, lift_mm)
    report("travels", len(timed) + 1, len(timed) + 1)
    trajectory = _assembled(arm, drawing_file, settings, svg_to_arm, timed, hops)
    _verify(trajectory, arm)
    return Plan(trajectory, _summary(trajectory, strokes, timed, hops, scale, size_mm, drawing, warnings))


def _placed(drawing: Drawing, arm: Arm, settings: PlanSettings, lift_mm: float
            ) -> tuple[FloatArray, float, tuple[float, float]]:
    """The affine from SVG user units to arm millimetres, its scale against the page, and the size on paper."""
    canvas = canvas_of(arm, settings.canvas, lift_mm)
    turned = compose(rotation(settings.rotate_deg), drawing.user_to_page)
    low, high = extent(drawing.outlines, turned)
    onto_arm = fit_to_canvas(low, high, canvas, margin_mm=settings.margin_mm, scale=settings.fit)
    scale = float(np.hypot(*onto_arm[:, 0]))
    width, height = scale * (high - low)
    return compose(onto_arm, turned), scale, (float(width), float(height))


def _strokes(drawing: Drawing, svg_to_arm: FloatArray, arm: Arm, settings: PlanSettings
             ) -> tuple[list[FloatArray], list[str]]:
    """Strokes in drawing order, (n, 2) arm mm, and what was left out on the way."""
    warnings = []
    if drawing.skipped:
        counts = ", ".join(f"{count} {kind}" for kind, count in sorted(drawing.skipped.items()))
        warnings.append(f"not drawn as in the SVG: {counts}")
    strokes = flatten_all(drawing.outlines, svg_to_arm, _FLATTEN_SHARE * settings.tolerance_mm)
    strokes = join_strokes(strokes, _JOIN_SHARE * settings.tolerance_mm)
    if settings.skip_unreachable:
        strokes, lost_mm, lost_whole = clip_strokes(strokes, _reachable(arm))
        if lost_mm or lost_whole:
            warnings.append(f"out of reach and left out: {lost_mm:.1f} mm of line; {lost_whole} strokes or taps whole")
        if not strokes:
            raise PlanError("nothing of the drawing is within reach")
    canvas = canvas_of(arm, settings.canvas, arm.pen.lift_mm)
    corner = canvas.to_arm_mm(np.zeros(2))
    return order_strokes(strokes, corner), warnings


def _reachable(arm: Arm) -> Callable[[FloatArray], BoolArray]:
    field = posture_field(arm)

    def reachable(points_mm: FloatArray) -> BoolArray:
        radius = np.hypot(*points_mm.T)
        inside = (radius >= field.radii_mm[0]) & (radius <= field.radii_mm[-1])
        _, good = field.postures_at(np.column_stack((points_mm, np.zeros(len(points_mm)))))
        reached: BoolArray = inside & good
        return reached

    return reachable


def _chunks(strokes: Sequence[FloatArray]) -> Iterator[list[int]]:
    """Indices of neighbouring strokes, in portions of bounded size."""
    chunk: list[int] = []
    points = 0
    for index, stroke in enumerate(strokes):
        chunk.append(index)
        points += len(stroke)
        if points >= _CHUNK_POINTS:
            yield chunk
            chunk, points = [], 0
    if chunk:
        yield chunk


def _timed_strokes(arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings, report: Report
                   ) -> tuple[list[_TimedStroke], list[str]]:
    """Joint samples of all strokes that can be drawn; those that cannot are left out if the user wants so."""
    timed: list[_TimedStroke] = []
    lost = 0
    for chunk in _chunks(strokes):
        report("drawing motions", chunk[0], len(strokes))
        lines = [index for index in chunk if len(strokes[index]) > 1]
        taps = [index for index in chunk if len(strokes[index]) == 1]
        made: dict[int, _TimedStroke | Obstacle] = {}
        if lines:
            made.update(zip(lines, _timed_lines(arm, [strokes[index] for index in lines], settings), strict=True))
        if taps:
            made.update(zip(taps, _timed_taps(arm, np.concatenate([strokes[index] for index in taps]), settings),
                            strict=True))
        for index in chunk:
            result = made[index]
            if isinstance(result, Obstacle):
                if not settings.skip_unreachable:
                    nearest = int(np.argmin(np.hypot(*(strokes[index] - result.tip_mm).T)))
                    raise TargetOutOfReach(index, nearest, result.tip_mm, result.reason, result.joint, result.limit)
                lost += 1
            else:
                timed.append(result)
    report("drawing motions", len(strokes), len(strokes))
    if not timed:
        raise PlanError("nothing of the drawing can be drawn within the joint limits")
    return timed, [f"left out whole, as method {settings.method} cannot draw them: {lost} strokes"] if lost else []


def _timed_lines(arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings) -> list[_TimedStroke | Obstacle]:
    paths = smooth_paths(strokes, _SMOOTH_SHARE * settings.tolerance_mm)
    splines, obstacles = joint_paths(arm, settings.method, paths)
    if obstacles and not settings.skip_unreachable:
        blocked = {obstacle.path: obstacle for obstacle in obstacles}
        return [blocked.get(index, obstacles[0]) for index in range(len(strokes))]
    if obstacles:
        blocked = {obstacle.path: obstacle for obstacle in obstacles}
        open_ways = [index for index in range(len(strokes)) if index not in blocked]
        rest = iter(_timed_lines(arm, [strokes[index] for index in open_ways], settings) if open_ways else ())
        return [blocked[index] if index in blocked else next(rest) for index in range(len(strokes))]
    limits = Limits.of(arm)
    for _ in range(_TIMING_HALVINGS):
        paths, splines = paths.halved(), splines.halved()
    derivatives = (splines.positions(FRACTIONS, 1), splines.positions(FRACTIONS, 2), splines.positions(FRACTIONS, 3))
    problem = TimingProblem.of(paths.n_cells, derivatives, (limits.velocity, limits.acceleration, limits.jerk),
                               rate_cap(paths, settings.speed_mm_s, _SAMPLE_SHARE * settings.tolerance_mm,
                                        settings.rate_hz))
    motion = motions(splines, minimum_time(problem), limits, settings.rate_hz)
    kinematics = kinematics_of(arm)
    dwell = round(settings.dwell_s * settings.rate_hz)
    timed: list[_TimedStroke | Obstacle] = []
    for stroke, joints in zip(strokes, motion.samples(), strict=True):
        free = kinematics.free_of(joints)
        timed.append(_TimedStroke(joints, Touch(stroke[0], free[0]), Touch(stroke[-1], free[-1]), dwell))
    return timed


def _timed_taps(arm: Arm, tips_mm: FloatArray, settings: PlanSettings) -> list[_TimedStroke | Obstacle]:
    tips = np.column_stack((tips_mm, np.zeros(len(tips_mm))))
    free, obstacles = exact_postures(arm, postures_at(arm, settings.method, tips), tips)
    blocked = {obstacle.path: obstacle for obstacle in obstacles}
    joints = arm.complete(free)
    rest = max(round(max(settings.dwell_s, _TAP_S) * settings.rate_hz), 1)
    touches = [Touch(tip, posture) for tip, posture in zip(tips_mm, free, strict=True)]
    return [blocked.get(index) or _TimedStroke(joints[index:index + 1], touch, touch, rest)
            for index, touch in enumerate(touches)]


def _hops(arm: Arm, timed: Sequence[_TimedStroke], settings: PlanSettings, lift_mm: float) -> list[Hop]:
    """The pen-up moves before, between and after the strokes."""
    rules = HopRules(arm.pen.clearance_mm, lift_mm, settings.lowering_speed_mm_s, settings.rate_hz)
    leave = [None, *(stroke.last for stroke in timed)]
    meet = [*(stroke.first for stroke in timed), None]
    hops: list[Hop] = []
    for begin in range(0, len(leave), _HOPS_AT_ONCE):
        part = slice(begin, begin + _HOPS_AT_ONCE)
        hops += plan_hops(kinematics_of(arm), Limits.of(arm), rules, leave[part], meet[part])
    for index, hop in enumerate(hops):
        if not hop.exact:
            raise PlanError(f"the pen-up move before stroke {index} leaves the joint limits"
                            f" of arm {arm.name}; try another --method, a smaller --lift or a larger --margin")
    return hops


_HOPS_AT_ONCE = 500


def _assembled(arm: Arm, drawing_file: Path, settings: PlanSettings, svg_to_arm: FloatArray,
               timed: Sequence[_TimedStroke], hops: Sequence[Hop]) -> Trajectory:
    """All samples in order. Hops and strokes share the samples where they meet; these count as drawn."""
    pieces, strokes = [hops[0].joints[:-1]], [np.full(len(hops[0].joints) - 1, TRAVELLING)]
    for index, (stroke, hop) in enumerate(zip(timed, hops[1:], strict=True)):
        joints = np.concatenate((np.repeat(stroke.joints[:1], stroke.dwell_samples, axis=0), stroke.joints))
        pieces += [joints, hop.joints[1:-1] if index + 1 < len(timed) else hop.joints[1:]]
        strokes += [np.full(len(joints), index), np.full(len(pieces[-1]), TRAVELLING)]
    stroke_column = np.concatenate(strokes)
    (a, c, e), (b, d, f) = svg_to_arm.tolist()
    return Trajectory(
        arm=settings.arm, drawing=drawing_file.name, method=settings.method.value, rate_hz=settings.rate_hz,
        columns=arm.column_names, positions=arm.to_file_units(np.concatenate(pieces)),
        pen=stroke_column != TRAVELLING, stroke=stroke_column, svg_to_arm_mm=(a, b, c, d, e, f))


def _verify(trajectory: Trajectory, arm: Arm) -> None:
    """Every limit, once more, on the samples as they will be written."""
    slowing = Limits.of(arm).slowing_of(arm.from_file_units(trajectory.positions), 1 / trajectory.rate_hz)
    if slowing > 1 + 1e-6:
        raise PlanError(f"the timing exceeds a joint limit by {100 * (slowing - 1):.3f} % of speed:"
                        " a defect of the planner, please report it with the drawing")


def _summary(trajectory: Trajectory, strokes: Sequence[FloatArray], timed: Sequence[_TimedStroke], hops: Sequence[Hop],
             scale: float, size_mm: tuple[float, float], drawing: Drawing, warnings: list[str]) -> PlanSummary:
    period = 1 / trajectory.rate_hz
    phases = PhaseTimes(
        drawing_s=sum(len(stroke.joints) - 1 for stroke in timed) * period,
        lowering_s=sum(hop.lowering_s for hop in hops), lifting_s=sum(hop.lifting_s for hop in hops),
        travelling_s=sum(hop.travelling_s for hop in hops),
        dwelling_s=sum(stroke.dwell_samples for stroke in timed) * period)
    return PlanSummary(
        n_strokes=len(timed), n_taps=sum(len(stroke.joints) == 1 for stroke in timed),
        drawn_mm=float(sum(np.hypot(*np.diff(stroke, axis=0).T).sum() for stroke in strokes if len(stroke) > 1)),
        travelled_mm=float(sum(np.hypot(*(after.first.tip_mm - before.last.tip_mm))
                               for before, after in pairwise(timed))),
        size_mm=size_mm, scale=scale, phases=phases, duration_s=trajectory.duration_s,
        n_samples=trajectory.n_samples, rate_hz=trajectory.rate_hz, warnings=warnings)
