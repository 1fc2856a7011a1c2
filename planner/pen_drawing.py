"""What one pen draws, station by station: strokes in their order, their motions, and the travel moves between them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, islice

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.counted import counted
from planner.drawing.flatten import flatten_all
from planner.drawing.ink import Ink
from planner.drawing.join import join_strokes
from planner.drawing.loops import with_loops
from planner.drawing.metric import Metric
from planner.drawing.order import ordered
from planner.drawing.over_lines import Leaps, join_over_lines
from planner.drawing.path_work import longer, repeated, simplified, without_doubles
from planner.drawing.pen_groups import PenGroup
from planner.errors import LinksCollide, PlanError, TargetOutOfReach, UsageError
from planner.execution.context import PlanContext
from planner.execution.work_chunks import (
    may_be_cut,
    pieces_of,
    planned_travel_moves,
    stroke_chunks,
    timed_strokes,
    travel_chunks,
)
from planner.execution.workers import ChunkExecutor
from planner.head import LeftOut
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath
from planner.motion.crossed_gaps import Gaps, left_open
from planner.motion.speed_limit import pen_speed_mm_s
from planner.motion.timed_stroke import TimedStroke
from planner.motion.tolerance import FLATTEN_SHARE, JOIN_SHARE, NARROW_SHARE, ON_LINE_SHARE
from planner.placement.clip import clip_strokes
from planner.placement.pieces import Piece, halves
from planner.placement.short_gaps import SHORTEST_GAP_MM, gaps_to_draw
from planner.placement.split import split_strokes
from planner.polyline_length import polyline_length
from planner.progress import Report
from planner.redundancy.arm_model import ArmModel
from planner.redundancy.configuration_map import ConfigurationMap
from planner.settings import Method, PlanSettings
from planner.timing.length_bound import require_bounded
from planner.travel.travel_moves import TravelMove, TravelRules
from planner.travel.travel_time_metric import travel_time_metric

_MANY_CHUNKS, _FORETELLING = 200, 8
"""Work chunks from which on some are timed beforehand, and how many of them."""
_HALVINGS = 4
"""How often a stroke that is not held is cut further."""
_TOO_MUCH = "draw less of it, or choose a lower --rate"


@dataclass(eq=False, slots=True)
class PenDrawing:
    """One pen's part of a plan, filled station by station.

    strokes: (n, 2) each, arm mm, in the order in which they are drawn; timed: their motions; moves: the travel moves
    before, between and after them, from rest and to rest in the air. dropped: strokes that are left out on purpose.
    gaps: those that may be crossed, unless the user said so. left_out: what was dropped, and what could not be drawn.
    notes: what to say of it.
    """

    group: PenGroup
    context: PlanContext
    strokes: list[FloatArray] = field(default_factory=list)
    timed: list[TimedStroke] = field(default_factory=list)
    moves: list[TravelMove] = field(default_factory=list)
    dropped: list[FloatArray] = field(default_factory=list)
    gaps: Gaps | None = None
    left_out: LeftOut = field(default_factory=LeftOut)
    notes: list[str] = field(default_factory=list)

    @property
    def lift_mm(self) -> float:
        """How high the pen travels. Errors: UsageError where that is below the clearance."""
        return lift_mm(self.context.model.arm, self.context.settings)

    @property
    def rules(self) -> TravelRules:
        settings = self.context.settings
        return TravelRules(
            self.context.model.arm.pen.clearance_mm,
            self.lift_mm,
            settings.lowering_speed_mm_s,
            settings.rate_hz,
            settings.tolerance_mm,
            settings.timing,
        )

    def take(self, svg_to_arm: FloatArray) -> None:
        """Strokes from the outlines where `svg_to_arm` (2, 3) puts them, as their lines are wanted. Errors: PlanError,
        UsageError."""
        self.strokes, self.gaps, self.dropped, self.notes = _strokes(self.group, svg_to_arm, self.context.settings)

    def order(self, start_mm: FloatArray) -> None:
        """What of the strokes the arm reaches, in its order from `start_mm` (2,) on. Errors: PlanError."""
        model, settings = self.context.model, self.context.settings
        self._lose(_drawn(self.dropped), [])
        self.strokes, lost, notes = _within_reach(repeated(self.strokes, settings.passes), model, settings)
        self._lose(lost, notes)
        if settings.keep_order or settings.reverse:
            if settings.reverse:
                self.strokes = [stroke[::-1] for stroke in reversed(self.strokes)]
            return
        metric = Metric(travel_time_metric(model), exponent=1 / 3)
        self.strokes, is_finished = ordered(self.strokes, start_mm, metric)
        if not is_finished:
            n = len(self.strokes)
            self.notes.append(f"a shorter way between the strokes may be left: {n} are too many to search to the end")

    def move(self, executor: ChunkExecutor, report: Report, first: int) -> None:
        """The strokes' motions; `first` is the number of the first of them. Errors: PlanError, UsageError."""
        self.timed, self.strokes, lost, notes = _timed_strokes(executor, self.context, self.strokes, report, first)
        self._lose(lost, notes)
        while self.gaps is not None:
            parts = _left_open(self.context, self.gaps, self.strokes, self.timed)
            again = [part for some in parts if len(some) > 1 for part in some]
            if not again:
                break
            made, drawn, lost, notes = _timed_strokes(executor, self.context, again, report, first)
            self._lose(lost, notes)
            anew = {part.tobytes(): stroke for part, stroke in zip(drawn, made, strict=True)}
            whole = [
                (part, anew.get(part.tobytes()) if len(some) > 1 else stroke)
                for some, stroke in zip(parts, self.timed, strict=True)
                for part in some
            ]
            self.strokes = [part for part, stroke in whole if stroke is not None]
            self.timed = [stroke for _, stroke in whole if stroke is not None]

    def travel(self, executor: ChunkExecutor, report: Report, first: int) -> None:
        """The travel moves. Errors: PlanError."""
        self.timed, self.strokes, self.moves, lost, notes = _with_travel_moves(executor, self, report, first)
        self._lose(lost, notes)

    def _lose(self, lost: LeftOut, notes: list[str]) -> None:
        self.left_out += lost
        self.notes += notes


