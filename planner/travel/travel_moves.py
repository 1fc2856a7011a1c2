"""Pen-up moves: lift, travel, lower, overlapping where the pen clears the paper.

A travel move is two jerk-limited motions at once, both by Ruckig. The height goes up and, on short travel moves without
a halt at the top, down again; the place over the paper moves from rest to rest along a straight line, in (radius,
azimuth) about the base axis where the arm turns over its paper, only while the tip is above the clearance height.
Between paper and clearance the tip so moves straight up or down, above it both overlap. Configurations are those
nearest to the straight line in joint space, raised the quickest way.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits, within_limits
from planner.kinematics.link_clearance import Collision
from planner.kinematics.projection import project
from planner.kinematics.quickest_lift import quickest_lifts
from planner.motion.between_samples import travel_move_excess
from planner.motion.timed_stroke import Contact
from planner.settings import Timing
from planner.timing.length_bound import MOST_SAMPLES_OF_A_TRAVEL_MOVE, require_bounded
from planner.travel.ruckig_profile import NoSuchMove, RestToRest, between_states, rest_to_rest
from planner.travel.travel_choice import (
    RESTING_SHARE,
    Slopes,
    coordinate_limits,
    quickest_candidates,
    rest_of,
    turning_acceleration,
)

_PROBES = 9
_HEIGHT_PROBES = 33
_FINE = 4
"""Samples per period at which limits are checked."""
_TOPS = (1.02, 1.05, 1.1, 1.2, 1.4, 2.0, 3.0, 5.0)
"""Heights of a hop on the spot, in clearances."""
_TRIED = 40
"""How many of the candidates that are quickest by formulas are made at most, for each travel move."""
_ABOUT = (0.95, 1.0, 1.05)
"""Heights to aim at about the one that formulas find best, as they rank only."""
_SLOWER, _MARGIN = 1.5, 0.98
"""Most that a travel move is slowed by at a time for the tip to keep to its way between samples, and a little beyond
need."""
_HELPED = 0.97
"""Slowing has helped where the tip strays by less than this share of before."""
_JUMP = 1.01
"""A move that was slowed to its limits and still needs to be this much slower jumps from configuration to
configuration."""
_TO_THE_MIDDLE = (0.25, 0.5, 1.0, 2.0)
"""Shares of the way to the middle of their ranges that the joints are to have made at the lift height, one after the
other, where they otherwise leave them."""
_LOW_LIFT = 0.5
"""Share of the lift height that is tried, never below the clearance, where nothing keeps within the joints' ranges."""
_LITTLE = 1.02
"""What a travel move may be slowed by without a look for another."""
_SHARES = (0.7, 0.5, 0.35, 0.25, 0.18)
"""Such a travel move is tried with so much of the limits: one share after the other, as long as that helps."""
_PARTLY = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1))
_TEMPERED = ((False, ((1, 1, 0), *_PARTLY)), (True, ((0, 0, 0), *_PARTLY)))
"""What has the share: the jerk of all joints; the limits for the height, and for the way; and the handover is as many
times as high as it has to be."""
_SAMPLES_AT_ONCE = 100_000
_TOO_SLOW = "choose a higher --lowering-speed, a lower --rate or --lift, or raise the limits of the arm's joints"
_TURN_MARGIN = 0.999
"""Share of the braking that limits allow at a turn: at the very limit rounding decides whether Ruckig accepts."""


@dataclass(frozen=True, slots=True)
class TravelRules:
    """Heights in mm above the paper, the cap on the speed of lowering, the sample rate, and how far the tip may be off
    its way between samples. timing: whether the way up, over and down overlap, or halt in between."""

    clearance_mm: float
    lift_mm: float
    lowering_speed_mm_s: float
    rate_hz: float
    tolerance_mm: float
    timing: Timing = Timing.OPTIMAL


