"""The parts of a plan that are made apart from each other: neighbouring strokes in time, and travel moves between them.

A work chunk says all that is needed to make it, so that any process can.
"""

from __future__ import annotations

import pickle
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import JointPaths
from planner.inverse_kinematics.stroke_configurations import (
    InfeasiblePath,
    colliding_paths,
    configurations_at,
    exact_configurations,
    joint_paths,
    strays_mm,
)
from planner.kinematics.chain import kinematics_of
from planner.kinematics.link_clearance import link_clearance
from planner.motion.chord_error_limit import chord_error_limit
from planner.motion.held_motion import timed_within
from planner.motion.speed_limit import rate_limit
from planner.placement.pen_path import PenPaths, smoothed
from planner.placement.pieces import Piece, in_pieces
from planner.redundancy.configuration_map import configuration_branches, configuration_map_of
from planner.settings import Method, PlanSettings
from planner.timing.limits import Limits
from planner.timing.timing_problem import FRACTIONS
from planner.travel.branch_change import keeps_branch, plan_branch_change
from planner.travel.travel_moves import (
    Contact,
    TravelMove,
    TravelRules,
    plan_travel_moves,
    require_bounded_travel_moves,
)

SMOOTH_SHARE, SAMPLE_SHARE, CHORD_SHARE = 0.5, 0.4, 0.04
"""Shares of the tolerance: rounded corners, straight lines between samples, and what the tip strays from these because
it is the joints that move straight."""
_SPLINE_SHARE = 0.04
"""Share of the tolerance that the joints' splines may stray between their knots before there are more of them."""

_CHUNK_WORK = 4000.0
_LEAST_WORK = 10.0
"""What a stroke of no length costs at least."""
_CHUNK_MOVES = 125
_TIMING_SUBDIVISIONS = 1
"""How often the cells of a path are cut in two before it is timed: jerk switches at cell ends only, and cells as
long as the corners that they go round are too coarse for that."""
_TAP_S = 0.05
"""How long a tap rests on the paper at least: a pen needs a moment to leave a dot."""


@dataclass(frozen=True, eq=False, slots=True)
class TimedStroke:
    """A stroke ready to be drawn: joint samples (n, n_joints) and where it touches down and lifts off.

    converged: whether its timing is near the least time, rather than the fallback. held: whether the pen stays within
    the tolerance of the drawing, between its samples as well.
    """

    joints: FloatArray
    first: Contact
    last: Contact
    dwell_samples: int
    converged: bool = True
    held: bool = True

    @staticmethod
    def of(pieces: Sequence[TimedStroke]) -> TimedStroke:
        """One stroke of pieces that each begin at rest where the one before ended."""
        if len(pieces) == 1:
            return pieces[0]
        joints = np.concatenate([pieces[0].joints, *(piece.joints[1:] for piece in pieces[1:])])
        return TimedStroke(
            joints,
            pieces[0].first,
            pieces[-1].last,
            pieces[0].dwell_samples,
            all(piece.converged for piece in pieces),
            all(piece.held for piece in pieces),
        )


@dataclass(frozen=True, slots=True)
class PlanContext:
    """What every work chunk of a plan needs: the arm, pickled, so that a process builds its models of it once, and the
    settings."""

    pickled_arm: bytes
    settings: PlanSettings

    @staticmethod
    def of(arm: Arm, settings: PlanSettings) -> PlanContext:
        return PlanContext(pickle.dumps(arm), settings)

    @property
    def arm(self) -> Arm:
        return _unpickled(self.pickled_arm)


@lru_cache(maxsize=4)
def _unpickled(pickled_arm: bytes) -> Arm:
    arm: Arm = pickle.loads(pickled_arm)  # noqa: S301  # pickled by `PlanContext.of`, never read from a file
    return arm


@dataclass(frozen=True, eq=False, slots=True)
class StrokeChunk:
    """Neighbouring strokes (n, 2), arm mm, or pieces of them."""

    context: PlanContext
    strokes: Sequence[FloatArray]


