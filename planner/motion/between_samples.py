"""Where the tip is between samples, by both ways in which controllers join them: straight joint lines, and cubics.

A cubic goes through the four samples around, so the sample next to a contact bends the motion on the other side of it:
the first step of a stroke tilts the pen's way down, and the last height of the way down pushes the pen into the paper.
Every part of a trajectory is therefore measured as if it were held at its ends, and what it does to its neighbour is
bounded beside that.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.kinematics.chain import Kinematics
from planner.motion.stroke_motion import StrokeMotions
from planner.motion.tolerance import ACROSS_SHARE, DRIFT_SHARE, HEIGHT_SHARE, STROKE_SHARE
from planner.placement.pen_path import StrokePaths
from planner.placement.polylines import Polylines, largest_of_parts, lines_of_parts
from planner.ragged import starts_of, within

_PER_STEP = 4
_FRACTIONS = np.arange(1, _PER_STEP) / _PER_STEP
_NEARLY = 0.75
"""Share of the room from which on a step is looked at more closely: where two segments of a stroke are as near, the tip
may be furthest between two points that are measured, by a fifth and more."""
_CLOSELY = np.array([k / 16 for k in range(1, 16) if k % (16 // _PER_STEP)])
_ACROSS = 1 / (9 * np.sqrt(3))
"""Largest weight of the sample behind a contact on the near side of it: of u (1 - u) (2 - u) / 6, u in 0 to 1."""
_STEPS_AT_ONCE = 4096
_LEAST_ROOM = 0.02
"""Share of the room that is taken to be left for chords, where the path takes nearly all: slowing ends somewhere."""


def _lagrange(fractions: FloatArray) -> FloatArray:
    """(n, 4) weights of the samples -1, 0, 1, 2 in the cubic through them."""
    nodes = np.array([-1.0, 0.0, 1.0, 2.0])
    return np.stack(
        [np.prod([(fractions - other) / (node - other) for other in nodes if other != node], axis=0) for node in nodes],
        axis=1,
    )


def _both_ways(fractions: FloatArray) -> FloatArray:
    """(2 n, 4) weights of straight lines and of cubics."""
    return np.concatenate(
        (np.column_stack((0 * fractions, 1 - fractions, fractions, 0 * fractions)), _lagrange(fractions))
    )


_WEIGHTS, _CLOSE_WEIGHTS = _both_ways(_FRACTIONS), _both_ways(_CLOSELY)


def tips_between(kinematics: Kinematics, joints: Sequence[FloatArray]) -> tuple[FloatArray, IntArray]:
    """Tips (total steps, n_points, 3) in mm between samples, for samples (n, n_joints) of motions that are held before
    and after; and the number of steps of each."""
    held, first, n_steps = _held(joints)
    return _tips(kinematics, held, first, _WEIGHTS), n_steps


def _held(joints: Sequence[FloatArray]) -> tuple[FloatArray, IntArray, IntArray]:
    """Samples of motions that are held before and after, where the four around each step begin, and the number of steps
    of each motion."""
    counts = np.array([len(samples) for samples in joints])
    held = np.concatenate([part for samples in joints for part in (samples[:1], samples, samples[-1:])])
    first = np.repeat(starts_of(counts + 2)[:-1], counts - 1) + within(counts - 1)
    return held, first, counts - 1


def _tips(kinematics: Kinematics, held: FloatArray, first: IntArray, weights: FloatArray) -> FloatArray:
    """(n, n_weights, 3) tips in mm at such weights (n_weights, 4) of the four samples from each first one (n,) on."""
    tips = np.empty((len(first), len(weights), 3))
    for begin in range(0, len(first), _STEPS_AT_ONCE):
        part = slice(begin, begin + _STEPS_AT_ONCE)
        around = held[first[part, None] + np.arange(4)]
        between = np.einsum("pw,nwj->npj", weights, around)
        tips[part] = kinematics.tip_mm(kinematics.independent_of(between.reshape(-1, held.shape[1]))).reshape(
            len(around), len(weights), 3
        )
    return tips


def stroke_excess(
    kinematics: Kinematics,
    paths: StrokePaths,
    motion: StrokeMotions,
    samples: Sequence[FloatArray],
    tolerance_mm: float,
    late: float = 0.0,
) -> FloatArray:
    """(total steps,) by how much the tip strays from its stroke in each step, or the stroke from the tip, 1 where it is
    just allowed.

    samples: those of the motion, so late. How far the tip strays from the path grows with the square of the speed, and
    so does this figure; the path itself may be off the stroke.
    """
    held, first, n_steps = _held(samples)
    tips = _tips(kinematics, held, first, _WEIGHTS)
    at_samples = kinematics.tip_mm(kinematics.independent_of(np.concatenate(samples)))[:, :2]
    cells, fractions = motion.places(_PER_STEP, late)
    arc_mm = paths.arcs.at(cells, fractions)[:, 0]
    room_mm = STROKE_SHARE * tolerance_mm
    curves = [
        _with_samples(at_samples, tips[:, way, :2], n_steps)
        for way in (slice(0, _PER_STEP - 1), slice(_PER_STEP - 1, None))
    ]
    deviation = np.max([_deviation(paths.line, curve, arc_mm, n_steps, room_mm) for curve in curves], axis=0)
    close = np.flatnonzero((deviation > _NEARLY * room_mm) & (deviation <= room_mm))
    if len(close):
        closer = _tips(kinematics, held, first[close], _CLOSE_WEIGHTS)[..., :2]
        deviation[close] = np.maximum(
            deviation[close], _furthest_of(paths.line, closer, close, arc_mm, n_steps, room_mm)
        )
    excess: FloatArray = deviation / room_mm
    over = excess > 1.0
    if over.any():
        at_rest = _deviation(paths.line, paths.pen.at(cells, fractions), arc_mm, n_steps, room_mm)
        left_mm = np.maximum(room_mm - at_rest, _LEAST_ROOM * room_mm)
        excess[over] = np.maximum((deviation - at_rest) / left_mm, 1.0 + 1e-6)[over]
    excess = np.maximum(excess, np.abs(tips[..., 2]).max(axis=1) / (HEIGHT_SHARE * tolerance_mm))
    if late:
        return excess
    # The first step and the last grow with the cube of the speed.
    ends = starts_of(n_steps + 1)
    into = np.hypot(*(at_samples[ends[:-1] + 1] - at_samples[ends[:-1]]).T)
    out = np.hypot(*(at_samples[ends[1:] - 1] - at_samples[ends[1:] - 2]).T)
    steps = starts_of(n_steps)
    for step, length in ((steps[:-1], into), (steps[1:] - 1, out)):
        across = np.cbrt(_ACROSS * length / (ACROSS_SHARE * tolerance_mm)) ** 2
        excess[step] = np.maximum(excess[step], across)
    return excess


def _with_samples(samples_mm: FloatArray, between_mm: FloatArray, n_steps: IntArray) -> FloatArray:
    """(total, 2) the points between samples (total steps, _PER_STEP - 1, 2) with these among them."""
    last = starts_of(n_steps + 1)[1:] - 1
    begins = np.delete(samples_mm, last, axis=0)
    curve = np.concatenate((begins[:, None], between_mm), axis=1).reshape(-1, 2)
    with_last: FloatArray = np.insert(curve, _PER_STEP * np.cumsum(n_steps), samples_mm[last], axis=0)
    return with_last


def _deviation(
    line: Polylines, curve_mm: FloatArray, arc_mm: FloatArray, n_steps: IntArray, room_mm: float
) -> FloatArray:
    """(total steps,) how far curves, of _PER_STEP points a step, are from their polylines in each step, both ways."""
    deviations = line.deviations(curve_mm, arc_mm, lines_of_parts(n_steps, _PER_STEP), room_mm)
    return largest_of_parts(deviations, n_steps, _PER_STEP)


def _furthest_of(
    line: Polylines, points_mm: FloatArray, steps: IntArray, arc_mm: FloatArray, n_steps: IntArray, room_mm: float
) -> FloatArray:
    """(n,) how far points (n, n_points, 2) within some steps (n,) are from their polylines at most, by arc_mm as
    `_deviation` has it."""
    of_path = np.repeat(np.arange(len(n_steps)), n_steps)[steps]
    place = (_PER_STEP * steps + of_path)[:, None] + _PER_STEP * np.tile(_CLOSELY, 2)
    near_mm = np.interp(place.ravel(), np.arange(len(arc_mm)), arc_mm)
    _, distance = line.distances(points_mm.reshape(-1, 2), near_mm, np.repeat(of_path, points_mm.shape[1]), room_mm)
    furthest: FloatArray = distance.reshape(len(steps), -1).max(axis=1)
    return furthest


def travel_move_excess(
    kinematics: Kinematics,
    joints: Sequence[FloatArray],
    contacts_mm: Sequence[FloatArray],
    on_paper: Sequence[tuple[bool, bool]],
    clearance_mm: float,
    tolerance_mm: float,
) -> FloatArray:
    """(n_travel_moves,) by how much the tip strays between the samples (n, n_joints) of each travel move, 1 where it is
    just allowed: below the clearance from the places that it leaves and comes down on, below the paper, and into its
    neighbours.

    contacts_mm: (2, 2) where it starts and ends; on_paper: which of the two is on the paper. All this shrinks with
    the square of the speed at least, and so does the figure.
    """
    tips, n_steps = tips_between(kinematics, joints)
    bounds = np.cumsum(n_steps)[:-1]
    excess = np.zeros(len(joints))
    for move, (near, samples, places, on) in enumerate(
        zip(np.split(tips, bounds), joints, contacts_mm, on_paper, strict=True)
    ):
        points = near.reshape(-1, 3)
        drift = np.min(
            [np.hypot(*(points[:, :2] - place).T) for place, contact in zip(places, on, strict=True) if contact],
            axis=0,
        )
        strays = np.minimum(drift, clearance_mm - points[:, 2])  # aside, it may be low only where it may be aside
        depth = max(float(strays.max(initial=0.0)), -float(points[:, 2].min(initial=0.0)))
        beside = samples[[min(1, len(samples) - 1), max(len(samples) - 2, 0)]]
        heights = np.abs(kinematics.tip_mm(kinematics.independent_of(beside))[:, 2])
        across = np.cbrt(_ACROSS * heights[list(on)].max() / (ACROSS_SHARE * tolerance_mm)) ** 2
        excess[move] = max(depth / (DRIFT_SHARE * tolerance_mm), float(across))
    return excess