@dataclass(frozen=True, eq=False, slots=True)
class TravelMove:
    """Joint samples (n_samples, n_joints) of a travel move, both ends included.

    exact: False where the pen could not be kept on its way, or a joint left its range, or jumps however slow the move.
    held: whether the tip is within the tolerance between samples. collision: where links would come too close.
    too_long_s: how long it would have to last at least where that is more than a move may, so that its samples break
    limits; 0 where it is not.
    """

    joints: FloatArray
    exact: bool
    held: bool = True
    collision: Collision | None = None
    too_long_s: float = 0.0


def plan_travel_moves(
    kinematics: Kinematics,
    limits: Limits,
    rules: TravelRules,
    start: Sequence[Contact | None],
    end: Sequence[Contact | None],
) -> list[TravelMove]:
    """Travel moves from each `start` to the `end` of the same index. Where one of the two is None the travel move
    begins, or ends, at the lift height above the other, as at the two ends of a drawing."""
    axis_mm = kinematics.arm.paper.T_paper_base[:2, 3] if kinematics.turns_over_paper else None
    shapes = [_Shape.of(rules, axis_mm, one, other) for one, other in zip(start, end, strict=True)]
    lifts = quickest_lifts(kinematics, limits.jerk, np.concatenate([shape.configurations for shape in shapes]))
    lifted = [replace(shape, lifts=pair) for shape, pair in zip(shapes, lifts.reshape(len(shapes), 2, -1), strict=True)]
    moves = _along(kinematics, limits, rules, lifted)
    # The quickest way up may lead a joint out of its range where the way with the least motion does not, or one on
    # which the joints make for the middle of their ranges; and a lower lift leads less far.
    lowest = replace(rules, lift_mm=max(rules.clearance_mm, _LOW_LIFT * rules.lift_mm))
    for height in (rules, lowest):
        for share in (0.0, *_TO_THE_MIDDLE):
            out = [index for index, move in enumerate(moves) if not move.exact and not move.too_long_s]
            if height is not rules:  # the ends of a drawing are at the lift height itself
                out = [index for index in out if shapes[index].contacts == (True, True)]
            others = [shapes[index].centred(kinematics, share / height.lift_mm) for index in out]
            for index, move in zip(out, _along(kinematics, limits, height, others), strict=True):
                moves[index] = move if move.exact else moves[index]
    return moves


def require_bounded_travel_moves(moves: Sequence[TravelMove], rules: TravelRules) -> None:
    """Errors: UsageError where one would last for longer than a move may."""
    require_bounded(
        max((move.too_long_s for move in moves), default=0.0),
        rules.rate_hz,
        "one pen-up move",
        _TOO_SLOW,
        MOST_SAMPLES_OF_A_TRAVEL_MOVE,
    )


def _along(kinematics: Kinematics, limits: Limits, rules: TravelRules, shapes: Sequence[_Shape]) -> list[TravelMove]:
    """Travel moves of these shapes, as quick as they may be.

    One that has to be slowed, as between samples the tip would leave its way or joints their limits, may be quicker
    where only its height, only the way, or all jerk has less of the limits: what stricter limits allow is a candidate.
    """
    if not shapes:
        return []
    slopes = _joint_slopes(kinematics, shapes)
    plans = _timed(shapes, slopes, limits, rules)
    moves = _made(kinematics, limits, rules, plans, np.full(len(plans), np.inf))
    slow = np.flatnonzero([_is_slowed(plan, move, rules) for plan, move in zip(plans, moves, strict=True)])
    for share in _SHARES:
        if not len(slow):
            break
        helped: set[int] = set()
        for with_jerk, tempers in _TEMPERED:
            one = np.repeat(slow, len(tempers))
            height, way, handover = np.tile(share ** np.array(tempers, dtype=float).T, len(slow))
            less = replace(limits, jerk=share * limits.jerk) if with_jerk else limits
            sooner_s = np.array([_sooner_s(moves[index], rules) for index in one.tolist()])
            plans = _timed(
                [shapes[index] for index in one.tolist()],
                slopes.subset(one).steeper(1 / height, 1 / way),
                less,
                rules,
                1 / handover,
                sooner_s,
            )
            quick = [k for k, plan in enumerate(plans) if plan.natural_s <= sooner_s[k]]
            made = _made(kinematics, limits, rules, [plans[k] for k in quick], sooner_s[quick])
            for index, move in zip(one[quick].tolist(), made, strict=True):
                moves[index] = min(moves[index], move, key=_preferred)
            helped.update(one[quick].tolist())
        slow = np.array(sorted(helped), dtype=np.int64)
    return moves


