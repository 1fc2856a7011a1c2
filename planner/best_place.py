"""Where on the paper a drawing is drawn soonest and most accurately.

What a place is worth is measured: a sample of the strokes is planned there, and the arm's error model says how far off
its lines are going to be. Times and errors count alike, as ratios to those where the page puts it. That is done for a
few places alone, the best by a coarse estimate of all: the joints' way along the strokes and between them, and how far
the tip strays where a joint runs late or stands wrong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from planner.arms.arm import Arm
from planner.arms.slack import leads_s
from planner.arrays import FloatArray, IntArray
from planner.assembly import assembled
from planner.counted import counted
from planner.drawing.drawing import Outline
from planner.errors import ArmFileError, PlanError
from planner.execution.context import PlanContext
from planner.execution.workers import ChunkExecutor
from planner.kinematics.sensitivity import tip_sensitivity
from planner.motion.speed_limit import pen_speed_mm_s
from planner.pen_drawing import PenDrawing
from planner.placement.clip import densified
from planner.placement.motions import Motion, motions
from planner.placement.place import Placed
from planner.polyline_length import polyline_length
from planner.progress import Report, unreported
from planner.ragged import starts_of
from planner.redundancy.configuration_map import branch_references
from planner.settings import CanvasKind

_MEASURED = 4
"""Places that are measured beside that of the page."""
_SAMPLE_MM, _SAMPLE_STROKES = 600.0, 60
"""About how much of a drawing is planned at each."""
_STEP_MM, _POINTS = 2.0, 600
"""From point to point of the coarse estimate, and about how many there are."""
_WORTH = 0.99
"""Of the page's measure, what another place has to be below."""
_AT_REST = 2.5
"""As in the cost of configurations: a joint at rest is off by as much as one is late that turns so many radians on the
way of the arm's reach."""


@dataclass(frozen=True, slots=True)
class Measured:
    """What the sample takes, and how far off its lines are expected, rms; None where the arm's file does not say how
    its joints are moved."""

    duration_s: float
    off_mm: float | None

    def against(self, other: Measured) -> float:
        """The mean ratio to another; below 1 where this is better."""
        ratio = self.duration_s / other.duration_s
        return ratio if self.off_mm is None or not other.off_mm else float(np.sqrt(ratio * self.off_mm / other.off_mm))


@dataclass(frozen=True, eq=False, slots=True)
class BestPlace:
    """motion: from where the page puts the drawing; None: it stays. told: what that wins, in words. page, best: what
    was measured at both; page None where it is out of reach there."""

    motion: Motion | None
    told: str
    page: Measured | None
    best: Measured | None


def best_place(
    executor: ChunkExecutor,
    context: PlanContext,
    outlines: Sequence[Outline],
    place: Placed,
    pens: Sequence[PenDrawing],
    report: Report,
) -> BestPlace:
    """The best place for what the pens draw. outlines: what has to stay within the room. place, pens: as the page puts
    it, which may be out of reach."""
    sample, is_all = _sample(pens)
    candidates = motions(outlines, place.svg_to_arm, place.board)
    strokes = [stroke for one in sample for stroke in one.strokes]
    worth = _coarse(context, strokes, candidates)
    by_worth = (candidates[index] for index in np.argsort(worth, kind="stable").tolist())
    few = list(islice((motion for motion in by_worth if _is_reached(context, pens, motion)), _MEASURED))
    is_there = place.told.canvas_mm is not None
    page = _measured(executor, context, place, sample, None) if is_there else None
    best: tuple[Motion | None, Measured | None] = (None, page)
    for index, motion in enumerate(few):
        report("placing", index, len(few))
        found = _measured(executor, context, place, sample, motion)
        least = best[1]
        if found is not None and (least is None or found.against(least) < (_WORTH if best[0] is None else 1.0)):
            best = motion, found
    motion, measured = best
    return BestPlace(motion, _told(motion, page, measured, len(candidates), is_all), page, measured)