@dataclass(frozen=True, eq=False, slots=True)
class TravelChunk:
    """Neighbouring travel moves: where each starts and ends on the paper, None at the ends of the drawing."""

    context: PlanContext
    rules: TravelRules
    start: Sequence[Contact | None]
    end: Sequence[Contact | None]


def pieces_of(context: PlanContext, strokes: Sequence[FloatArray]) -> list[list[Piece]]:
    """What may be timed apart, stroke by stroke. Methods that go from configuration to configuration need strokes
    whole, and so does an arm that has to choose a branch for each."""
    settings = context.settings
    whole = settings.method in (Method.DLS, Method.NLP) or (
        settings.method is Method.PATH and len(configuration_branches(context.arm, settings.weights)) > 1
    )
    return list(in_pieces(strokes, SMOOTH_SHARE * settings.tolerance_mm, whole=whole))


def stroke_chunks(context: PlanContext, pieces: Sequence[Piece]) -> Iterator[StrokeChunk]:
    """Pieces put together to work chunks of bounded size: by the drawing alone, never by who makes them."""
    first, work = 0, 0.0
    for index, piece in enumerate(pieces):
        if index > first and work + piece.work > _CHUNK_WORK:
            yield StrokeChunk(context, [piece.points_mm for piece in pieces[first:index]])
            first, work = index, 0.0
        work += piece.work + _LEAST_WORK
    if pieces:
        yield StrokeChunk(context, [piece.points_mm for piece in pieces[first:]])


def travel_chunks(
    context: PlanContext, rules: TravelRules, start: Sequence[Contact | None], end: Sequence[Contact | None]
) -> Iterator[TravelChunk]:
    """Travel moves cut into work chunks, likewise."""
    for begin in range(0, len(start), _CHUNK_MOVES):
        part = slice(begin, begin + _CHUNK_MOVES)
        yield TravelChunk(context, rules, start[part], end[part])


def make_ready(context: PlanContext) -> None:
    """Build what the first work chunk would have to wait for."""
    configuration_map_of(context.arm, context.settings.weights)


def timed_strokes(chunk: StrokeChunk) -> list[TimedStroke | InfeasiblePath]:
    """Joint samples of each stroke, or why it cannot be drawn."""
    arm, settings, strokes = chunk.context.arm, chunk.context.settings, chunk.strokes
    lines = [index for index, stroke in enumerate(strokes) if len(stroke) > 1]
    taps = [index for index, stroke in enumerate(strokes) if len(stroke) == 1]
    made: dict[int, TimedStroke | InfeasiblePath] = {}
    if lines:
        made.update(zip(lines, _timed_lines(arm, [strokes[index] for index in lines], settings), strict=True))
    if taps:
        made.update(
            zip(taps, _timed_taps(arm, np.concatenate([strokes[index] for index in taps]), settings), strict=True)
        )
    return [made[index] for index in range(len(strokes))]


def planned_travel_moves(chunk: TravelChunk) -> list[TravelMove]:
    """The travel moves of a work chunk. Errors: UsageError where one would last for longer than a move may."""
    kinematics, limits = kinematics_of(chunk.context.arm), Limits.of(chunk.context.arm)
    moves = _with_collisions(kinematics.arm, plan_travel_moves(kinematics, limits, chunk.rules, chunk.start, chunk.end))
    for index, (move, start, end) in enumerate(zip(moves, chunk.start, chunk.end, strict=True)):
        if start and end:
            stays = keeps_branch(kinematics, move, limits, chunk.rules, end)
            if not stays or move.collision:
                change = plan_branch_change(kinematics, limits, chunk.rules, start, end)
                moves[index] = change if change.exact or not stays else move
    require_bounded_travel_moves(moves, chunk.rules)
    return _with_collisions(kinematics.arm, moves)


def _with_collisions(arm: Arm, moves: Sequence[TravelMove]) -> list[TravelMove]:
    collisions = link_clearance(arm).collisions([move.joints for move in moves])
    return [replace(move, collision=collision) for move, collision in zip(moves, collisions, strict=True)]


