"""The parts of a plan that are made apart from each other: neighbouring strokes in time, and travel moves between them.

A work chunk says all that is needed to make it, so that any process can.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from planner.arrays import FloatArray
from planner.execution.context import PlanContext
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath
from planner.motion.stroke import samples_of_strokes
from planner.motion.timed_stroke import Contact, TimedStroke
from planner.motion.tolerance import STROKE_SHARE
from planner.placement.pen_path import ROUNDED_SHARE
from planner.placement.pieces import Piece, in_pieces
from planner.settings import Method, Timing
from planner.travel.clear_moves import clear_travel_moves
from planner.travel.joined_targets import joined_strokes
from planner.travel.travel_moves import TravelMove, TravelRules

_CHUNK_WORK = 4000.0
_LEAST_WORK = 10.0
"""What a stroke of no length costs at least."""
_CHUNK_MOVES, _CHUNK_MOVE_SAMPLES = 125, 100_000.0


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
    """What may be timed apart, stroke by stroke."""
    tolerance_mm = ROUNDED_SHARE * STROKE_SHARE * context.settings.tolerance_mm
    return list(in_pieces(strokes, tolerance_mm, whole=not may_be_cut(context)))


def may_be_cut(context: PlanContext) -> bool:
    """Whether pieces of strokes may be timed apart. Methods that go from configuration to configuration need strokes
    whole, and so does an arm that has to choose a branch for each."""
    settings = context.settings
    return settings.method not in (Method.DLS, Method.NLP) and not (
        settings.method is Method.PATH and len(context.model.branches(settings.weights)) > 1
    )


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
    """Travel moves cut into work chunks, likewise: of fewer moves where each of them takes long."""
    samples_per_move = max(rules.clearance_mm / rules.lowering_speed_mm_s * rules.rate_hz, 1.0)
    n_moves = min(max(int(_CHUNK_MOVE_SAMPLES / samples_per_move), 1), _CHUNK_MOVES)
    for begin in range(0, len(start), n_moves):
        part = slice(begin, begin + n_moves)
        yield TravelChunk(context, rules, start[part], end[part])


def timed_strokes(chunk: StrokeChunk) -> list[TimedStroke | InfeasiblePath]:
    """Joint samples of each stroke, or why it cannot be drawn."""
    context = chunk.context
    samples = joined_strokes if context.settings.timing is Timing.RUCKIG else samples_of_strokes
    return samples(context.model, context.references, context.settings, chunk.strokes)


def planned_travel_moves(chunk: TravelChunk) -> list[TravelMove]:
    """The travel moves of a work chunk. Errors: UsageError where one would last for longer than a move may."""
    return clear_travel_moves(chunk.context.model, chunk.rules, chunk.start, chunk.end)
