"""A test motion: one joint after the other goes back and forth, each step of it a little harder than the one before.

Three ladders a joint, in velocity, in acceleration, and in jerk. Each begins at a tenth of the limits of the arm file,
which may be far too high. Up to these limits all three grow together, so that a step is the one before on a larger
scale, and the tried one is nearer to its limit than the others; beyond, it grows alone. A joint that does not follow
overshoots, the further the more is asked of it: ways are so short, and so much in the middle of the room of a joint,
that it ends where nothing is touched. The joint comes slowly to where each ladder begins, and goes slowly back.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.arms.arm import Arm, Joint
from planner.arrays import FloatArray
from planner.identification.profile import HELD, Limits, Quantity, Way, fastest, samples_of_way, there_and_back, way_at
from planner.identification.room import BEYOND, Room, room_of
from planner.trajectory import TEST_MOTION, TRAVELLING, Trajectory

USUAL_FACTOR, LEAST_FACTOR, MOST_FACTOR = 1.6, 0.2, 10.0
FIRST, _FINE_FROM = 0.1, 0.5
"""The first step, and the one from which on they are small, as factors of the arm's limits."""
COARSE, FINE = 1.25, 1.08
_OTHERS = {
    Quantity.VELOCITY: Limits(1.0, 0.75, 0.75),
    Quantity.ACCELERATION: Limits(0.75, 1.0, 0.8),
    Quantity.JERK: Limits(0.75, 0.8, 1.0),
}
"""Of the limits, where one of them is tried."""
_MOST_SPEED = 0.95
_OVERSHOOT = 0.75
"""Of a way, for each time the file's limit that is asked of acceleration or jerk: by so much a joint overshoots at most
which has three quarters of them. One that lacks speed alone is late, and hardly overshoots."""
_NEEDED = 1.15
"""So many times the scale of a step, jerk may be needed to reach an acceleration: it makes joints overshoot most."""
_SLOW = 0.1
"""Of every limit, on the way to a ladder and back: as its first step."""
_REST_S = 0.5
_GROWS = 1.01
"""A step that samples at the rate cannot show to be harder than the one before is none."""


@dataclass(frozen=True, slots=True)
class Step:
    """Samples `first` to `last` of the motion. number: from 1 on, in its ladder. n_way, n_rest: samples of each way
    with its rest, and of the rest. levels: the greatest differences of the samples."""

    joint: int
    quantity: Quantity
    number: int
    first: int
    last: int
    n_way: int
    n_rest: int
    way: Way
    levels: Limits

    @property
    def level(self) -> float:
        """Of what is tried."""
        return self.levels.of(self.quantity)


@dataclass(frozen=True, eq=False, slots=True)
class LadderMotion:
    """trajectory: with the pen up from end to end. steps: in their order."""

    trajectory: Trajectory
    steps: tuple[Step, ...]

    def ladders(self, joint: int) -> dict[Quantity, tuple[Step, ...]]:
        """Of a joint, without those that there is no room for."""
        found: dict[Quantity, tuple[Step, ...]] = {}
        for step in self.steps:
            if step.joint == joint:
                found[step.quantity] = (*found.get(step.quantity, ()), step)
        return found


def make_motion(arm: Arm, name: str, reach: FloatArray | None, rate_hz: float, factor: float) -> LadderMotion:
    """The test motion of `arm`, which its trajectory calls `name`, up to `factor` times its limits. The same for the
    same arguments. reach: (n_joints, 2) where its servos get to. Errors: PlanError."""
    room = room_of(arm, reach)
    parts = [room.pose[None]]
    steps: list[Step] = []
    n_samples = 1
    for joint in range(arm.n_joints):
        line, found = _ladders(arm, joint, room, rate_hz, factor, n_samples - 1)
        moved = np.repeat(room.pose[None], len(line), axis=0)
        moved[:, joint] = line
        parts.append(moved)
        steps += found
        n_samples += len(line)
    positions = np.concatenate(parts)
    trajectory = Trajectory(
        arm=name,
        drawing="",
        method=TEST_MOTION,
        rate_hz=rate_hz,
        columns=arm.column_names,
        positions=arm.to_file_units(positions),
        pen=np.zeros(n_samples, dtype=np.bool_),
        stroke=np.full(n_samples, TRAVELLING),
        svg_to_arm_mm=(0.0, -1.0, -1.0, 0.0, 0.0, 0.0),
        paper=arm.paper,
        beyond_limits=_beyond(arm, positions, rate_hz),
    )
    return LadderMotion(trajectory, tuple(steps))


def scales(factor: float) -> list[float]:
    """The steps of a ladder, as factors of the arm's limits."""
    found = [FIRST]
    while found[-1] < factor:
        found.append(min(found[-1] * (COARSE if found[-1] * COARSE < _FINE_FROM else FINE), factor))
    return found