def _preferred(move: TravelMove) -> tuple[bool, bool, int]:
    """The least is the best."""
    return not move.exact, not move.held, len(move.joints)


def _is_slowed(plan: _Timed, move: TravelMove, rules: TravelRules) -> bool:
    """Whether a travel move takes more samples than its plan does, slowed by a little, or slowing does not help it."""
    takes_more = len(move.joints) - 1 > np.ceil(_LITTLE * plan.natural_s * rules.rate_hz)
    return move.exact and not move.too_long_s and bool(takes_more or not move.held)


def _sooner_s(move: TravelMove, rules: TravelRules) -> float:
    """What another travel move may last at most to be better."""
    return (len(move.joints) - 2) / rules.rate_hz if move.held else np.inf


def _made(
    kinematics: Kinematics, limits: Limits, rules: TravelRules, plans: Sequence[_Timed], most_s: FloatArray
) -> list[TravelMove]:
    """Travel moves as planned, slowed by what the limits and the tip's way ask for; as `_held`."""
    if not plans:
        return []
    plans = [plan.lasting(plan.duration_s, rules) for plan in plans]
    fine, _ = _sampled(kinematics, plans, _FINE * rules.rate_hz)
    plans = [
        plan.slowed(limits.slowing_of(joints, 1 / (_FINE * rules.rate_hz)) * 1.0005, rules)
        for plan, joints in zip(plans, fine, strict=True)
    ]
    return _held(kinematics, limits, plans, rules, most_s)


def _held(
    kinematics: Kinematics, limits: Limits, plans: Sequence[_Timed], rules: TravelRules, most_s: FloatArray
) -> list[TravelMove]:
    """The travel moves, each as slow as it has to be for the tip to keep to its way between samples. One that slowing
    does not help, as where configurations jump to another branch, stays as quick as it was before, and so does one that
    would last for longer than `most_s` (n_travel_moves,)."""
    moves: dict[int, TravelMove] = {}
    left, before = np.arange(len(plans)), np.full(len(plans), np.inf)
    while len(left):
        joints, exact = _sampled(kinematics, plans, rules.rate_hz)
        excess = travel_move_excess(
            kinematics,
            joints,
            [plan.shape.ends_mm for plan in plans],
            [plan.shape.contacts for plan in plans],
            rules.clearance_mm,
            rules.tolerance_mm,
        )
        helped = excess < _HELPED * before
        steady = [limits.slowing_of(samples, 1 / rules.rate_hz) < _JUMP for samples in joints]
        moves.update(
            (index, TravelMove(samples, bool(good.all()) and moves, over <= 1.0, too_long_s=plan.too_long_s))
            for index, plan, samples, good, moves, over, kept in zip(
                left.tolist(), plans, joints, exact, steady, excess.tolist(), helped.tolist(), strict=True
            )
            if kept
        )
        over = np.flatnonzero(helped & steady & (excess > 1.0))
        slower = [
            plans[index].slowed(plans[index].factor * min(np.sqrt(excess[index]), _SLOWER) / _MARGIN, rules)
            for index in over.tolist()
        ]
        short = [k for k, plan in enumerate(slower) if plan.duration_s <= most_s[left[over[k]]] * (1 + 1e-9)]
        plans, over = [slower[k] for k in short], over[short]
        left, before = left[over], excess[over]
    return [moves[index] for index in range(len(moves))]


