"""The whole story on one page: an SVG becomes strokes, pen paths, joint paths, and a trajectory."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import partial
from itertools import chain

import numpy as np

from planner.account import account_of
from planner.affine import scale_of
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arms.usual_settings import expected_error_mm, usual_clearance_mm, usual_tolerance_mm
from planner.arrays import FloatArray
from planner.as_servos_see import cut_corners_mm, samples_a_set_point
from planner.assembly import assembled, verify
from planner.drawing.drawing import Drawing
from planner.drawing.pen_groups import chosen_layers, pen_groups
from planner.drawing.source import DrawingSource, SvgInMemory
from planner.drawing.svg import read_drawing
from planner.errors import PlanError
from planner.execution.context import PlanContext
from planner.execution.workers import ALONE, ChunkExecutor, Workers, executor_of
from planner.head import Chosen, LeftOut, PathWork
from planner.motion.speed_limit import pen_speed_mm_s
from planner.pen_drawing import PenDrawing, lift_mm, require_bounded_whole
from planner.placement.place import Placed, inked_outlines, placed
from planner.progress import Report, unreported
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlaceKind, PlanSettings
from planner.summary import PlanSummary
from planner.trajectory import TRAVELLING, Trajectory
from planner.workspace.canvas import Canvas, canvas_of

_SMALL_BYTES = 60_000
"""Drawings in shorter files, of a few thousand points, are done sooner than worker processes have started."""


@dataclass(frozen=True, eq=False, slots=True)
class Plan:
    """drawing: what was planned, as it was read. by_pen: a trajectory for each pen, which draws what it draws."""

    trajectory: Trajectory
    summary: PlanSummary
    drawing: Drawing
    by_pen: tuple[Trajectory, ...] = ()

    @property
    def warnings(self) -> list[str]:
        return self.summary.warnings

    def lines(self) -> list[str]:
        """A few lines to read."""
        return self.summary.lines()


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
    return plan_with(
        PlanContext.of(arm or load_arm(settings.arm, cache=settings.cache), settings), drawing_file, report, workers
    )


def plan_with(
    context: PlanContext, drawing_file: DrawingSource, report: Report = unreported, workers: Workers = ALONE
) -> Plan:
    """Plan one drawing of several for the same arm, with the same settings. Errors: as `plan`."""
    settings = context.settings
    lift_mm(context.model.arm, settings)  # said before the work begins
    with executor_of(worth_hiring(workers, drawing_file), context.make_ready) as executor:
        drawing = read_drawing(drawing_file, partial(report, "reading"), options=settings.reading)
        place, drawings = _placed(executor, drawing, context, report)
        return planned(executor, context, drawing, drawing_file.name, place, drawings, report)


def placed_strokes(
    drawing_file: DrawingSource, model: ArmModel, settings: PlanSettings
) -> tuple[list[FloatArray], list[str]]:
    """Strokes (n, 2) in arm mm, placed and in the order that they are planned in, and what was left out on the way.
    Errors: PlannerError."""
    context = PlanContext(model, settings)
    drawing = read_drawing(drawing_file, options=settings.reading)
    with executor_of(ALONE) as executor:
        place, drawings = _placed(executor, drawing, context, unreported)
    drawings = _ordered(drawings, place, unreported)
    return list(chain.from_iterable(one.strokes for one in drawings)), told_of(place.drawing, drawings)


def canvas_for(context: PlanContext) -> Canvas:
    """The rectangle of the paper that is drawn on. Errors: PlanError, UsageError."""
    settings = context.settings
    return canvas_of(context.model, settings.canvas, lift_mm(context.model.arm, settings))


def _placed(
    executor: ChunkExecutor, drawing: Drawing, context: PlanContext, report: Report
) -> tuple[Placed, list[PenDrawing]]:
    """Where the drawing goes, and what each pen draws, before it has an order. Errors: PlannerError."""
    settings, canvas = context.settings, canvas_for(context)
    report("placing", 0, 1)
    if settings.place is not PlaceKind.BEST:
        return taken(placed(drawing, canvas, settings), context, report)
    anywhere = placed(drawing, canvas, replace(settings, skip_unreachable=True))
    anywhere, drawings = taken(anywhere, context, report)
    from planner.best_place import best_place  # few ask for it

    best = best_place(executor, context, inked_outlines(drawing), anywhere, drawings, report)
    place = replace(placed(drawing, canvas, settings, best.motion), won=best.told)
    return taken(place, context, report)


def taken(place: Placed, context: PlanContext, report: Report) -> tuple[Placed, list[PenDrawing]]:
    """What is chosen of a placed drawing, and what each pen draws of it, before it has an order. Errors:
    PlannerError."""
    model, settings = context.model, context.settings
    chosen = chosen_layers(place.drawing, settings.layers)
    report("joining", 0, 1)
    own_mm_s = pen_speed_mm_s(model.arm, settings)
    models = {0.0: model}  # by how far the tip of a pen sticks out
    drawings = []
    for group in pen_groups(chosen, settings.pens_by, settings.pens, scale_of(place.svg_to_arm)):
        of_pen = settings.with_pen(group.pen, own_mm_s, group.speed_share) if group.is_named else settings
        height_mm = group.pen.height_mm
        if height_mm not in models:
            models[height_mm] = ArmModel(model.arm.holding(height_mm, model.kinematics.held_along))
        is_usual = of_pen == settings and not height_mm
        one = PenDrawing(group, context if is_usual else PlanContext(models[height_mm], of_pen))
        one.take(place.svg_to_arm)
        drawings.append(one)
    return replace(place, drawing=chosen), drawings


def planned(
    executor: ChunkExecutor,
    context: PlanContext,
    drawing: Drawing,
    name: str,
    place: Placed,
    drawings: Sequence[PenDrawing],
    report: Report,
) -> Plan:
    """From the strokes of each pen to a plan. drawing: as it was read from the file of that name. Errors: PlanError,
    UsageError."""
    settings, model, arm = context.settings, context.model, context.model.arm
    drawings = _ordered(drawings, place, report)
    require_bounded_whole(drawings)
    drawings = _through(executor, drawings, PenDrawing.move, "within the joint limits", report)
    drawings = _through(executor, drawings, PenDrawing.travel, "with the arm's links apart", report)
    samples = assembled(drawings)
    left_out = sum((one.left_out for one in drawings), LeftOut())
    (a, c, e), (b, d, f) = place.svg_to_arm.tolist()
    trajectory = Trajectory(
        arm=settings.arm,
        drawing=name,
        method=settings.method.value,
        rate_hz=settings.rate_hz,
        columns=arm.column_names,
        positions=samples.positions,
        pen=samples.stroke != TRAVELLING,
        stroke=samples.stroke,
        svg_to_arm_mm=(a, b, c, d, e, f),
        placement=place.told,
        left_out=left_out,
        paper=arm.paper,
        pens=samples.pens,
        pen_changes=samples.pen_changes,
        chosen=Chosen(settings.layers),
        reading=drawing.reading,
        fill=settings.fill,
        timing=settings.timing,
        path_work=PathWork(settings.join_mm, settings.dedup_mm, settings.simplify_mm, settings.passes),
    )
    verify(trajectory, arm)
    by = settings.pens_by
    parts = [
        trajectory.part(first, last, pen, Chosen(settings.layers, by, kinds))
        for pen, (first, last), kinds in zip(samples.pens, samples.parts, samples.kinds, strict=False)
    ]
    by_pen = (*parts[:1], *(replace(part, placement=place.told.without_marks()) for part in parts[1:]))
    return Plan(trajectory, _summary(trajectory, model, drawings, place), drawing, by_pen)


def _ordered(drawings: Sequence[PenDrawing], place: Placed, report: Report) -> list[PenDrawing]:
    """The pens that draw anything, with what each draws in its order. Errors: PlanError where none does."""
    start_mm = place.canvas.to_arm_mm(np.zeros(2))
    for one in drawings:
        one.order(start_mm)
        report("ordering strokes", 0, 1)
        if one.strokes:
            start_mm = one.strokes[-1][-1]
    return _left(drawings, "nothing of the drawing is within reach")


def _through(
    executor: ChunkExecutor,
    drawings: Sequence[PenDrawing],
    station: Callable[[PenDrawing, ChunkExecutor, Report, int], None],
    how: str,
    report: Report,
) -> list[PenDrawing]:
    """The pens whose drawings come through a station, one after the other. Errors: PlanError where none does."""
    first = 0
    total = sum(len(one.strokes) for one in drawings)
    for one in drawings:
        n_strokes, before = len(one.strokes), first

        def told(stage: str, done: int, of: int, n_strokes: int = n_strokes, before: int = before) -> None:
            report(stage, round(before + n_strokes * done / max(of, 1)), total)

        station(one, executor, told if len(drawings) > 1 else report, first)
        first += n_strokes
    return _left(drawings, f"nothing of the drawing can be drawn {how}")


def _left(drawings: Sequence[PenDrawing], otherwise: str) -> list[PenDrawing]:
    """The pens that have something to draw, the first of which tells of the others too. Errors: PlanError where none
    has."""
    left = [one for one in drawings if one.strokes]
    if not left:
        raise PlanError(otherwise)
    lost = [one for one in drawings if not one.strokes]
    for one in lost:
        left[0].left_out += one.left_out
        left[0].notes += one.notes
    return left


def told_of(drawing: Drawing, drawings: Sequence[PenDrawing]) -> list[str]:
    """What is to be said of the drawing, and of what each pen draws of it."""
    notes = drawing.notes()
    if len(drawings) == 1:
        return notes + drawings[0].notes
    return notes + [f"{one.group.pen.name}: {note}" for one in drawings for note in one.notes]


def worth_hiring(workers: Workers, drawing_file: DrawingSource) -> Workers:
    """The workers, or none beside this process where a drawing is too small for them."""
    try:
        n_bytes = len(drawing_file.content) if isinstance(drawing_file, SvgInMemory) else drawing_file.stat().st_size
    except (OSError, ValueError):  # its reader says what is wrong with it
        return ALONE
    return ALONE if n_bytes < _SMALL_BYTES and workers.cluster is None else workers


def _summary(trajectory: Trajectory, model: ArmModel, drawings: Sequence[PenDrawing], place: Placed) -> PlanSummary:
    tolerance_mm = drawings[0].context.settings.tolerance_mm
    arm = model.arm
    free = arm.independent_of(arm.from_file_units(trajectory.positions))
    tip_mm = model.kinematics.tip_mm(free)
    if (heights_mm := trajectory.pen_heights_mm).any():
        tip_mm = tip_mm + heights_mm[:, None] * model.kinematics.tool_axis(free)
    account = account_of(trajectory, tip_mm, arm.pen.clearance_mm)
    return PlanSummary(
        **{one.name: getattr(account, one.name) for one in fields(account)},
        size_mm=place.size_mm,
        scale=place.scale,
        warnings=told_of(place.drawing, drawings),
        where=place.board.where(arm.paper),
        won=place.won,
        hints=place.notes,
        pens=tuple(pen.name for pen in trajectory.pens),
        remarks=tuple(_remarks(trajectory, arm, tip_mm, tolerance_mm)),
    )


def _remarks(trajectory: Trajectory, arm: Arm, tip_mm: FloatArray, tolerance_mm: float) -> Iterator[str]:
    """On the tolerance and the clearance of a calibrated arm, and on what its servos see of the samples."""
    if (error_mm := expected_error_mm(arm)) and tolerance_mm == usual_tolerance_mm(arm):
        yield f"tolerance {tolerance_mm:g} mm, by what this arm is expected to be off by: {error_mm:.2g} mm"
    if arm.accuracy is not None and arm.pen.clearance_mm == usual_clearance_mm(arm):
        yield (
            f"the pen is clear of the paper at {arm.pen.clearance_mm:g} mm, by what this arm's height is expected to be"
            f" off by: {arm.accuracy.height_mm:.2g} mm"
        )
    every = samples_a_set_point(trajectory.rate_hz, arm.set_point_period_s)
    cut_mm, _ = cut_corners_mm(tip_mm, trajectory.pen, every)
    if cut_mm > tolerance_mm:
        yield (
            f"the servos take a set point every {1e3 * (arm.set_point_period_s or 0.0):g} ms, one of {every} samples:"
            f" what they see cuts up to {cut_mm:.2g} mm off the path; a lower --rate or --speed cuts less"
        )
