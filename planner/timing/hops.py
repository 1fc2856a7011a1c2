"""Pen-up moves: lift, travel, lower, overlapping where the pen clears the paper.

A hop is two jerk-limited motions at once, both by Ruckig. The height goes up and, on short hops without a halt at
the top, down again; the place over the paper moves from rest to rest along a straight line in (radius, azimuth)
about the base axis, only while the tip is above the clearance height. Between paper and clearance the tip so moves
straight up or down, above it both overlap. Postures are those nearest to the straight line in joint space, raised the
quickest way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from planner.arms.kinematics import Kinematics
from planner.arms.projection import project
from planner.arrays import BoolArray, FloatArray
from planner.timing.leap_choice import (
    Slopes,
    coordinate_limits,
    rest_of,
    shares_and_tops,
    turning_acceleration,
)
from planner.timing.limits import Limits
from planner.timing.quickest_lift import quickest_lifts
from planner.timing.ruckig_profile import RestToRest, rest_to_rest

_PROBES = 9
_FINE = 4
"""Samples per period at which limits are checked."""
_FITS = 5
"""How often a turning height is raised until the move over the paper fits above the clearance."""
_TURN_MARGIN = 0.999
"""Share of the braking that limits allow at a turn: at the very limit rounding decides whether Ruckig accepts."""


@dataclass(frozen=True, slots=True)
class HopRules:
    """Heights in mm above the paper, the cap on the speed of lowering, and the sample rate."""

    clearance_mm: float
    lift_mm: float
    lowering_speed_mm_s: float
    rate_hz: float


@dataclass(frozen=True, eq=False, slots=True)
class Hop:
    """Joint samples (n_samples, n_joints) of a hop, both ends included, and the durations of its phases in s.

    exact: False where the pen could not be kept on its way, or a joint left its limits.
    """

    joints: FloatArray
    lifting_s: float
    travelling_s: float
    lowering_s: float
    exact: bool


@dataclass(frozen=True, eq=False, slots=True)
class Touch:
    """Where a hop leaves or meets the paper: the tip (2,) in mm and the free joints (n_free,) there."""

    tip_mm: FloatArray
    posture: FloatArray


def plan_hops(kinematics: Kinematics, limits: Limits, rules: HopRules, leave: Sequence[Touch | None],
              meet: Sequence[Touch | None]) -> list[Hop]:
    """Hops from each `leave` to the `meet` of the same index. Where one of the two is None the hop begins, or
    ends, at the lift height above the other, as at the two ends of a drawing."""
    shapes = [_Shape.of(rules, one, other) for one, other in zip(leave, meet, strict=True)]
    lifts = quickest_lifts(kinematics, limits.jerk, np.concatenate([shape.postures for shape in shapes]))
    shapes = [replace(shape, lifts=pair) for shape, pair in zip(shapes, lifts.reshape(len(shapes), 2, -1), strict=True)]
    plans = _timed(shapes, _joint_slopes(kinematics, shapes), limits, rules)
    fine, _ = _sampled(kinematics, plans, _FINE * rules.rate_hz)
    plans = [plan.slowed(limits.slowing_of(joints, 1 / (_FINE * rules.rate_hz)) * 1.0005, rules)
             for plan, joints in zip(plans, fine, strict=True)]
    joints, exact = _sampled(kinematics, plans, rules.rate_hz)
    return [plan.hop(samples, bool(good.all())) for plan, samples, good in zip(plans, joints, exact, strict=True)]


@dataclass(frozen=True, eq=False, slots=True)
class _Shape:
    """The two ends of a hop in (radius, azimuth), with the free joints there, how they raise the pen by a mm, and
    the heights there."""

    polar: FloatArray
    postures: FloatArray
    lifts: FloatArray
    from_mm: float
    to_mm: float

    @staticmethod
    def of(rules: HopRules, leave: Touch | None, meet: Touch | None) -> _Shape:
        one, other = leave or meet, meet or leave
        assert one is not None and other is not None
        tips = np.stack((one.tip_mm, other.tip_mm))
        polar = np.column_stack((np.hypot(*tips.T), np.arctan2(tips[:, 1], tips[:, 0])))
        postures = np.stack((one.posture, other.posture))
        return _Shape(polar, postures, np.zeros_like(postures),
                      0.0 if leave else rules.lift_mm, 0.0 if meet else rules.lift_mm)

    def tip_mm(self, along: FloatArray, height_mm: FloatArray) -> FloatArray:
        """(n, 3) at fractions of the way and heights."""
        radius, azimuth = (self.polar[0] + along[:, None] * (self.polar[1] - self.polar[0])).T
        return np.column_stack((radius * np.cos(azimuth), radius * np.sin(azimuth), height_mm))

    def reference(self, along: FloatArray, height_mm: FloatArray) -> FloatArray:
        """(n, n_free) free joints near which the posture is sought at fractions of the way and heights."""
        line = self.postures[0] + along[:, None] * (self.postures[1] - self.postures[0])
        lift = self.lifts[0] + along[:, None] * (self.lifts[1] - self.lifts[0])
        raised: FloatArray = line + height_mm[:, None] * lift
        return raised


@dataclass(frozen=True, eq=False, slots=True)
class _Timed:
    """A hop's motions: up, over, and down, which is a rise from the end of the hop played backwards; all slowed by one
    factor."""

    shape: _Shape
    up: RestToRest
    over: RestToRest
    down: RestToRest
    over_begins_s: float
    clear_until_s: float
    natural_s: float
    factor: float = 1.0

    @property
    def duration_s(self) -> float:
        return self.natural_s * self.factor

    @property
    def fits(self) -> bool:
        """Whether the place is reached while the pen is still above the clearance, without a halt at the top."""
        return self.over_begins_s + self.over.duration_s <= self.clear_until_s

    def slowed(self, needed: float, rules: HopRules) -> _Timed:
        """Slowed by what is needed, or sped up by what is left but for the cap on lowering, and on to whole sample
        periods."""
        lowering = self.down.highest_speed / rules.lowering_speed_mm_s
        duration = self.natural_s * max(needed, lowering)
        whole = max(np.ceil(duration * rules.rate_hz - 1e-9), 1.0) / rules.rate_hz
        return replace(self, factor=float(whole / self.natural_s))

    def way(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Fraction of the way and height in mm at times (n,) after the start."""
        times = times_s / self.factor
        height = np.where(times < self.up.duration_s, self.shape.from_mm + self.up.at(times),
                          self.shape.to_mm + self.down.at(self.natural_s - times))
        return self.over.at(times - self.over_begins_s), height

    def hop(self, joints: FloatArray, exact: bool) -> Hop:
        lifting = self.over_begins_s * self.factor
        lowering = (self.natural_s - self.clear_until_s) * self.factor
        return Hop(joints, lifting, max(self.duration_s - lifting - lowering, 0.0), lowering, exact)