def _told(motion: Motion | None, page: Measured | None, best: Measured | None, n_places: int, is_all: bool) -> str:
    if motion is None:
        return f"best place: where the page puts it; none of {counted(n_places, 'other')} is better"
    turn_deg = (motion.turn_deg + 180.0) % 360.0 - 180.0
    moved = [f"moved by {motion.moved_mm:.0f} mm"] if motion.moved_mm >= 0.5 else []
    way = " and ".join([*moved, *([f"turned by {turn_deg:g} degrees"] if turn_deg else [])])
    if page is None or best is None:
        return f"best place: {way}; where the page puts it, it is out of reach"
    percent = round(100.0 * (1.0 - best.duration_s / page.duration_s))
    won = f"{percent} % faster" if percent > 0 else f"{-percent} % slower" if percent else "as fast"
    if best.off_mm is not None and page.off_mm is not None:
        won += f", predicted {best.off_mm:.3g} instead of {page.off_mm:.3g} mm off its lines"
    return f"best place: {way}, it draws {won}" + ("" if is_all else " (by a sample of its strokes)")


def _is_reached(context: PlanContext, pens: Sequence[PenDrawing], motion: Motion) -> bool:
    """Whether the arm reaches all of the drawing there, as it does in a canvas that is made of what it reaches."""
    if context.settings.canvas is CanvasKind.USABLE:
        return True
    branches = context.model.branches(context.settings.weights)
    points = _moved(np.concatenate([densified(stroke) for one in pens for stroke in one.strokes]), motion)
    return bool(np.any([branch.reaches(points) for branch in branches], axis=0).all())


def _sample(pens: Sequence[PenDrawing]) -> tuple[list[PenDrawing], bool]:
    """Some strokes of each pen, evenly chosen, long ones cut off; and whether that is all of them."""
    strokes = [stroke for one in pens for stroke in one.strokes]
    length_mm = sum(map(polyline_length, strokes))
    if length_mm <= _SAMPLE_MM and len(strokes) <= _SAMPLE_STROKES:
        return [_with_strokes(one, one.strokes) for one in pens if one.strokes], True
    every = max(int(np.ceil(len(strokes) / _SAMPLE_STROKES)), 1)
    some = [(one, one.strokes[::every]) for one in pens if one.strokes]
    n_strokes = sum(len(chosen) for _, chosen in some)
    most_mm = _SAMPLE_MM / n_strokes
    return [_with_strokes(one, [_start_of(stroke, most_mm) for stroke in chosen]) for one, chosen in some], False


def _with_strokes(one: PenDrawing, strokes: Sequence[FloatArray]) -> PenDrawing:
    """The same pen before it has drawn anything, with these strokes."""
    return PenDrawing(one.group, one.context, list(strokes))


def _start_of(stroke: FloatArray, length_mm: float) -> FloatArray:
    """The points of a stroke up to that length, and no fewer than two of a line."""
    along = np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))
    return stroke[: max(int(np.searchsorted(along, length_mm)) + 1, 2)]


def _coarse(context: PlanContext, strokes: Sequence[FloatArray], candidates: Sequence[Motion]) -> FloatArray:
    """(n,) what places are worth by a coarse estimate: the logarithm of time and error, less is better; of time alone
    where nothing is known of how joints are moved."""
    model, settings = context.model, context.settings
    arm, branches = model.arm, model.branches(settings.weights)
    speed_mm_s = pen_speed_mm_s(arm, settings)
    points, starts = _evenly(strokes)
    steps_mm = np.hypot(*np.diff(points, axis=0).T)
    is_drawn = np.ones(len(points) - 1, dtype=bool)
    is_drawn[starts[1:] - 1] = False
    reach_mm = float(np.abs(branches[0].box_mm).max())
    errs = all(joint.servo or joint.bus for joint in arm.joints)
    found = np.empty(len(candidates))
    for index, motion in enumerate(candidates):
        tips = np.column_stack((_moved(points, motion), np.zeros(len(points))))
        joints = arm.complete(branch_references(branches, tips, starts))
        change = np.abs(np.diff(joints, axis=0))
        quickest_s = (change / arm.max_velocity).max(axis=1, initial=0.0)
        travel_s = np.cbrt(32.0 * change / arm.max_jerk).max(axis=1, initial=0.0)
        time_s = np.where(is_drawn, np.maximum(steps_mm / speed_mm_s, quickest_s), travel_s).sum()
        found[index] = np.log(max(time_s, 1e-9))
        if not errs:
            continue
        squares = (tip_sensitivity(arm, joints)[:, :2] ** 2).sum(axis=1)
        slope = change / arm.per_file_unit * np.radians(1.0) / np.maximum(steps_mm, 1e-9)[:, None]
        late = np.where(is_drawn[:, None], slope * reach_mm / _AT_REST, 0.0)
        error = (squares[:-1] * (1.0 + late**2)).sum(axis=1).mean() if len(change) else squares.sum()
        found[index] += 0.5 * np.log(max(error, 1e-300))
    return found