def _ladders(
    arm: Arm, joint: int, room: Room, rate_hz: float, factor: float, begin: int
) -> tuple[FloatArray, list[Step]]:
    """Positions (n,) of a joint after sample `begin`, at which all joints wait, until it does again; and the steps."""
    pose, low, high = (float(one[joint]) for one in (room.pose, room.low, room.high))
    positions, steps, at = [np.empty(0)], [], pose
    for quantity in Quantity:
        ladder = _ladder(arm.joints[joint], quantity, high - low, rate_hz, factor)
        for number, (way, samples, levels) in enumerate(ladder, 1):
            start = (low + high - max(later.length for later, *_ in ladder[number - 1 :])) / 2
            if start != at:
                positions.append(_slowly(arm, joint, at, start, rate_hz))
                begin, at = begin + len(positions[-1]), start
            positions.append(start + samples[1:])
            last = begin + len(samples) - 1
            n_way, n_rest = samples_of_way(way, rate_hz)
            steps.append(Step(joint, quantity, number, begin, last, n_way, n_rest, way, levels))
            begin = last
    positions.append(_slowly(arm, joint, at, pose, rate_hz))
    return np.concatenate(positions), steps


def _ladder(
    joint: Joint, quantity: Quantity, room: float, rate_hz: float, factor: float
) -> list[tuple[Way, FloatArray, Limits]]:
    """The ways in the middle of a room; samples (n,) of each there and back, from 0 on; and their levels."""
    ladder: list[tuple[Way, FloatArray, Limits]] = []
    for scale in scales(factor):
        way = _way(joint, quantity, scale, _longest(quantity, room, scale))
        if way is None or way.jerk > min(factor, max(1.0, _NEEDED * scale)) * joint.max_jerk:
            break
        samples = there_and_back(way, rate_hz, samples_of_way(way, rate_hz)[0])
        levels = greatest_differences(samples, rate_hz)
        if ladder and levels.of(quantity) < _GROWS * ladder[-1][2].of(quantity):
            break
        ladder.append((way, samples, levels))
    return ladder


def _longest(quantity: Quantity, room: float, scale: float) -> float:
    """How long a way D may be in the middle of a room, that an overshoot by a share o of it stays within what is clear:
    o D = (room - D) / 2 + what is clear beyond the room."""
    if quantity is Quantity.VELOCITY:
        return room
    return room * (0.5 + BEYOND) / (0.5 + _OVERSHOOT * max(scale, 1.0))


def greatest_differences(samples: FloatArray, rate_hz: float) -> Limits:
    """Of each order, of (n,) samples."""
    return Limits(*(float(np.abs(np.diff(samples, order)).max()) * rate_hz**order for order in (1, 2, 3)))


def _way(joint: Joint, quantity: Quantity, scale: float, length: float) -> Way | None:
    """Up to the limits everything grows, and beyond what is tried."""
    together, limits = min(scale, 1.0), limits_of(joint)
    shares = _OTHERS[quantity]
    if quantity is Quantity.VELOCITY:
        limits = replace(limits, velocity=min(limits.velocity, fastest(shares.products(limits), length)))
    most = Limits(*(together * shares.of(one) * limit for one, limit in limits.pairs()))
    if quantity is Quantity.ACCELERATION:  # it takes speed to reach it
        needed = (1 + HELD) * limits.acceleration**2 / most.jerk * together**2
        most = replace(most, velocity=min(max(most.velocity, needed), _MOST_SPEED * together * limits.velocity))
    return way_at(quantity, most.with_one(quantity, scale * limits.of(quantity)), together * length)


def limits_of(joint: Joint) -> Limits:
    return Limits(joint.max_velocity, joint.max_acceleration, joint.max_jerk)


def _slowly(arm: Arm, joint: int, start: float, goal: float, rate_hz: float) -> FloatArray:
    """(n,) from rest to rest, the start left out, and a rest."""
    one, length = arm.joints[joint], abs(goal - start)
    duration_s = max(  # of 10u^3 - 15u^4 + 6u^5, whose derivatives are 15/8, 5.77 and 60 at most
        15 / 8 * length / (_SLOW * one.max_velocity),
        np.sqrt(5.78 * length / (_SLOW * one.max_acceleration)),
        np.cbrt(60 * length / (_SLOW * one.max_jerk)),
    )
    n = max(int(np.ceil(duration_s * rate_hz)), 1)
    u = np.arange(1, n + 1) / n
    way: FloatArray = start + (goal - start) * (10 * u**3 - 15 * u**4 + 6 * u**5)
    return np.concatenate((way, np.full(round(_REST_S * rate_hz), goal)))


def _beyond(arm: Arm, positions: FloatArray, rate_hz: float) -> float:
    """How many times its limits the motion goes to, rounded up; 1 where it keeps to them."""
    shares = [
        np.abs(np.diff(positions, order, axis=0)).max(axis=0) * rate_hz**order / limit
        for order, limit in ((1, arm.max_velocity), (2, arm.max_acceleration), (3, arm.max_jerk))
    ]
    return max(float(np.ceil(100 * np.max(shares) - 1e-6) / 100), 1.0)