@dataclass(frozen=True, eq=False, slots=True)
class _Shape:
    """The two ends of a travel move, (2, 2), in (radius, azimuth) about the base axis, which meets the paper at
    `axis_mm`, or in (x, y) where that is None; with the independent joints there, how they raise the pen by a mm, and
    the heights there."""

    axis_mm: FloatArray | None
    ends: FloatArray
    configurations: FloatArray
    lifts: FloatArray
    from_mm: float
    to_mm: float

    @staticmethod
    def of(rules: TravelRules, axis_mm: FloatArray | None, start: Contact | None, end: Contact | None) -> _Shape:
        one, other = start or end, end or start
        assert one is not None and other is not None
        ends = np.stack((one.tip_mm, other.tip_mm))
        configurations = np.stack((one.configuration, other.configuration))
        if axis_mm is not None:
            x, y = (ends - axis_mm).T
            azimuth = np.arctan2(y, x)
            turns = (np.diff(configurations[:, 0]) - np.diff(azimuth)) / (2 * np.pi)
            azimuth[1:] += 2 * np.pi * np.trunc(turns + np.copysign(0.25, turns))  # the way round that the joint goes
            ends = np.column_stack((np.hypot(x, y), azimuth))
        return _Shape(
            axis_mm,
            ends,
            configurations,
            np.zeros_like(configurations),
            0.0 if start else rules.lift_mm,
            0.0 if end else rules.lift_mm,
        )

    def centred(self, kinematics: Kinematics, share_per_mm: float) -> _Shape:
        """With configurations that are drawn towards the middle of the joints' ranges by that share of the way for
        every mm of height."""
        arm = kinematics.arm
        middle = kinematics.independent_of(0.5 * (arm.minimum + arm.maximum))
        return replace(self, lifts=share_per_mm * (middle - self.configurations))

    @property
    def ends_mm(self) -> FloatArray:
        """(2, 2) the places over which it begins and ends."""
        return self.tip_mm(np.array([0.0, 1.0]), np.zeros(2))[:, :2]

    @property
    def is_still(self) -> bool:
        """Whether it ends over the place where it begins."""
        return float(np.abs(self.ends[1] - self.ends[0]).max()) < 1e-9

    @property
    def contacts(self) -> tuple[bool, bool]:
        """Whether it begins, and ends, on the paper."""
        return self.from_mm == 0, self.to_mm == 0

    def tip_mm(self, along: FloatArray, height_mm: FloatArray) -> FloatArray:
        """(n, 3) at fractions of the way and heights."""
        places = self.ends[0] + along[:, None] * (self.ends[1] - self.ends[0])
        if self.axis_mm is None:
            return np.column_stack((places, height_mm))
        radius, azimuth = places.T
        x_mm, y_mm = self.axis_mm
        return np.column_stack((x_mm + radius * np.cos(azimuth), y_mm + radius * np.sin(azimuth), height_mm))

    def reference(self, along: FloatArray, height_mm: FloatArray) -> FloatArray:
        """(n, n_independent) independent joints near which the configuration is sought at fractions of the way and
        heights."""
        line = self.configurations[0] + along[:, None] * (self.configurations[1] - self.configurations[0])
        lift = self.lifts[0] + along[:, None] * (self.lifts[1] - self.lifts[0])
        raised: FloatArray = line + height_mm[:, None] * lift
        return raised