def _timed_lines(arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings) -> list[TimedStroke | InfeasiblePath]:
    paths, smooth = smoothed(strokes, SMOOTH_SHARE * settings.tolerance_mm)
    splines, infeasible_paths = joint_paths(arm, settings.method, paths, settings.weights)
    if not infeasible_paths and strays_mm(arm, paths, splines).max() > _SPLINE_SHARE * settings.tolerance_mm:
        paths = paths.subdivided()  # what is left after that is measured on the samples, with all that they stray
        splines, infeasible_paths = joint_paths(arm, settings.method, paths, settings.weights)
    if infeasible_paths:
        blocked = {infeasible_path.path: infeasible_path for infeasible_path in infeasible_paths}
        open_ways = [index for index in range(len(strokes)) if index not in blocked]
        rest = iter(_timed_lines(arm, [strokes[index] for index in open_ways], settings) if open_ways else ())
        return [blocked[index] if index in blocked else next(rest) for index in range(len(strokes))]
    limits = Limits.of(arm)
    for _ in range(_TIMING_SUBDIVISIONS):
        paths, splines = paths.subdivided(), splines.subdivided()
    kinematics = kinematics_of(arm)
    motions = timed_within(
        kinematics,
        limits,
        paths,
        splines,
        pen_speed_limit(arm, paths, splines, settings),
        settings.tolerance_mm,
        settings.rate_hz,
    )
    dwell = round(settings.dwell_s * settings.rate_hz)
    collisions = colliding_paths(arm, [motion.joints for motion in motions])
    timed: list[TimedStroke | InfeasiblePath] = []
    for index, (stroke, motion, is_smooth) in enumerate(zip(strokes, motions, smooth.tolist(), strict=True)):
        independent = kinematics.independent_of(motion.joints)
        timed.append(
            collisions.get(index)
            or TimedStroke(
                motion.joints,
                Contact(stroke[0], independent[0]),
                Contact(stroke[-1], independent[-1]),
                dwell,
                motion.converged,
                motion.held and is_smooth,
            )
        )
    return timed


def pen_speed_mm_s(arm: Arm, settings: PlanSettings) -> float:
    """The cap on the pen's speed on the paper: what is asked for, or the arm's own."""
    return settings.speed_mm_s or arm.pen.speed_mm_s


def pen_speed_limit(arm: Arm, paths: PenPaths, splines: JointPaths, settings: PlanSettings) -> FloatArray:
    """(total cells, n_fractions) cap on dsigma/dt at FRACTIONS of every cell: the pen's own speed, and what keeps it
    near its path between samples."""
    speed_mm_s = pen_speed_mm_s(arm, settings)
    chords = rate_limit(paths, FRACTIONS, speed_mm_s, SAMPLE_SHARE * settings.tolerance_mm, settings.rate_hz)
    joint_chords = chord_error_limit(kinematics_of(arm), splines, CHORD_SHARE * settings.tolerance_mm, settings.rate_hz)
    return np.minimum(chords, joint_chords[:, None])


def _timed_taps(arm: Arm, tips_mm: FloatArray, settings: PlanSettings) -> list[TimedStroke | InfeasiblePath]:
    tips = np.column_stack((tips_mm, np.zeros(len(tips_mm))))
    independent, infeasible_paths = exact_configurations(
        arm, configurations_at(arm, settings.method, tips, settings.weights), tips
    )
    blocked = {infeasible_path.path: infeasible_path for infeasible_path in infeasible_paths}
    joints = arm.complete(independent)
    blocked = colliding_paths(arm, list(joints[:, None])) | blocked
    rest = max(round(max(settings.dwell_s, _TAP_S) * settings.rate_hz), 1)
    contacts = [Contact(tip, configuration) for tip, configuration in zip(tips_mm, independent, strict=True)]
    return [
        blocked.get(index) or TimedStroke(joints[index : index + 1], contact, contact, rest)
        for index, contact in enumerate(contacts)
    ]