def _evenly(strokes: Sequence[FloatArray]) -> tuple[FloatArray, IntArray]:
    """Points (n, 2) evenly along strokes, both ends of each among them, and the first of each stroke."""
    lengths = [polyline_length(stroke) if len(stroke) > 1 else 0.0 for stroke in strokes]
    step_mm = max(_STEP_MM, sum(lengths) / _POINTS)
    parts = []
    for stroke, length_mm in zip(strokes, lengths, strict=True):
        along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))))
        at = np.linspace(0.0, length_mm, int(np.ceil(length_mm / step_mm)) + 1)
        parts.append(np.column_stack([np.interp(at, along, column) for column in stroke.T]))
    return np.concatenate(parts), starts_of(np.array([len(part) for part in parts]))[:-1]


def _moved(points: FloatArray, motion: Motion) -> FloatArray:
    moved: FloatArray = points @ motion.matrix[:, :2].T + motion.matrix[:, 2]
    return moved


def _measured(
    executor: ChunkExecutor,
    context: PlanContext,
    place: Placed,
    sample: Sequence[PenDrawing],
    motion: Motion | None,
) -> Measured | None:
    """What the sample is like after a motion; None where it cannot be drawn there."""
    start_mm = place.canvas.to_arm_mm(np.zeros(2))
    drawings = []
    try:
        for one in sample:
            strokes = one.strokes if motion is None else [_moved(stroke, motion) for stroke in one.strokes]
            drawing = _with_strokes(one, strokes)
            drawing.order(start_mm)
            drawing.move(executor, unreported, 0)
            drawing.travel(executor, unreported, 0)
            if drawing.strokes:
                drawings.append(drawing)
                start_mm = drawing.strokes[-1][-1]
        if not drawings:
            return None
        samples = assembled(drawings)
    except PlanError:
        return None
    arm, rate_hz = context.model.arm, context.settings.rate_hz
    positions = arm.from_file_units(samples.positions)
    return Measured(len(positions) / rate_hz, _off_mm(arm, positions, samples.stroke, rate_hz))


def _off_mm(arm: Arm, meant: FloatArray, stroke: IntArray, rate_hz: float) -> float | None:
    """What is expected of the arm where its lag is led and what slack is known of is taken up, as when it is played."""
    rows = np.arange(len(meant))
    lead = leads_s(arm, 1.0 / rate_hz) * rate_hz
    sent = np.column_stack([np.interp(rows + lead[k], rows, meant[:, k]) for k in range(meant.shape[1])])
    try:
        from planner.error_model.prediction import Played, expected_rms_mm  # heavy, and few ask for a best place

        return expected_rms_mm(_without_slack(arm), Played(sent, meant, stroke, rate_hz))
    except ArmFileError:
        return None


def _without_slack(arm: Arm) -> Arm:
    joints = []
    for joint in arm.joints:
        servo = joint.servo and replace(joint.servo, backlash=0.0, dead_band_us=0.0)
        bus = joint.bus and replace(joint.bus, backlash=0.0, dead_band_counts=0.0)
        joints.append(replace(joint, servo=servo, bus=bus))
    return replace(arm, joints=tuple(joints))