def lift_mm(arm: Arm, settings: PlanSettings) -> float:
    """How high the pen travels. Errors: UsageError where that is below the clearance."""
    height_mm = arm.pen.lift_mm if settings.lift_mm is None else settings.lift_mm
    if height_mm < arm.pen.clearance_mm:
        raise UsageError(f"a lift of {height_mm:g} mm is below the arm's pen clearance of {arm.pen.clearance_mm:g} mm")
    return height_mm


def require_bounded_whole(drawings: Sequence[PenDrawing]) -> None:
    """Errors: UsageError where speeds and rests alone, whatever the arm, make a plan too long."""
    rate_hz = drawings[0].context.settings.rate_hz
    seconds = np.zeros(3)
    for drawing in drawings:
        arm, settings = drawing.context.model.arm, drawing.context.settings
        drawn_mm = sum(map(polyline_length, drawing.strokes))
        n_strokes = len(drawing.strokes)
        lowered_mm = n_strokes * arm.pen.clearance_mm + drawing.lift_mm
        seconds += (
            drawn_mm / pen_speed_mm_s(arm, settings),
            lowered_mm / settings.lowering_speed_mm_s,
            n_strokes * settings.dwell_s,
        )
    parts = [
        ("drawing", "choose a higher --speed"),
        ("lowering the pen", "choose a higher --lowering-speed"),
        ("resting before strokes", "choose a shorter --dwell"),
    ]
    longest = int(np.argmax(seconds))
    what, advice = parts[longest]
    require_bounded(float(seconds[longest]), rate_hz, what, f"{advice}, or a lower --rate")
    require_bounded(float(seconds.sum()), rate_hz, "the plan", f"{advice}, or a lower --rate")


