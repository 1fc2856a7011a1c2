"""Strokes as pen targets that Ruckig joins in joint space: at rest in each, all joints setting out and arriving
together, as quick as the slowest of them may be.

Joints move straight from target to target, so targets are put as near to each other as keeps the pen within the
tolerance of the stroke and on the paper. It is the plain way to draw, and slow where there are many targets: the
baseline that the least time along a smooth path is held against.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.path_work import simplified
from planner.inverse_kinematics.references import References
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath, colliding_paths, exact_configurations
from planner.kinematics.chain import Kinematics
from planner.motion.speed_limit import pen_speed_mm_s
from planner.motion.tap import timed_taps
from planner.motion.timed_stroke import Contact, TimedStroke
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings
from planner.timing.length_bound import SLOW_ARM, require_bounded
from planner.travel.ruckig_profile import RestToRest, rest_to_rest
from planner.travel.travel_choice import coordinate_limits

_DROPPED_SHARE, _BOW_SHARE, _HEIGHT_SHARE = 0.45, 0.45, 0.5
"""Shares of the tolerance: points of a stroke that are no targets, what the tip bows from straight lines between
targets, and its height there."""
_PROBES = np.linspace(0.0, 1.0, 9)
_BETWEEN_PROBES = 1.01
"""How much faster than from probe to probe the tip may be in between, for the same motion of the joints."""
_ROUNDS = 16
"""Halvings of the way between two targets, after which the joints jump there, however near the targets are."""


def joined_strokes(
    model: ArmModel, references: References, settings: PlanSettings, strokes: Sequence[FloatArray]
) -> list[TimedStroke | InfeasiblePath]:
    """Joint samples of each stroke (n, 2), arm mm, or why it cannot be drawn. Errors: UsageError where that takes too
    long to be a plan."""
    found: dict[int, TimedStroke | InfeasiblePath] = {}
    taps = [index for index, stroke in enumerate(strokes) if len(stroke) == 1]
    lines = [index for index, stroke in enumerate(strokes) if len(stroke) > 1]
    if taps:
        tips_mm = np.concatenate([strokes[index] for index in taps])
        found.update(zip(taps, timed_taps(model, references, settings, tips_mm), strict=True))
    chosen = simplified([strokes[index] for index in lines], _DROPPED_SHARE * settings.tolerance_mm) if lines else []
    for index, stroke in zip(lines, chosen, strict=True):
        found[index] = _joined(model, references, settings, stroke, index)
    return [found[index] for index in range(len(strokes))]


@dataclass(frozen=True, eq=False, slots=True)
class _Targets:
    """tips_mm: (n, 2) on the paper; independent: (n, n_independent) configurations there."""

    tips_mm: FloatArray
    independent: FloatArray


def _joined(
    model: ArmModel, references: References, settings: PlanSettings, stroke: FloatArray, index: int
) -> TimedStroke | InfeasiblePath:
    kinematics = model.kinematics
    targets = _targets(kinematics, references, settings.tolerance_mm, stroke, index)
    if isinstance(targets, InfeasiblePath):
        return targets
    samples = _samples(model, settings, targets)
    collision = colliding_paths(kinematics, [samples]).get(0)
    if collision is not None:
        return InfeasiblePath(index, collision.tip_mm, collision.reason, collision.joint, collision.limit)
    return TimedStroke(
        samples,
        Contact(stroke[0], targets.independent[0]),
        Contact(stroke[-1], targets.independent[-1]),
        round(settings.dwell_s * settings.rate_hz),
    )


def _targets(
    kinematics: Kinematics, references: References, tolerance_mm: float, stroke: FloatArray, index: int
) -> _Targets | InfeasiblePath:
    """Configurations along a stroke between which the joints may move straight."""
    places = stroke
    tips = np.column_stack((places, np.zeros(len(places))))
    independent, missed = exact_configurations(kinematics, references.along(tips, np.array([0])), tips)
    sure = references.surely_along(tips, np.array([0])) if missed else None
    if sure is not None:
        independent, missed = exact_configurations(kinematics, sure, tips)
    for _ in range(_ROUNDS):
        if missed:
            return InfeasiblePath(index, missed[0].tip_mm, missed[0].reason, missed[0].joint, missed[0].limit)
        strays = np.flatnonzero(_bow(kinematics, places, independent, tolerance_mm) > 1.0)
        if not len(strays):
            return _Targets(places, independent)
        middles = 0.5 * (places[strays] + places[strays + 1])
        between, missed = exact_configurations(
            kinematics,
            0.5 * (independent[strays] + independent[strays + 1]),
            np.column_stack((middles, np.zeros(len(middles)))),
        )
        places = np.insert(places, strays + 1, middles, axis=0)
        independent = np.insert(independent, strays + 1, between, axis=0)
    x, y = places[strays[0]].tolist()
    return InfeasiblePath(index, (x, y), "the method changes to another branch there", None, None)


def _tips(kinematics: Kinematics, independent: FloatArray) -> FloatArray:
    """(n - 1, n_probes, 3) tips in mm on the way between neighbouring configurations (n, n_independent)."""
    way = independent[:-1, None] + _PROBES[:, None] * np.diff(independent, axis=0)[:, None]
    tips: FloatArray = kinematics.tip_mm(way.reshape(-1, way.shape[2])).reshape(len(way), len(_PROBES), 3)
    return tips


def _bow(kinematics: Kinematics, places: FloatArray, independent: FloatArray, tolerance_mm: float) -> FloatArray:
    """(n - 1,) by how much the tip strays from the straight line between neighbouring places, 1 where that is just
    allowed."""
    tips = _tips(kinematics, independent)
    along = np.diff(places, axis=0)[:, None]
    offset = tips[..., :2] - places[:-1, None]
    share = np.clip((offset * along).sum(axis=2) / np.maximum((along**2).sum(axis=2), 1e-18), 0.0, 1.0)
    aside = np.linalg.norm(offset - share[..., None] * along, axis=2).max(axis=1)
    height = np.abs(tips[..., 2]).max(axis=1)
    worst: FloatArray = np.maximum(aside / _BOW_SHARE, height / _HEIGHT_SHARE) / tolerance_mm
    return worst


def _samples(model: ArmModel, settings: PlanSettings, targets: _Targets) -> FloatArray:
    """(n, n_joints) from target to target, each met at a sample."""
    joints = model.arm.complete(targets.independent)
    moved = np.diff(joints, axis=0)
    bounds = coordinate_limits(np.abs(moved), model.limits)
    tips = _tips(model.kinematics, targets.independent)
    fastest = np.linalg.norm(np.diff(tips, axis=1), axis=2).max(axis=1) * (len(_PROBES) - 1)
    velocity = np.minimum(
        bounds.velocity, pen_speed_mm_s(model.arm, settings) / np.maximum(fastest * _BETWEEN_PROBES, 1e-12)
    )
    moves = [
        rest_to_rest(1.0, *limits)
        for limits in zip(velocity.tolist(), bounds.acceleration.tolist(), bounds.jerk.tolist(), strict=True)
    ]
    rate_hz = settings.rate_hz
    require_bounded(sum(move.duration_s for move in moves), rate_hz, "the drawing", SLOW_ARM)
    legs = [
        start + _on_the_grid(move, rate_hz)[:, None] * (end - start)
        for move, (start, end) in zip(moves, pairwise(joints), strict=True)
    ]
    return np.concatenate((joints[:1], *legs))


def _on_the_grid(move: RestToRest, rate_hz: float) -> FloatArray:
    """(n,) how much of a move is made at each sample after its start, slowed on to whole sample periods."""
    count = max(int(np.ceil(move.duration_s * rate_hz - 1e-9)), 1)
    return move.at(np.linspace(0.0, move.duration_s, count + 1)[1:])
