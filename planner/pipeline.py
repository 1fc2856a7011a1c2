"""The whole story on one page: an SVG becomes strokes, pen paths, joint paths, and a trajectory."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, islice, pairwise

import numpy as np

from planner.affine import compose, rotation
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import BoolArray, FloatArray
from planner.counted import counted
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import extent, flatten_all
from planner.drawing.join import join_strokes
from planner.drawing.metric import Metric
from planner.drawing.order import ordered
from planner.drawing.source import DrawingSource, SvgInMemory
from planner.drawing.svg import read_drawing
from planner.errors import LinksCollide, PlanError, TargetOutOfReach, UsageError
from planner.execution.context import PlanContext
from planner.execution.work_chunks import (
    pieces_of,
    planned_travel_moves,
    stroke_chunks,
    timed_strokes,
    travel_chunks,
)
from planner.execution.workers import ALONE, ChunkExecutor, Workers, executor_of
from planner.head import LeftOut, Placement
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath
from planner.kinematics.limits import Limits
from planner.motion.speed_limit import pen_speed_mm_s
from planner.motion.timed_stroke import TimedStroke
from planner.motion.tolerance import FLATTEN_SHARE, JOIN_SHARE
from planner.phases import phases_of
from planner.placement.clip import clip_strokes
from planner.placement.fit import fit_to_canvas
from planner.placement.pieces import Piece
from planner.placement.short_gaps import SHORTEST_GAP_MM, gaps_to_draw
from planner.placement.split import split_strokes
from planner.progress import Report
from planner.redundancy.arm_model import ArmModel
from planner.redundancy.configuration_map import ConfigurationMap
from planner.settings import Method, PlanSettings
from planner.stroke_figures import stroke_figures
from planner.summary import PhaseTimes, PlanSummary
from planner.timing.length_bound import require_bounded
from planner.trajectory import TRAVELLING, Trajectory
from planner.travel.travel_moves import TravelMove, TravelRules
from planner.travel.travel_time_metric import travel_time_metric
from planner.workspace.canvas import Canvas, canvas_of

_SMALL_BYTES = 60_000
"""Drawings in shorter files, of a few thousand points, are done sooner than worker processes have started."""
_BLOCK_SAMPLES = 65_536
_MANY_CHUNKS, _FORETELLING = 200, 8
"""Work chunks from which on some are timed beforehand, and how many of them."""
_TOO_MUCH = "draw less of it, or choose a lower --rate"


@dataclass(frozen=True, eq=False, slots=True)
class Plan:
    """drawing: what was planned, as it was read."""

    trajectory: Trajectory
    summary: PlanSummary
    drawing: Drawing


def plan(
    drawing_file: DrawingSource,
    settings: PlanSettings,
    report: Report,
    workers: Workers = ALONE,
    arm: Arm | None = None,
) -> Plan:
    """Plan one drawing. The result is the same whoever does the work. arm: None for the one that the settings name.
    Errors: PlannerError, before any result exists."""
    report("reading", 0, 1)
    context = PlanContext.of(arm or load_arm(settings.arm), settings)
    model, arm = context.model, context.model.arm
    lift_mm = _lift_mm(arm, settings)
    with executor_of(_worth_hiring(workers, drawing_file), context.make_ready) as executor:
        drawing = read_drawing(drawing_file, partial(report, "reading"), options=settings.reading)
        report("placing", 0, 1)
        canvas = canvas_of(model, settings.canvas, lift_mm)
        svg_to_arm, placement, scale, size_mm = _placed(drawing, canvas, settings)
        report("joining", 0, 1)
        strokes, left_out, warnings = _strokes(drawing, svg_to_arm, model, settings)
        report("ordering strokes", 0, 1)
        strokes, order_notes = _ordered(strokes, model, canvas)
        _require_bounded(strokes, arm, settings, lift_mm)
        timed, strokes, lost, notes = _timed_strokes(executor, context, strokes, report)
        timed, strokes, moves, more_lost, more_notes = _with_travel_moves(
            executor, context, timed, strokes, lift_mm, report
        )
    warnings += order_notes + notes + more_notes
    left_out += lost + more_lost
    trajectory = _assembled(arm, drawing_file, settings, svg_to_arm, placement, left_out, timed, moves)
    _verify(trajectory, arm)
    return Plan(trajectory, _summary(trajectory, model, timed, scale, size_mm, warnings), drawing)


def placed_strokes(
    drawing_file: DrawingSource, model: ArmModel, settings: PlanSettings
) -> tuple[list[FloatArray], list[str]]:
    """Strokes (n, 2) in arm mm, placed and in the order that they are planned in, and what was left out on the way.
    Errors: PlannerError."""
    lift_mm = _lift_mm(model.arm, settings)
    drawing = read_drawing(drawing_file, options=settings.reading)
    canvas = canvas_of(model, settings.canvas, lift_mm)
    svg_to_arm, _, _, _ = _placed(drawing, canvas, settings)
    strokes, _, warnings = _strokes(drawing, svg_to_arm, model, settings)
    strokes, notes = _ordered(strokes, model, canvas)
    return strokes, warnings + notes


def _lift_mm(arm: Arm, settings: PlanSettings) -> float:
    lift_mm = arm.pen.lift_mm if settings.lift_mm is None else settings.lift_mm
    if lift_mm < arm.pen.clearance_mm:
        raise UsageError(f"a lift of {lift_mm:g} mm is below the arm's pen clearance of {arm.pen.clearance_mm:g} mm")
    return lift_mm


def _ordered(strokes: Sequence[FloatArray], model: ArmModel, canvas: Canvas) -> tuple[list[FloatArray], list[str]]:
    """The strokes in the order that they are drawn in, and what is to be said of it."""
    start_mm, metric = canvas.to_arm_mm(np.zeros(2)), Metric(travel_time_metric(model), exponent=1 / 3)
    strokes, is_finished = ordered(strokes, start_mm, metric)
    note = f"a shorter way between the strokes may be left: {len(strokes)} are too many to search to the end"
    return strokes, [] if is_finished else [note]


def _require_bounded(strokes: Sequence[FloatArray], arm: Arm, settings: PlanSettings, lift_mm: float) -> None:
    """Errors: UsageError where speeds and rests alone, whatever the arm, make a plan too long."""
    drawn_mm = sum(float(np.hypot(*np.diff(stroke, axis=0).T).sum()) for stroke in strokes)
    lowered_mm = len(strokes) * arm.pen.clearance_mm + lift_mm
    parts = [
        (drawn_mm / pen_speed_mm_s(arm, settings), "drawing", "choose a higher --speed"),
        (lowered_mm / settings.lowering_speed_mm_s, "lowering the pen", "choose a higher --lowering-speed"),
        (len(strokes) * settings.dwell_s, "resting before strokes", "choose a shorter --dwell"),
    ]
    longest_s, what, advice = max(parts)
    require_bounded(longest_s, settings.rate_hz, what, f"{advice}, or a lower --rate")
    whole_s = sum(seconds for seconds, _, _ in parts)
    require_bounded(whole_s, settings.rate_hz, "the plan", f"{advice}, or a lower --rate")


def _worth_hiring(workers: Workers, drawing_file: DrawingSource) -> Workers:
    """The workers, or none beside this process where a drawing is too small for them."""
    try:
        n_bytes = len(drawing_file.content) if isinstance(drawing_file, SvgInMemory) else drawing_file.stat().st_size
    except (OSError, ValueError):  # its reader says what is wrong with it
        return ALONE
    return ALONE if n_bytes < _SMALL_BYTES and workers.cluster is None else workers


def _placed(
    drawing: Drawing, canvas: Canvas, settings: PlanSettings
) -> tuple[FloatArray, Placement, float, tuple[float, float]]:
    """The affine from SVG user units to arm millimetres, what is told of it, its scale against the page, and the size
    on paper."""
    turned = compose(rotation(settings.rotate_deg), drawing.user_to_page)
    low, high = extent(drawing.outlines, turned)
    onto_arm = fit_to_canvas(
        low, high, canvas, margin_mm=settings.margin_mm, scale=settings.fit, may_exceed=settings.skip_unreachable
    )
    scale = float(np.hypot(*onto_arm[:, 0]))
    width, height = scale * (high - low)
    # A drawing that keeps its size and may be cut is held within no rectangle.
    is_held = settings.fit or not settings.skip_unreachable
    sides = (canvas.near_mm, canvas.far_mm, canvas.right_mm, canvas.left_mm)
    placement = Placement(
        sides if is_held else None, settings.margin_mm if is_held else None, scale, settings.rotate_deg
    )
    return compose(onto_arm, turned), placement, scale, (float(width), float(height))


def _strokes(
    drawing: Drawing, svg_to_arm: FloatArray, model: ArmModel, settings: PlanSettings
) -> tuple[list[FloatArray], LeftOut, list[str]]:
    """Strokes (n, 2), arm mm, what was left out as out of reach, and what is to be said of them."""
    warnings = drawing.notes()
    left_out = LeftOut()
    short_gaps = gaps_to_draw(drawing.outlines, svg_to_arm)
    if short_gaps:
        warnings.append(f"gaps of dashes under {SHORTEST_GAP_MM:g} mm on paper, drawn solid: {len(short_gaps)}")
    strokes = flatten_all([*drawing.outlines, *short_gaps], svg_to_arm, FLATTEN_SHARE * settings.tolerance_mm)
    strokes = join_strokes(strokes, JOIN_SHARE * settings.tolerance_mm)
    branches = model.branches(settings.weights)
    if settings.skip_unreachable:
        n_taps = _drawn(strokes).taps
        strokes, lost_mm, lost_whole = clip_strokes(
            strokes, _in_reach(branches), max(float(branch.radii_mm[-1]) for branch in branches)
        )
        left_out = LeftOut(lost_mm, n_taps - _drawn(strokes).taps)
        if lost_mm or lost_whole:
            whole = counted(lost_whole - left_out.taps, "stroke") + " and " + counted(left_out.taps, "tap")
            warnings.append(f"out of reach and left out: {lost_mm:.1f} mm of line; {whole} whole")
        if not strokes:
            raise PlanError("nothing of the drawing is within reach")
    if len(branches) > 1 and settings.method is Method.PATH:
        strokes, n_split, n_more = split_strokes(strokes, [branch.reaches for branch in branches])
        if n_split:
            warnings.append(
                f"split, as no one branch reaches all of each: {counted(n_split, 'stroke')},"
                f" with {counted(n_more, 'more pen lift')}"
            )
    return strokes, left_out, warnings


def _drawn(strokes: Sequence[FloatArray]) -> LeftOut:
    """How much strokes are: what is left out without them."""
    lengths = [float(np.hypot(*np.diff(stroke, axis=0).T).sum()) for stroke in strokes if len(stroke) > 1]
    return LeftOut(sum(lengths), len(strokes) - len(lengths))


def _in_reach(branches: Sequence[ConfigurationMap]) -> Callable[[FloatArray], BoolArray]:
    def reachable(points_mm: FloatArray) -> BoolArray:
        reached: BoolArray = np.any([branch.reaches(points_mm) for branch in branches], axis=0)
        return reached

    return reachable


def _timed_strokes(
    executor: ChunkExecutor, context: PlanContext, strokes: Sequence[FloatArray], report: Report
) -> tuple[list[TimedStroke], list[FloatArray], LeftOut, list[str]]:
    """Joint samples of all strokes that can be drawn, these strokes, and what is to be said of them; those that cannot
    are left out if the user wants so."""
    settings = context.settings
    pieces = pieces_of(context, strokes)
    together = list(chain.from_iterable(pieces))
    report("drawing motions", 0, len(together))
    _foretell(executor, context, together)
    results = _results(executor, context, together, report)
    n_samples = 0
    timed: list[TimedStroke] = []
    kept: list[FloatArray] = []
    lost: list[FloatArray] = []
    for index, stroke in enumerate(strokes):
        made = list(islice(results, len(pieces[index])))
        infeasible_paths = [result for result in made if isinstance(result, InfeasiblePath)]
        if not infeasible_paths:
            timed.append(TimedStroke.of([result for result in made if isinstance(result, TimedStroke)]))
            kept.append(stroke)
            n_samples += len(timed[-1].joints)
            require_bounded(n_samples / settings.rate_hz, settings.rate_hz, "the drawing", _TOO_MUCH)
        elif settings.skip_unreachable:
            lost.append(stroke)
        else:
            first = infeasible_paths[0]
            nearest = int(np.argmin(np.hypot(*(stroke - first.tip_mm).T)))
            raise TargetOutOfReach(index, nearest, first.tip_mm, first.reason, first.joint, first.limit)
    if not timed:
        raise PlanError("nothing of the drawing can be drawn within the joint limits")
    unconverged = sum(not stroke.converged for stroke in timed)
    loose = sum(not stroke.held for stroke in timed)
    counts = [
        (len(lost), f"left out whole, as method {settings.method} cannot draw them"),
        (unconverged, "timed by the fallback, slower than the least time"),
        (loose, "off the drawing by more than the tolerance, however slow; try a larger --tolerance"),
    ]
    return timed, kept, _drawn(lost), [f"{what}: {counted(count, 'stroke')}" for count, what in counts if count]


def _foretell(executor: ChunkExecutor, context: PlanContext, pieces: Sequence[Piece]) -> None:
    """Time a few parts of a drawing that has very many, spread over all of it. Errors: UsageError where by these the
    whole would take at least twice as long as a plan may: that is better said now than after hours."""
    chunks = list(stroke_chunks(context, pieces))
    if len(chunks) < _MANY_CHUNKS:
        return
    few = chunks[:: max(len(chunks) // _FORETELLING, 1)]
    n_samples = sum(
        len(result.joints)
        for results in executor(timed_strokes, iter(few))
        for result in results
        if isinstance(result, TimedStroke)
    )
    rate_hz = context.settings.rate_hz
    least_s = 0.5 * n_samples / rate_hz * len(chunks) / len(few)
    require_bounded(least_s, rate_hz, "the drawing", _TOO_MUCH)


def _results(
    executor: ChunkExecutor, context: PlanContext, pieces: Sequence[Piece], report: Report
) -> Iterator[TimedStroke | InfeasiblePath]:
    """What became of each piece, as soon as it is known."""
    done = 0
    for results in executor(timed_strokes, stroke_chunks(context, pieces)):
        done += len(results)
        report("drawing motions", done, len(pieces))
        yield from results


def _with_travel_moves(
    executor: ChunkExecutor,
    context: PlanContext,
    timed: list[TimedStroke],
    strokes: list[FloatArray],
    lift_mm: float,
    report: Report,
) -> tuple[list[TimedStroke], list[FloatArray], list[TravelMove], LeftOut, list[str]]:
    """The strokes, the travel moves around them, and what is to be said of them. Strokes that the arm cannot get to, or
    away from, with its links apart are left out if the user wants so."""
    lost: list[FloatArray] = []
    while True:
        moves = _travel_moves(executor, context, timed, lift_mm, report)
        blocked = {_end_that_collides(index, move, len(timed)) for index, move in enumerate(moves) if move.collision}
        if not blocked:
            loose = sum(not move.held for move in moves)
            counts = [
                (f"left out whole, as links would collide before or after them: {counted(len(lost), 'stroke')}", lost),
                (
                    "the lifted pen strays by more than the tolerance, however slow; try a larger --tolerance:"
                    f" {counted(loose, 'pen-up move')}",
                    loose,
                ),
            ]
            return timed, strokes, moves, _drawn(lost), [note for note, count in counts if count]
        if not context.settings.skip_unreachable:
            index, collision = next((index, move.collision) for index, move in enumerate(moves) if move.collision)
            raise LinksCollide(index, collision.links, collision.clearance_mm, str(collision))
        lost += [strokes[index] for index in sorted(blocked)]
        free = [index for index in range(len(timed)) if index not in blocked]
        timed, strokes = [timed[index] for index in free], [strokes[index] for index in free]
        if not timed:
            raise PlanError("nothing of the drawing can be drawn with the arm's links apart")


def _end_that_collides(index: int, move: TravelMove, n_strokes: int) -> int:
    """The stroke, before or after the travel move of that index, that is nearer in time to where links collide."""
    leaves = move.collision is not None and 2 * move.collision.configuration < len(move.joints)
    return max(index - 1, 0) if leaves or index == n_strokes else index


def _travel_moves(
    executor: ChunkExecutor, context: PlanContext, timed: Sequence[TimedStroke], lift_mm: float, report: Report
) -> list[TravelMove]:
    """The pen-up moves before, between and after the strokes."""
    arm, settings = context.model.arm, context.settings
    rules = TravelRules(
        arm.pen.clearance_mm, lift_mm, settings.lowering_speed_mm_s, settings.rate_hz, settings.tolerance_mm
    )
    starts = [None, *(stroke.last for stroke in timed)]
    ends = [*(stroke.first for stroke in timed), None]
    moves: list[TravelMove] = []
    for made in executor(planned_travel_moves, travel_chunks(context, rules, starts, ends)):
        for index, move in enumerate(made, len(moves)):
            if not move.exact:
                raise PlanError(
                    f"the pen-up move before stroke {index} leaves the joint limits"
                    f" of arm {arm.name}; try another --method, a smaller --lift or a larger --margin"
                )
        moves += made
        report("travels", len(moves), len(starts))
    return moves


def _assembled(
    arm: Arm,
    drawing_file: DrawingSource,
    settings: PlanSettings,
    svg_to_arm: FloatArray,
    placement: Placement,
    left_out: LeftOut,
    timed: Sequence[TimedStroke],
    moves: Sequence[TravelMove],
) -> Trajectory:
    """All samples in order. Travel moves and strokes share the samples where they meet; these count as drawn."""
    n_samples = (
        sum(stroke.dwell_samples + len(stroke.joints) for stroke in timed)
        + sum(len(move.joints) for move in moves)
        - 2 * len(timed)
    )
    positions = np.empty((n_samples, len(arm.joints)))
    strokes = np.full(n_samples, TRAVELLING)
    end = 0
    for index, move in enumerate(moves):
        begin, end = end, end + len(move.joints) - (index > 0) - (index < len(timed))
        first = 1 if index else 0
        positions[begin:end] = arm.to_file_units(move.joints[first : first + end - begin])
        if index < len(timed):
            stroke = timed[index]
            begin, resting, end = end, end + stroke.dwell_samples, end + stroke.dwell_samples + len(stroke.joints)
            strokes[begin:end] = index
            positions[begin:resting] = arm.to_file_units(stroke.joints[:1])
            positions[resting:end] = arm.to_file_units(stroke.joints)
    (a, c, e), (b, d, f) = svg_to_arm.tolist()
    return Trajectory(
        arm=settings.arm,
        drawing=drawing_file.name,
        method=settings.method.value,
        rate_hz=settings.rate_hz,
        columns=arm.column_names,
        positions=positions,
        pen=strokes != TRAVELLING,
        stroke=strokes,
        svg_to_arm_mm=(a, b, c, d, e, f),
        placement=placement,
        left_out=left_out,
        paper=arm.paper,
        reading=settings.reading,
    )


def _verify(trajectory: Trajectory, arm: Arm) -> None:
    """Every limit, once more, on the samples as they will be written."""
    limits, period_s = Limits.of(arm), 1 / trajectory.rate_hz
    rounding = arm.from_file_units(trajectory.rounding.max(axis=0))
    slowing = max(  # blocks overlap by the three samples that a third difference looks back
        limits.slowing_of(
            arm.from_file_units(trajectory.positions[begin : begin + _BLOCK_SAMPLES + 3]), period_s, rounding
        )
        for begin in range(0, trajectory.n_samples, _BLOCK_SAMPLES)
    )
    if not np.isfinite(trajectory.positions).all():
        raise PlanError(
            "the trajectory has positions that are no finite numbers: a defect of the planner, please"
            " report it with the drawing"
        )
    if slowing > 1 + 1e-6:
        raise PlanError(
            f"the timing exceeds a joint limit by {100 * (slowing - 1):.3f} % of speed:"
            " a defect of the planner, please report it with the drawing"
        )


def _summary(
    trajectory: Trajectory,
    model: ArmModel,
    timed: Sequence[TimedStroke],
    scale: float,
    size_mm: tuple[float, float],
    warnings: list[str],
) -> PlanSummary:
    arm = model.arm
    tips_mm = model.kinematics.tip_mm(arm.independent_of(arm.from_file_units(trajectory.positions)))
    phases = PhaseTimes.of(phases_of(trajectory, tips_mm, arm.pen.clearance_mm), trajectory.rate_hz)
    return PlanSummary(
        n_strokes=len(timed),
        n_taps=sum(len(stroke.joints) == 1 for stroke in timed),
        drawn_mm=float(stroke_figures(trajectory, tips_mm).length_mm.sum()),
        travelled_mm=float(
            sum(np.hypot(*(after.first.tip_mm - before.last.tip_mm)) for before, after in pairwise(timed))
        ),
        size_mm=size_mm,
        scale=scale,
        phases=phases,
        duration_s=trajectory.duration_s,
        n_samples=trajectory.n_samples,
        rate_hz=trajectory.rate_hz,
        warnings=warnings,
    )