def _strokes(
    group: PenGroup, svg_to_arm: FloatArray, settings: PlanSettings
) -> tuple[list[FloatArray], Gaps | None, list[FloatArray], list[str]]:
    """Strokes (n, 2), arm mm, the gaps that they may cross if not asked to, those that are too short to be drawn, and
    what is to be said of them."""
    warnings: list[str] = []
    gaps: Gaps | None = None
    short: list[FloatArray] = []
    short_gaps = gaps_to_draw(group.outlines, svg_to_arm)
    if short_gaps:
        warnings.append(f"gaps of dashes under {SHORTEST_GAP_MM:g} mm on paper, drawn solid: {len(short_gaps)}")
    strokes = flatten_all([*group.outlines, *short_gaps], svg_to_arm, FLATTEN_SHARE * settings.tolerance_mm)
    if settings.dedup_mm:
        strokes, doubled_mm = without_doubles(strokes, settings.dedup_mm)
        if doubled_mm:
            warnings.append(f"drawn once, though the drawing has it more than once: {doubled_mm:.1f} mm of line")
    if not (settings.keep_order or settings.reverse):
        usual = _joined(strokes, None, settings.tolerance_mm)
        if settings.join_mm is None:
            gaps = Gaps(strokes) if len(usual) < len(strokes) else None
            strokes = usual
        else:
            strokes = _joined(strokes, settings.join_mm, settings.tolerance_mm)
            usual_mm = JOIN_SHARE * settings.tolerance_mm
            if settings.join_mm > usual_mm and len(strokes) < len(usual):
                warnings.append(
                    f"gaps of up to {settings.join_mm:g} mm drawn across as asked, which saves"
                    f" {counted(len(usual) - len(strokes), 'pen lift')}; {usual_mm:g} mm is within the tolerance"
                )
    if settings.simplify_mm:
        strokes = simplified(strokes, settings.simplify_mm)
    if settings.min_length_mm:
        strokes, short = longer(strokes, settings.min_length_mm)
        if short:
            warnings.append(f"shorter than {settings.min_length_mm:g} mm and left out: {counted(len(short), 'stroke')}")
    return strokes, gaps, short, warnings


def _joined(strokes: list[FloatArray], join_mm: float | None, tolerance_mm: float) -> list[FloatArray]:
    """Strokes (n, 2) joined over gaps of up to `join_mm`, between ends and to the middles of lines. None: as is usual,
    where the header tells of no gap. So what the pen draws across has to be within the tolerance, and only gaps between
    ends are looked at again once the motion is known."""
    narrow_mm = NARROW_SHARE * tolerance_mm if join_mm is None else join_mm
    wide_mm = JOIN_SHARE * tolerance_mm if join_mm is None else join_mm
    leaps = Leaps(wide_mm, narrow_mm, ON_LINE_SHARE * tolerance_mm)
    ink = Ink(strokes, NARROW_SHARE * tolerance_mm)
    return with_loops(join_over_lines(join_strokes(strokes, wide_mm), ink, leaps), ink, narrow_mm)


def _within_reach(
    strokes: list[FloatArray], model: ArmModel, settings: PlanSettings
) -> tuple[list[FloatArray], LeftOut, list[str]]:
    """What of strokes (n, 2) the arm reaches, if nothing else is wanted, in pieces that each lie in one branch; what
    that leaves out, and what is to be said of it."""
    warnings: list[str] = []
    lost = LeftOut()
    branches = model.branches(settings.weights)
    if settings.skip_unreachable:
        n_taps = _drawn(strokes).taps
        strokes, lost_mm, lost_whole = clip_strokes(
            strokes, _in_reach(branches), max(float(np.abs(branch.box_mm).max()) for branch in branches)
        )
        lost = LeftOut(lost_mm, n_taps - _drawn(strokes).taps)
        if lost_mm or lost_whole:
            whole = counted(lost_whole - lost.taps, "stroke") + " and " + counted(lost.taps, "tap")
            warnings.append(f"out of reach and left out: {lost_mm:.1f} mm of line; {whole} whole")
    if len(branches) > 1 and settings.method is Method.PATH:
        strokes, n_split, n_more = split_strokes(strokes, [branch.reaches for branch in branches])
        if n_split:
            warnings.append(
                f"split, as no one branch reaches all of each: {counted(n_split, 'stroke')},"
                f" with {counted(n_more, 'more pen lift')}"
            )
    return strokes, lost, warnings


def _drawn(strokes: Sequence[FloatArray]) -> LeftOut:
    """How much strokes are: what is left out without them."""
    lengths = [polyline_length(stroke) for stroke in strokes if len(stroke) > 1]
    return LeftOut(sum(lengths), len(strokes) - len(lengths))


def _in_reach(branches: Sequence[ConfigurationMap]) -> Callable[[FloatArray], BoolArray]:
    def reachable(points_mm: FloatArray) -> BoolArray:
        reached: BoolArray = np.any([branch.reaches(points_mm) for branch in branches], axis=0)
        return reached

    return reachable