@dataclass(frozen=True, eq=False, slots=True)
class _Timed:
    """A travel move's motions: up, over, and down, which is a rise from the end of the travel move played backwards;
    above the clearance, where there is such a motion, from the state of the one to that of the other; all slowed by one
    factor.
    """

    shape: _Shape
    up: RestToRest
    over: RestToRest
    down: RestToRest
    above: RestToRest | None
    over_begins_s: float
    clear_until_s: float
    natural_s: float
    factor: float = 1.0
    too_long_s: float = 0.0

    @property
    def duration_s(self) -> float:
        return self.natural_s * self.factor

    def stays_between(self, rules: TravelRules, handover_mm: float) -> bool:
        """Whether the motion above the handover never dips below it nor leaves the lift height, and lasts for a
        sample."""
        assert self.above is not None
        if self.above.duration_s * rules.rate_hz < 1.0:
            return False
        heights = self.above.at(np.linspace(0.0, self.above.duration_s, _HEIGHT_PROBES))
        return bool(heights.min() >= handover_mm - 1e-6 and heights.max() <= rules.lift_mm)

    def slowed(self, needed: float, rules: TravelRules) -> _Timed:
        """Slowed by what is needed, or sped up by what is left but for the cap on lowering, and on to whole sample
        periods."""
        falls = (self.down.highest_speed, -self.above.lowest_velocity if self.above else 0.0)
        lowering = max(falls) / rules.lowering_speed_mm_s
        duration = self.natural_s * max(needed, lowering)
        whole = max(np.ceil(duration * rules.rate_hz - 1e-9), 1.0) / rules.rate_hz
        return self.lasting(float(whole), rules)

    def lasting(self, duration_s: float, rules: TravelRules) -> _Timed:
        """The same in `duration_s`, or in the longest that a move may last, which is noted then."""
        longest_s = MOST_SAMPLES_OF_A_TRAVEL_MOVE / rules.rate_hz
        fits = duration_s <= longest_s
        return replace(
            self, factor=(duration_s if fits else longest_s) / self.natural_s, too_long_s=0.0 if fits else duration_s
        )

    def way(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Fraction of the way and height in mm at times (n,) after the start."""
        times = times_s / self.factor
        rises_until_s = self.clear_until_s if self.above else self.up.duration_s
        height = np.where(
            times < rises_until_s,
            self.shape.from_mm + self.up.at(times),
            self.shape.to_mm + self.down.at(self.natural_s - times),
        )
        if self.above:
            clear = (times > self.over_begins_s) & (times < self.clear_until_s)
            height[clear] = self.above.at(times[clear] - self.over_begins_s)
        return self.over.at(times - self.over_begins_s), height


def _joint_slopes(kinematics: Kinematics, shapes: Sequence[_Shape]) -> Slopes:
    """How fast joints move with height and along the way, from configurations at a few probes of each travel move."""
    along = np.concatenate((np.zeros(2), np.linspace(0, 1, _PROBES), np.ones(2)))
    up, over, down = (0, 1), slice(2, 2 + _PROBES), (-2, -1)
    height = np.concatenate(([0.0, 1.0], np.full(_PROBES, 1.0), [1.0, 0.0]))
    tips = np.concatenate([shape.tip_mm(along, height) for shape in shapes])
    references = np.concatenate([shape.reference(along, height) for shape in shapes])
    independent, _ = project(kinematics, references, tips)
    joints = kinematics.arm.complete(independent).reshape(len(shapes), len(along), -1)
    return Slopes(
        np.abs(joints[:, up[1]] - joints[:, up[0]]),
        np.abs(joints[:, down[0]] - joints[:, down[1]]),
        np.abs(np.diff(joints[:, over], axis=1)).max(axis=1) * (_PROBES - 1),
    )


def _timed(
    shapes: Sequence[_Shape],
    slopes: Slopes,
    limits: Limits,
    rules: TravelRules,
    handover: FloatArray | float = 1.0,
    most_s: FloatArray | float = np.inf,
) -> list[_Timed]:
    """The quickest motions of every travel move, within the limits as far as joints follow their slopes. They hand over
    at that many (n_travel_moves,) clearances at least; what formulas find no quicker than `most_s` is not looked at."""
    up, down = (_rows(coordinate_limits(slope, limits)) for slope in (slopes.lifting, slopes.lowering))
    heights = [
        _Heights(of_up, (min(of_down[0], rules.lowering_speed_mm_s), *of_down[1:]))
        for of_up, of_down in zip(up, down, strict=True)
    ]
    rest = _ways(shapes, slopes, limits, np.full(len(shapes), RESTING_SHARE))
    least_mm = np.minimum(handover * np.full(len(shapes), rules.clearance_mm), rules.lift_mm)
    best = [
        min(
            (_resting_move(shape, over, height, rules, mm), *_hops_on_the_spot(shape, over, height, rules)),
            key=lambda candidate: candidate.natural_s,
        )
        for shape, over, height, mm in zip(shapes, rest, heights, least_mm.tolist(), strict=True)
    ]
    candidates = quickest_candidates(
        slopes, limits, rules.clearance_mm, rules.lift_mm, rules.lowering_speed_mm_s, least_mm
    )
    can_turn = np.array([shape.contacts == (True, True) for shape in shapes])
    for column in range(min(_TRIED, candidates.seconds.shape[1])):
        so_far_s = np.minimum([candidate.natural_s for candidate in best], most_s)
        moves = np.flatnonzero(can_turn & (candidates.seconds[:, column] < so_far_s))
        if not len(moves):  # what comes later takes longer still
            break
        chosen = [shapes[move] for move in moves.tolist()]
        ways = _ways(chosen, slopes.subset(moves), limits, candidates.share[moves, column])
        aims = map(_Aims, *(getattr(candidates, field.name)[moves, column].tolist() for field in fields(_Aims)))
        for move, shape, way, aim in zip(moves.tolist(), chosen, ways, aims, strict=True):
            best[move] = min(
                (best[move], *_turning_moves(shape, way, heights[move], rules, aim)),
                key=lambda candidate: candidate.natural_s,
            )
    return best


def _ways(shapes: Sequence[_Shape], slopes: Slopes, limits: Limits, share: FloatArray) -> list[RestToRest]:
    """The move over the paper of each travel move, with the limits that a height with that share (n_travel_moves,) of
    them leaves."""
    bounds = _rows(coordinate_limits(slopes.along, rest_of(slopes, limits, share)))
    return [rest_to_rest(0.0 if shape.is_still else 1.0, *each) for shape, each in zip(shapes, bounds, strict=True)]


_Bounds = tuple[float, float, float]
"""Velocity, acceleration and jerk that a coordinate may have."""


@dataclass(frozen=True, slots=True)
class _Heights:
    """Bounds of the height near both ends."""

    up: _Bounds
    down: _Bounds


@dataclass(frozen=True, slots=True)
class _Aims:
    """What a travel move is to be like: a row of `Candidates`."""

    share: float
    handover_mm: float
    rise_mm: float
    fall_mm: float
    fall_mm_s: float
    cap_mm_s: float


def _rows(limits: Limits) -> list[_Bounds]:
    return list(zip(limits.velocity.tolist(), limits.acceleration.tolist(), limits.jerk.tolist(), strict=True))


def _turning_moves(
    shape: _Shape, over: RestToRest, heights: _Heights, rules: TravelRules, aims: _Aims
) -> Iterator[_Timed]:
    """The ways that aim at about that height and turn without a halt, those that there are."""
    for about in _ABOUT:
        try:
            candidate = _turning_move(shape, over, heights, replace(aims, rise_mm=about * aims.rise_mm))
        except NoSuchMove:
            continue
        if candidate.stays_between(rules, aims.handover_mm):
            yield candidate


def _turning_move(shape: _Shape, over: RestToRest, heights: _Heights, aims: _Aims) -> _Timed:
    """The travel move whose rise and fall aim at these heights. Errors: NoSuchMove."""
    slow = (min(heights.down[0], aims.fall_mm_s), *heights.down[1:])
    up, down = _rise(aims.rise_mm, heights.up), _rise(aims.fall_mm, slow)
    clear = [rise.time_at(aims.handover_mm) for rise in (up, down)]
    (up_speed, up_braking), (down_speed, down_braking) = (
        rise.state_at(time) for rise, time in zip((up, down), clear, strict=True)
    )
    # Above the handover any acceleration will do: that of its ends is within the limits, and jerk keeps others small.
    push = max(min(heights.up[1], heights.down[1]), abs(up_braking), abs(down_braking))
    above = between_states(
        aims.handover_mm,
        (up_speed, up_braking),
        (-down_speed, down_braking),
        -min(heights.down[0], aims.cap_mm_s) / _TURN_MARGIN,
        (heights.up[0], push, aims.share * min(heights.up[2], heights.down[2])),
        over.duration_s,
    )
    until = clear[0] + above.duration_s
    return _Timed(shape, up, over, down, above, clear[0], until, until + clear[1])


def _hops_on_the_spot(shape: _Shape, over: RestToRest, heights: _Heights, rules: TravelRules) -> Iterator[_Timed]:
    """The travel move that ends where it begins: up and down again with one and the same braking at the top, as low as
    leaves a sample above the clearance. There is none where the pen is to go elsewhere, or so high."""
    if not shape.is_still or shape.contacts != (True, True):
        return
    for aim in _TOPS:
        top_mm = aim * rules.clearance_mm
        if top_mm > rules.lift_mm:
            return
        turning = _TURN_MARGIN * min(
            min(float(turning_acceleration(np.array(top_mm), np.array(jerk), velocity)), acceleration)
            for velocity, acceleration, jerk in (heights.up, heights.down)
        )
        up, down = (rest_to_rest(top_mm, *bounds, turning) for bounds in (heights.up, heights.down))
        clear = [rise.time_at(rules.clearance_mm) for rise in (up, down)]
        natural = up.duration_s + down.duration_s
        if (natural - sum(clear)) * rules.rate_hz >= 1.0:
            yield _Timed(shape, up, over, down, None, clear[0], natural - clear[1], natural)
            return


def _rise(top_mm: float, bounds: _Bounds) -> RestToRest:
    """The rise from rest that turns at the top, braking as hard there as the bounds allow."""
    velocity, acceleration, jerk = bounds
    turning = float(turning_acceleration(np.array(top_mm), np.array(jerk), velocity))
    return rest_to_rest(top_mm, *bounds, _TURN_MARGIN * min(turning, acceleration))


def _resting_move(shape: _Shape, over: RestToRest, heights: _Heights, rules: TravelRules, handover_mm: float) -> _Timed:
    """The travel move that is at rest at the lift height, and goes over the paper from that handover on."""
    up, down = (
        rest_to_rest(rules.lift_mm - foot, bounds[0], RESTING_SHARE * bounds[1], RESTING_SHARE * bounds[2])
        for foot, bounds in ((shape.from_mm, heights.up), (shape.to_mm, heights.down))
    )
    clear = [
        rise.time_at(handover_mm) if rules.lift_mm > handover_mm > foot else rise.duration_s
        for rise, foot in ((up, shape.from_mm), (down, shape.to_mm))
    ]
    natural = max(up.duration_s + down.duration_s, clear[0] + over.duration_s + clear[1])
    return _Timed(shape, up, over, down, None, clear[0], natural - clear[1], natural)


def _sampled(
    kinematics: Kinematics, plans: Sequence[_Timed], rate_hz: float
) -> tuple[list[FloatArray], list[BoolArray]]:
    """Joint samples of every travel move, and where they are exact and within limits; some travel moves at a time."""
    group = (np.cumsum([plan.duration_s for plan in plans]) * rate_hz) // _SAMPLES_AT_ONCE
    joints, exact = [], []
    for one in sorted(set(group.tolist())):
        more, good = _sampled_together(kinematics, [plans[k] for k in np.flatnonzero(group == one).tolist()], rate_hz)
        joints += more
        exact += good
    return joints, exact


def _sampled_together(
    kinematics: Kinematics, plans: Sequence[_Timed], rate_hz: float
) -> tuple[list[FloatArray], list[BoolArray]]:
    references, tips, counts = [], [], []
    for plan in plans:
        count = round(plan.duration_s * rate_hz) if plan.factor != 1.0 else int(np.ceil(plan.duration_s * rate_hz))
        along, height = plan.way(np.arange(count + 1) / rate_hz)
        references.append(plan.shape.reference(along, height))
        tips.append(plan.shape.tip_mm(along, height))
        counts.append(count + 1)
    independent, exact = project(kinematics, np.concatenate(references), np.concatenate(tips))
    joints = kinematics.arm.complete(independent)
    exact &= within_limits(kinematics.arm, joints)
    bounds = np.cumsum(counts)[:-1]
    return np.split(joints, bounds), np.split(exact, bounds)