def _joint_slopes(kinematics: Kinematics, shapes: Sequence[_Shape]) -> Slopes:
    """How fast joints move with height and along the way, from postures at a few probes of each hop."""
    along = np.concatenate((np.zeros(2), np.linspace(0, 1, _PROBES), np.ones(2)))
    up, over, down = (0, 1), slice(2, 2 + _PROBES), (-2, -1)
    height = np.concatenate(([0.0, 1.0], np.full(_PROBES, 1.0), [1.0, 0.0]))
    tips = np.concatenate([shape.tip_mm(along, height) for shape in shapes])
    references = np.concatenate([shape.reference(along, height) for shape in shapes])
    free, _ = project(kinematics, references, tips)
    joints = kinematics.arm.complete(free).reshape(len(shapes), len(along), -1)
    return Slopes(np.abs(joints[:, up[1]] - joints[:, up[0]]), np.abs(joints[:, down[0]] - joints[:, down[1]]),
                  np.abs(np.diff(joints[:, over], axis=1)).max(axis=1) * (_PROBES - 1))


def _timed(shapes: Sequence[_Shape], slopes: Slopes, limits: Limits, rules: HopRules) -> list[_Timed]:
    """The motions of every hop, within the limits as far as joints follow their slopes."""
    shares, tops = shares_and_tops(slopes, limits, rules.clearance_mm, rules.lift_mm, rules.lowering_speed_mm_s)
    over = _rows(coordinate_limits(slopes.along, rest_of(slopes, limits, shares)))
    up = _rows(coordinate_limits(slopes.lifting, limits))
    down = _rows(coordinate_limits(slopes.lowering, limits))
    plans = []
    for shape, share, top, of_over, of_up, of_down in zip(shapes, shares.tolist(), tops.tolist(), over, up, down,
                                                          strict=True):
        still = float(np.abs(shape.polar[1] - shape.polar[0]).max()) < 1e-9
        way = rest_to_rest(0.0 if still else 1.0, *of_over)
        heights = _Heights((of_up[0], share * of_up[1], share * of_up[2]),
                           (min(of_down[0], rules.lowering_speed_mm_s), share * of_down[1], share * of_down[2]))
        plans.append(_leap(shape, way, heights, rules, top))
    return plans