def _left_open(
    context: PlanContext, gaps: Gaps, strokes: Sequence[FloatArray], timed: Sequence[TimedStroke]
) -> list[list[FloatArray]]:
    """The parts of each stroke between gaps that its motion does not cross within the tolerance."""
    kinematics, tolerance_mm = context.model.kinematics, context.settings.tolerance_mm
    return [
        left_open(kinematics, gaps, stroke, motion.joints, tolerance_mm)
        for stroke, motion in zip(strokes, timed, strict=True)
    ]


def _timed_strokes(
    executor: ChunkExecutor, context: PlanContext, strokes: Sequence[FloatArray], report: Report, first: int
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
            path = infeasible_paths[0]
            nearest = int(np.argmin(np.hypot(*(stroke - path.tip_mm).T)))
            raise TargetOutOfReach(first + index, nearest, path.tip_mm, path.reason, path.joint, path.limit)
    timed = _held_in_pieces(executor, context, kept, timed)
    unconverged = sum(not stroke.converged for stroke in timed)
    loose = sum(not stroke.held for stroke in timed)
    counts = [
        (len(lost), f"left out whole, as method {settings.method} cannot draw them"),
        (unconverged, "timed by the fallback, slower than the least time"),
        (loose, "off the drawing by more than the tolerance, however slow; try a larger --tolerance"),
    ]
    return timed, kept, _drawn(lost), [f"{what}: {counted(count, 'stroke')}" for count, what in counts if count]


def _held_in_pieces(
    executor: ChunkExecutor, context: PlanContext, strokes: Sequence[FloatArray], timed: Sequence[TimedStroke]
) -> list[TimedStroke]:
    """The motions of strokes, of which those that no speed keeps within the tolerance are made in ever smaller pieces,
    with a rest on the paper between them."""
    found = list(timed)
    if not may_be_cut(context):
        return found
    pieces = {index: pieces_of(context, [strokes[index]])[0] for index, motion in enumerate(found) if not motion.held}
    for _ in range(_HALVINGS):
        pieces = {index: halves(some) for index, some in pieces.items() if not found[index].held}
        if not pieces:
            break
        together = list(chain.from_iterable(pieces.values()))
        results = chain.from_iterable(executor(timed_strokes, stroke_chunks(context, together)))
        for index, some in pieces.items():
            made = [result for result in islice(results, len(some)) if isinstance(result, TimedStroke)]
            if len(made) == len(some):
                found[index] = TimedStroke.of(made)
    return found


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
    executor: ChunkExecutor, drawing: PenDrawing, report: Report, first: int
) -> tuple[list[TimedStroke], list[FloatArray], list[TravelMove], LeftOut, list[str]]:
    """The strokes, the travel moves around them, and what is to be said of them. Strokes that the arm cannot get to, or
    away from, with its links apart are left out if the user wants so."""
    context, timed, strokes = drawing.context, drawing.timed, drawing.strokes
    lost: list[FloatArray] = []
    while True:
        moves = _travel_moves(executor, context, drawing.rules, timed, report, first)
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
            raise LinksCollide(first + index, collision.links, collision.clearance_mm, str(collision))
        lost += [strokes[index] for index in sorted(blocked)]
        free = [index for index in range(len(timed)) if index not in blocked]
        timed, strokes = [timed[index] for index in free], [strokes[index] for index in free]
        if not timed:
            return timed, strokes, [], _drawn(lost), ["links would collide before or after every stroke"]


def _end_that_collides(index: int, move: TravelMove, n_strokes: int) -> int:
    """The stroke, before or after the travel move of that index, that is nearer in time to where links collide."""
    leaves = move.collision is not None and 2 * move.collision.configuration < len(move.joints)
    return max(index - 1, 0) if leaves or index == n_strokes else index


def _travel_moves(
    executor: ChunkExecutor,
    context: PlanContext,
    rules: TravelRules,
    timed: Sequence[TimedStroke],
    report: Report,
    first: int,
) -> list[TravelMove]:
    """The pen-up moves before, between and after the strokes."""
    starts = [None, *(stroke.last for stroke in timed)]
    ends = [*(stroke.first for stroke in timed), None]
    moves: list[TravelMove] = []
    for made in executor(planned_travel_moves, travel_chunks(context, rules, starts, ends)):
        for index, move in enumerate(made, len(moves)):
            if not move.exact:
                raise PlanError(
                    f"the pen-up move before stroke {first + index} leaves the joint limits"
                    f" of arm {context.model.arm.name}; try another --method, a smaller --lift or a larger --margin"
                )
        moves += made
        report("travels", len(moves), len(starts))
    return moves
