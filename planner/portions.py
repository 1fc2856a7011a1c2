"""The parts of a plan that are made apart from each other: neighbouring strokes in time, and hops between them.

A portion says all that is needed to make it, so that any process can.
"""

from __future__ import annotations

import pickle
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from planner.arms.arm import Arm
from planner.arms.kinematics import kinematics_of
from planner.arms.link_clearance import link_clearance
from planner.arms.posture_field import posture_field, posture_sheets
from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import JointPaths
from planner.inverse_kinematics.stroke_postures import (
    Obstacle,
    collision_obstacles,
    exact_postures,
    joint_paths,
    postures_at,
    strays_mm,
)
from planner.placement.pen_path import PenPaths, smoothed
from planner.placement.pieces import Piece, in_pieces
from planner.settings import Method, PlanSettings
from planner.timing.branch_change import keeps_branch, plan_branch_change
from planner.timing.bulge_cap import bulge_cap
from planner.timing.held_motion import timed_within
from planner.timing.hops import Hop, HopRules, Touch, plan_hops, require_bounded_hops
from planner.timing.limits import Limits
from planner.timing.speed_cap import rate_cap
from planner.timing.timing_problem import FRACTIONS

SMOOTH_SHARE, SAMPLE_SHARE, BULGE_SHARE = 0.5, 0.4, 0.04
"""Shares of the tolerance: rounded corners, straight lines between samples, and what the tip strays from these because
it is the joints that move straight."""
_SPLINE_SHARE = 0.04
"""Share of the tolerance that the joints' splines may stray between their knots before there are more of them."""

_PORTION_WORK = 4000.0
_LEAST_WORK = 10.0
"""What a stroke of no length costs at least."""
_PORTION_HOPS = 125
_TIMING_HALVINGS = 1
"""How often the cells of a path are cut in two before it is timed: jerk switches at cell ends only, and cells as
long as the corners that they go round are too coarse for that."""
_TAP_S = 0.05
"""How long a tap rests on the paper at least: a pen needs a moment to leave a dot."""


@dataclass(frozen=True, eq=False, slots=True)
class TimedStroke:
    """A stroke ready to be drawn: joint samples (n, n_joints) and where it touches down and lifts off.

    settled: whether its timing is near the least time, rather than the fallback. held: whether the pen stays within the
    tolerance between its samples.
    """

    joints: FloatArray
    first: Touch
    last: Touch
    dwell_samples: int
    settled: bool = True
    held: bool = True

    @staticmethod
    def of(pieces: Sequence[TimedStroke]) -> TimedStroke:
        """One stroke of pieces that each begin at rest where the one before ended."""
        if len(pieces) == 1:
            return pieces[0]
        joints = np.concatenate([pieces[0].joints, *(piece.joints[1:] for piece in pieces[1:])])
        return TimedStroke(joints, pieces[0].first, pieces[-1].last, pieces[0].dwell_samples,
                           all(piece.settled for piece in pieces), all(piece.held for piece in pieces))


@dataclass(frozen=True, slots=True)
class Kit:
    """What every portion of a plan needs: the arm, pickled, so that a process builds its models of it once, and the
    settings."""

    pickled_arm: bytes
    settings: PlanSettings

    @staticmethod
    def of(arm: Arm, settings: PlanSettings) -> Kit:
        return Kit(pickle.dumps(arm), settings)

    @property
    def arm(self) -> Arm:
        return _unpickled(self.pickled_arm)


@lru_cache(maxsize=4)
def _unpickled(pickled_arm: bytes) -> Arm:
    arm: Arm = pickle.loads(pickled_arm)  # noqa: S301  # pickled by `Kit.of`, never read from a file
    return arm


@dataclass(frozen=True, eq=False, slots=True)
class StrokePortion:
    """Neighbouring strokes (n, 2), arm mm, or pieces of them."""

    kit: Kit
    strokes: Sequence[FloatArray]


@dataclass(frozen=True, eq=False, slots=True)
class HopPortion:
    """Neighbouring hops: where each leaves and meets the paper, None at the ends of the drawing."""

    kit: Kit
    rules: HopRules
    leave: Sequence[Touch | None]
    meet: Sequence[Touch | None]


def pieces_of(kit: Kit, strokes: Sequence[FloatArray]) -> list[list[Piece]]:
    """What may be timed apart, stroke by stroke. Methods that go from posture to posture need strokes whole, and so
    does an arm that has to choose a sheet of postures for each."""
    settings = kit.settings
    whole = settings.method in (Method.DLS, Method.NLP) or (
        settings.method is Method.PATH and len(posture_sheets(kit.arm, settings.weights)) > 1)
    return list(in_pieces(strokes, SMOOTH_SHARE * settings.tolerance_mm, whole=whole))


def stroke_portions(kit: Kit, pieces: Sequence[Piece]) -> Iterator[StrokePortion]:
    """Pieces put together to portions of bounded size: by the drawing alone, never by who makes them."""
    first, work = 0, 0.0
    for index, piece in enumerate(pieces):
        if index > first and work + piece.work > _PORTION_WORK:
            yield StrokePortion(kit, [piece.points_mm for piece in pieces[first:index]])
            first, work = index, 0.0
        work += piece.work + _LEAST_WORK
    if pieces:
        yield StrokePortion(kit, [piece.points_mm for piece in pieces[first:]])


def hop_portions(kit: Kit, rules: HopRules, leave: Sequence[Touch | None], meet: Sequence[Touch | None]
                 ) -> Iterator[HopPortion]:
    """Hops cut into portions, likewise."""
    for begin in range(0, len(leave), _PORTION_HOPS):
        part = slice(begin, begin + _PORTION_HOPS)
        yield HopPortion(kit, rules, leave[part], meet[part])