_Bounds = tuple[float, float, float]
"""Velocity, acceleration and jerk that a coordinate may have."""


@dataclass(frozen=True, slots=True)
class _Heights:
    up: _Bounds
    down: _Bounds


def _rows(limits: Limits) -> list[_Bounds]:
    return list(zip(limits.velocity.tolist(), limits.acceleration.tolist(), limits.jerk.tolist(), strict=True))


def _leap(shape: _Shape, over: RestToRest, heights: _Heights, rules: HopRules, top_mm: float) -> _Timed:
    """The leap that turns at the top, raised until the way fits above the clearance; where it does not even at the
    lift height, or where an end is in the air, the leap that rests there."""
    if not (shape.from_mm or shape.to_mm):
        for _ in range(_FITS):
            leap = _with_top(shape, over, heights, rules, top_mm, turns=True)
            if leap.fits:
                return leap
            if top_mm >= rules.lift_mm:
                break
            stay_s = leap.clear_until_s - leap.over_begins_s
            lack = over.duration_s / max(stay_s, 1e-6)
            top_mm = min(rules.clearance_mm + (top_mm - rules.clearance_mm) * min(lack ** 2, 2.0) * 1.01, rules.lift_mm)
    return _with_top(shape, over, heights, rules, rules.lift_mm, turns=False)


def _with_top(shape: _Shape, over: RestToRest, heights: _Heights, rules: HopRules, top_mm: float, *, turns: bool
              ) -> _Timed:
    """A leap of that height, the way beginning where the clearance is passed."""
    rises = (top_mm - shape.from_mm, top_mm - shape.to_mm)
    turning = 0.0
    if turns:
        turning = _TURN_MARGIN * min(
            min(acceleration, float(turning_acceleration(np.array(rise), np.array(jerk), velocity)))
            for rise, (velocity, acceleration, jerk) in zip(rises, (heights.up, heights.down), strict=True))
    up, down = rest_to_rest(rises[0], *heights.up, turning), rest_to_rest(rises[1], *heights.down, turning)
    clear = [motion.time_at(rules.clearance_mm) if top_mm > rules.clearance_mm > foot else motion.duration_s
             for motion, foot in ((up, shape.from_mm), (down, shape.to_mm))]
    natural = up.duration_s + down.duration_s
    if not turns:
        natural = max(natural, clear[0] + over.duration_s + clear[1])
    return _Timed(shape, up, over, down, clear[0], natural - clear[1], natural)


def _sampled(kinematics: Kinematics, plans: Sequence[_Timed], rate_hz: float
             ) -> tuple[list[FloatArray], list[BoolArray]]:
    """Joint samples of every hop, and where they are exact and within limits."""
    references, tips, counts = [], [], []
    for plan in plans:
        count = round(plan.duration_s * rate_hz) if plan.factor != 1.0 else int(np.ceil(plan.duration_s * rate_hz))
        along, height = plan.way(np.arange(count + 1) / rate_hz)
        references.append(plan.shape.reference(along, height))
        tips.append(plan.shape.tip_mm(along, height))
        counts.append(count + 1)
    free, exact = project(kinematics, np.concatenate(references), np.concatenate(tips))
    joints = kinematics.arm.complete(free)
    arm = kinematics.arm
    exact &= ((joints >= arm.minimum - 1e-9) & (joints <= arm.maximum + 1e-9)).all(axis=1)
    bounds = np.cumsum(counts)[:-1]
    return np.split(joints, bounds), np.split(exact, bounds)
