"""The whole story on one page: an SVG becomes strokes, pen paths, joint paths, and a trajectory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import partial
from itertools import chain

import numpy as np

from planner.account import account_of
from planner.affine import scale_of
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
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
from planner.placement.place import Placed, placed
from planner.progress import Report, unreported
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings
from planner.summary import PlanSummary
from planner.trajectory import TRAVELLING, Trajectory
from planner.workspace.canvas import canvas_of

_SMALL_BYTES = 60_000
"""Drawings in shorter files, of a few thousand points, are done sooner than worker processes have started."""


@dataclass(frozen=True, eq=False, slots=True)
class Plan:
    """drawing: what was planned, as it was read. by_pen: a trajectory for each pen, which draws what it draws."""

    trajectory: Trajectory
    summary: PlanSummary
    drawing: Drawing
    by_pen: tuple[Trajectory, ...] = ()


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
    lift_mm(arm, settings)  # said before the work begins
    with executor_of(_worth_hiring(workers, drawing_file), context.make_ready) as executor:
        drawing = read_drawing(drawing_file, partial(report, "reading"), options=settings.reading)
        place, drawings = _ordered(drawing, context, report)
        require_bounded_whole(drawings)
        drawings = _through(executor, drawings, PenDrawing.move, "within the joint limits", report)
        drawings = _through(executor, drawings, PenDrawing.travel, "with the arm's links apart", report)
    samples = assembled(drawings)
    left_out = sum((one.left_out for one in drawings), LeftOut())
    (a, c, e), (b, d, f) = place.svg_to_arm.tolist()
    trajectory = Trajectory(
        arm=settings.arm,
        drawing=drawing_file.name,
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
        path_work=PathWork(settings.join_mm, settings.dedup_mm, settings.simplify_mm, settings.passes),
    )
    verify(trajectory, arm)
    by = settings.pens_by
    by_pen = tuple(
        trajectory.part(first, last, pen, Chosen(settings.layers, by, kinds))
        for pen, (first, last), kinds in zip(samples.pens, samples.parts, samples.kinds, strict=False)
    )
    return Plan(trajectory, _summary(trajectory, model, drawings, place), drawing, by_pen)


def placed_strokes(
    drawing_file: DrawingSource, model: ArmModel, settings: PlanSettings
) -> tuple[list[FloatArray], list[str]]:
    """Strokes (n, 2) in arm mm, placed and in the order that they are planned in, and what was left out on the way.
    Errors: PlannerError."""
    place, drawings = _ordered(
        read_drawing(drawing_file, options=settings.reading), PlanContext(model, settings), unreported
    )
    return list(chain.from_iterable(one.strokes for one in drawings)), _told(place.drawing, drawings)


def _ordered(drawing: Drawing, context: PlanContext, report: Report) -> tuple[Placed, list[PenDrawing]]:
    """Where the drawing goes, and what each pen draws, in the order in which it does. Errors: PlannerError."""
    model, settings = context.model, context.settings
    report("placing", 0, 1)
    canvas = canvas_of(model, settings.canvas, lift_mm(model.arm, settings))
    place = placed(drawing, canvas, settings)
    chosen = chosen_layers(place.drawing, settings.layers)
    place = replace(place, drawing=chosen)
    mm_per_unit = scale_of(place.svg_to_arm)
    report("joining", 0, 1)
    own_mm_s = pen_speed_mm_s(model.arm, settings)
    drawings = []
    models = {0.0: model}  # by how far the tip of a pen sticks out
    start_mm = canvas.to_arm_mm(np.zeros(2))
    for group in pen_groups(chosen, settings.pens_by, settings.pens, mm_per_unit):
        of_pen = settings.with_pen(group.pen, own_mm_s, group.speed_share) if group.is_named else settings
        height_mm = group.pen.height_mm
        if height_mm not in models:
            models[height_mm] = ArmModel(model.arm.holding(height_mm))
        is_usual = of_pen == settings and not height_mm
        one = PenDrawing(group, context if is_usual else PlanContext(models[height_mm], of_pen))
        one.order(place.svg_to_arm, start_mm)
        report("ordering strokes", 0, 1)
        if one.strokes:
            drawings.append(one)
            start_mm = one.strokes[-1][-1]
    if not drawings:
        raise PlanError("nothing of the drawing is within reach")
    return place, drawings


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
    left = [one for one in drawings if one.strokes]
    if not left:
        raise PlanError(f"nothing of the drawing can be drawn {how}")
    lost = [one for one in drawings if not one.strokes]
    for one in lost:
        left[0].left_out += one.left_out
        left[0].notes += one.notes
    return left


def _told(drawing: Drawing, drawings: Sequence[PenDrawing]) -> list[str]:
    """What is to be said of the drawing, and of what each pen draws of it."""
    notes = drawing.notes()
    if len(drawings) == 1:
        return notes + drawings[0].notes
    return notes + [f"{one.group.pen.name}: {note}" for one in drawings for note in one.notes]


def _worth_hiring(workers: Workers, drawing_file: DrawingSource) -> Workers:
    """The workers, or none beside this process where a drawing is too small for them."""
    try:
        n_bytes = len(drawing_file.content) if isinstance(drawing_file, SvgInMemory) else drawing_file.stat().st_size
    except (OSError, ValueError):  # its reader says what is wrong with it
        return ALONE
    return ALONE if n_bytes < _SMALL_BYTES and workers.cluster is None else workers


def _summary(trajectory: Trajectory, model: ArmModel, drawings: Sequence[PenDrawing], place: Placed) -> PlanSummary:
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
        warnings=_told(place.drawing, drawings),
        where=place.board.where(),
        hints=place.notes,
        pens=tuple(pen.name for pen in trajectory.pens),
    )