def make_ready(kit: Kit) -> None:
    """Build what the first portion would have to wait for."""
    posture_field(kit.arm, kit.settings.weights)


def timed_strokes(portion: StrokePortion) -> list[TimedStroke | Obstacle]:
    """Joint samples of each stroke, or why it cannot be drawn."""
    arm, settings, strokes = portion.kit.arm, portion.kit.settings, portion.strokes
    lines = [index for index, stroke in enumerate(strokes) if len(stroke) > 1]
    taps = [index for index, stroke in enumerate(strokes) if len(stroke) == 1]
    made: dict[int, TimedStroke | Obstacle] = {}
    if lines:
        made.update(zip(lines, _timed_lines(arm, [strokes[index] for index in lines], settings), strict=True))
    if taps:
        made.update(zip(taps, _timed_taps(arm, np.concatenate([strokes[index] for index in taps]), settings),
                        strict=True))
    return [made[index] for index in range(len(strokes))]


def planned_hops(portion: HopPortion) -> list[Hop]:
    """The hops of a portion. Errors: UsageError where one would last for longer than a move may."""
    kinematics, limits = kinematics_of(portion.kit.arm), Limits.of(portion.kit.arm)
    hops = _with_collisions(kinematics.arm, plan_hops(kinematics, limits, portion.rules, portion.leave, portion.meet))
    for index, (hop, leave, meet) in enumerate(zip(hops, portion.leave, portion.meet, strict=True)):
        if leave and meet:
            stays = keeps_branch(kinematics, hop, limits, portion.rules, meet)
            if not stays or hop.collision:
                change = plan_branch_change(kinematics, limits, portion.rules, leave, meet)
                hops[index] = change if change.exact or not stays else hop
    require_bounded_hops(hops, portion.rules)
    return _with_collisions(kinematics.arm, hops)


def _with_collisions(arm: Arm, hops: Sequence[Hop]) -> list[Hop]:
    collisions = link_clearance(arm).collisions([hop.joints for hop in hops])
    return [replace(hop, collision=collision) for hop, collision in zip(hops, collisions, strict=True)]


def _timed_lines(arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings) -> list[TimedStroke | Obstacle]:
    paths, smooth = smoothed(strokes, SMOOTH_SHARE * settings.tolerance_mm)
    splines, obstacles = joint_paths(arm, settings.method, paths, settings.weights)
    if not obstacles and strays_mm(arm, paths, splines).max() > _SPLINE_SHARE * settings.tolerance_mm:
        paths = paths.halved()
        splines, obstacles = joint_paths(arm, settings.method, paths, settings.weights)
    if obstacles:
        blocked = {obstacle.path: obstacle for obstacle in obstacles}
        open_ways = [index for index in range(len(strokes)) if index not in blocked]
        rest = iter(_timed_lines(arm, [strokes[index] for index in open_ways], settings) if open_ways else ())
        return [blocked[index] if index in blocked else next(rest) for index in range(len(strokes))]
    limits = Limits.of(arm)
    for _ in range(_TIMING_HALVINGS):
        paths, splines = paths.halved(), splines.halved()
    kinematics = kinematics_of(arm)
    motions = timed_within(kinematics, limits, paths, splines, pen_cap(arm, paths, splines, settings),
                           settings.tolerance_mm, settings.rate_hz)
    dwell = round(settings.dwell_s * settings.rate_hz)
    collisions = collision_obstacles(arm, [motion.joints for motion in motions])
    timed: list[TimedStroke | Obstacle] = []
    for index, (stroke, motion, is_smooth) in enumerate(zip(strokes, motions, smooth.tolist(), strict=True)):
        free = kinematics.free_of(motion.joints)
        timed.append(collisions.get(index) or TimedStroke(
            motion.joints, Touch(stroke[0], free[0]), Touch(stroke[-1], free[-1]), dwell, motion.settled,
            motion.held and is_smooth))
    return timed


def pen_cap(arm: Arm, paths: PenPaths, splines: JointPaths, settings: PlanSettings) -> FloatArray:
    """(total cells, n_fractions) cap on dsigma/dt at FRACTIONS of every cell: the pen's own speed, and what keeps it
    near its path between samples."""
    chords = rate_cap(paths, FRACTIONS, settings.speed_mm_s, SAMPLE_SHARE * settings.tolerance_mm, settings.rate_hz)
    bulges = bulge_cap(kinematics_of(arm), splines, BULGE_SHARE * settings.tolerance_mm, settings.rate_hz)
    return np.minimum(chords, bulges[:, None])


def _timed_taps(arm: Arm, tips_mm: FloatArray, settings: PlanSettings) -> list[TimedStroke | Obstacle]:
    tips = np.column_stack((tips_mm, np.zeros(len(tips_mm))))
    free, obstacles = exact_postures(arm, postures_at(arm, settings.method, tips, settings.weights), tips)
    blocked = {obstacle.path: obstacle for obstacle in obstacles}
    joints = arm.complete(free)
    blocked = collision_obstacles(arm, list(joints[:, None])) | blocked
    rest = max(round(max(settings.dwell_s, _TAP_S) * settings.rate_hz), 1)
    touches = [Touch(tip, posture) for tip, posture in zip(tips_mm, free, strict=True)]
    return [blocked.get(index) or TimedStroke(joints[index:index + 1], touch, touch, rest)
            for index, touch in enumerate(touches)]
