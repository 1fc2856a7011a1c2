"""Pen-up moves: lift, travel, lower, overlapping where the pen clears the paper.

A hop is two jerk-limited motions at once. The height goes up and down by Ruckig, from rest to rest; the
place over the paper moves, also from rest to rest, along a straight line in (radius, azimuth) about the base axis,
only while the tip is above the clearance height. Between paper and clearance the tip so moves straight
up or down, above it both overlap. Postures are those nearest to the straight line in joint space.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arms.kinematics import Kinematics
from planner.arms.projection import project
from planner.arrays import BoolArray, FloatArray
from planner.timing.limits import Limits
from planner.timing.ruckig_profile import RestToRest, rest_to_rest

_PROBES = 9
_TOPS = (1.1, 1.4, 2.0, 3.0)
"""Travel heights that are tried, in clearances; the lift height is the last."""
_FINE = 4
"""Samples per period at which limits are checked."""
_SHARE = 0.7
"""Share of acceleration and jerk limits that each of the two motions may take where they overlap."""


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
    slopes = _joint_slopes(kinematics, shapes)
    plans = [_timed(shape, slope, limits, rules) for shape, slope in zip(shapes, slopes, strict=True)]
    fine, _ = _sampled(kinematics, plans, _FINE * rules.rate_hz)
    plans = [plan.slowed(limits.slowing_of(joints, 1 / (_FINE * rules.rate_hz)) * 1.0005, rules.rate_hz)
             for plan, joints in zip(plans, fine, strict=True)]
    joints, exact = _sampled(kinematics, plans, rules.rate_hz)
    return [plan.hop(samples, bool(good.all())) for plan, samples, good in zip(plans, joints, exact, strict=True)]


@dataclass(frozen=True, eq=False, slots=True)
class _Shape:
    """The two ends of a hop in (radius, azimuth), with the free joints there and the heights there."""

    polar: FloatArray
    postures: FloatArray
    from_mm: float
    to_mm: float

    @staticmethod
    def of(rules: HopRules, leave: Touch | None, meet: Touch | None) -> _Shape:
        one, other = leave or meet, meet or leave
        assert one is not None and other is not None
        tips = np.stack((one.tip_mm, other.tip_mm))
        polar = np.column_stack((np.hypot(*tips.T), np.arctan2(tips[:, 1], tips[:, 0])))
        return _Shape(polar, np.stack((one.posture, other.posture)),
                      0.0 if leave else rules.lift_mm, 0.0 if meet else rules.lift_mm)

    def tip_mm(self, along: FloatArray, height_mm: FloatArray) -> FloatArray:
        """(n, 3) at fractions of the way and heights."""
        radius, azimuth = (self.polar[0] + along[:, None] * (self.polar[1] - self.polar[0])).T
        return np.column_stack((radius * np.cos(azimuth), radius * np.sin(azimuth), height_mm))

    def reference(self, along: FloatArray) -> FloatArray:
        line: FloatArray = self.postures[0] + along[:, None] * (self.postures[1] - self.postures[0])
        return line


@dataclass(frozen=True, eq=False, slots=True)
class _Slopes:
    """(n_joints,) largest |dq/dz| near each end, per mm, and |dq/d along| on the way."""

    lifting: FloatArray
    lowering: FloatArray
    along: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class _Timed:
    """A hop's motions: up, over, down, with the times at which they begin, all slowed by one factor."""

    shape: _Shape
    up: RestToRest
    over: RestToRest
    down: RestToRest
    top_mm: float
    over_begins_s: float
    down_begins_s: float
    over_ends_at_clearance_s: float
    factor: float = 1.0

    @property
    def natural_s(self) -> float:
        return self.down_begins_s + self.down.duration_s

    @property
    def duration_s(self) -> float:
        return self.natural_s * self.factor

    def slowed(self, needed: float, rate_hz: float) -> _Timed:
        """Slowed by what is needed, and on to whole sample periods."""
        duration = self.natural_s * max(needed, 1.0)
        whole = max(np.ceil(duration * rate_hz - 1e-9), 1.0) / rate_hz
        return _Timed(self.shape, self.up, self.over, self.down, self.top_mm, self.over_begins_s,
                      self.down_begins_s, self.over_ends_at_clearance_s, float(whole / self.natural_s))

    def way(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Fraction of the way and height in mm at times (n,) after the start."""
        times = times_s / self.factor
        height = self.shape.from_mm + self.up.at(times) * np.sign(self.top_mm - self.shape.from_mm)
        height -= self.down.at(times - self.down_begins_s)
        over = self.over.at(times - self.over_begins_s)
        return over, height

    def hop(self, joints: FloatArray, exact: bool) -> Hop:
        lifting = self.over_begins_s * self.factor
        lowering = (self.natural_s - self.over_ends_at_clearance_s) * self.factor
        return Hop(joints, lifting, max(self.duration_s - lifting - lowering, 0.0), lowering, exact)


def _joint_slopes(kinematics: Kinematics, shapes: Sequence[_Shape]) -> list[_Slopes]:
    """How fast joints move with height and along the way, from postures at a few probes of each hop."""
    along = np.concatenate((np.zeros(2), np.linspace(0, 1, _PROBES), np.ones(2)))
    up, over, down = (0, 1), slice(2, 2 + _PROBES), (-2, -1)
    height = np.concatenate(([0.0, 1.0], np.full(_PROBES, 1.0), [1.0, 0.0]))
    tips = np.concatenate([shape.tip_mm(along, height) for shape in shapes])
    references = np.concatenate([shape.reference(along) for shape in shapes])
    free, _ = project(kinematics, references, tips)
    joints = kinematics.arm.complete(free).reshape(len(shapes), len(along), -1)
    return [_Slopes(np.abs(probe[up[1]] - probe[up[0]]), np.abs(probe[down[0]] - probe[down[1]]),
                    np.abs(np.diff(probe[over], axis=0)).max(axis=0) * (_PROBES - 1)) for probe in joints]


def _fastest(distance: float, slope: FloatArray, limits: Limits, share: float, cap: float = np.inf) -> RestToRest:
    """The move along a coordinate whose joints move in proportion to it."""
    steep = np.maximum(slope, 1e-9)
    return rest_to_rest(distance, min(float((limits.velocity / steep).min()), cap),
                        share * float((limits.acceleration / steep).min()), share * float((limits.jerk / steep).min()))


def _timed(shape: _Shape, slopes: _Slopes, limits: Limits, rules: HopRules) -> _Timed:
    """The fastest of a few travel heights."""
    still = float(np.abs(shape.polar[1] - shape.polar[0]).max()) < 1e-9
    over = _fastest(0.0 if still else 1.0, slopes.along, limits, _SHARE)
    if shape.from_mm or shape.to_mm:
        tops = [rules.lift_mm]
    else:
        tops = sorted({min(rules.clearance_mm * top, rules.lift_mm) for top in _TOPS} | {rules.lift_mm})
    choices = []
    for top in tops:
        up = _fastest(top - shape.from_mm, slopes.lifting, limits, _SHARE)
        down = _fastest(top - shape.to_mm, slopes.lowering, limits, _SHARE, rules.lowering_speed_mm_s)
        begins = up.time_at(rules.clearance_mm) if top > rules.clearance_mm > shape.from_mm else up.duration_s
        into_down = down.time_at(top - rules.clearance_mm) if top > rules.clearance_mm > shape.to_mm else 0.0
        down_begins = max(up.duration_s, begins + over.duration_s - into_down)
        choices.append(_Timed(shape, up, over, down, top, begins, down_begins, down_begins + into_down))
    return min(choices, key=lambda choice: choice.natural_s)


def _sampled(kinematics: Kinematics, plans: Sequence[_Timed], rate_hz: float
             ) -> tuple[list[FloatArray], list[BoolArray]]:
    """Joint samples of every hop, and where they are exact and within limits."""
    references, tips, counts = [], [], []
    for plan in plans:
        count = round(plan.duration_s * rate_hz) if plan.factor != 1.0 else int(np.ceil(plan.duration_s * rate_hz))
        along, height = plan.way(np.arange(count + 1) / rate_hz)
        references.append(plan.shape.reference(along))
        tips.append(plan.shape.tip_mm(along, height))
        counts.append(count + 1)
    free, exact = project(kinematics, np.concatenate(references), np.concatenate(tips))
    joints = kinematics.arm.complete(free)
    arm = kinematics.arm
    exact &= ((joints >= arm.minimum - 1e-9) & (joints <= arm.maximum + 1e-9)).all(axis=1)
    bounds = np.cumsum(counts)[:-1]
    return np.split(joints, bounds), np.split(exact, bounds)
