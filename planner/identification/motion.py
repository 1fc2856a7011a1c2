"""A test motion: one joint after the other goes back and forth, each step of it a little harder than the one before.

Three ladders a joint, in velocity, in acceleration, and in jerk. Each begins at a tenth of the limits of the arm file,
which may be far too high. Up to these limits all three grow together, so that a step is the one before on a larger
scale, and the tried one is nearer to its limit than the others; beyond, it grows alone. Ladders keep to the middle of
the room of a joint: one that does not follow overshoots. The joint comes slowly to where its ladders begin, and goes
slowly back.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.arms.arm import Arm, Joint
from planner.arrays import FloatArray
from planner.identification.profile import HELD, Limits, Quantity, Way, fastest, samples_of_way, there_and_back, way_at
from planner.identification.room import room_of
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
        low, high = float(room.low[joint]), float(room.high[joint])
        there = _slowly(arm, joint, float(room.pose[joint]), low, rate_hz)
        ladders, found = _ladders(arm, joint, low, high - low, rate_hz, factor, n_samples + len(there) - 1)
        line = np.concatenate((there, ladders, _slowly(arm, joint, low, float(room.pose[joint]), rate_hz)))
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
    arm: Arm, joint: int, low: float, length: float, rate_hz: float, factor: float, begin: int
) -> tuple[FloatArray, list[Step]]:
    """Positions (n,) of a joint, which is at `low` at sample `begin`, after that; and the steps."""
    positions, steps = [np.empty(0)], []
    for quantity in Quantity:
        level, number = 0.0, 0
        for scale in scales(factor):
            way = _way(arm.joints[joint], quantity, scale, length)
            if way is None or way.jerk > factor * arm.joints[joint].max_jerk:
                break
            n_way, n_rest = samples_of_way(way, rate_hz)
            samples = there_and_back(way, rate_hz, n_way)
            levels = greatest_differences(samples, rate_hz)
            if levels.of(quantity) < _GROWS * level:
                break
            level, number = levels.of(quantity), number + 1
            positions.append(low + samples[1:])
            last = begin + len(samples) - 1
            steps.append(Step(joint, quantity, number, begin, last, n_way, n_rest, way, levels))
            begin = last
    return np.concatenate(positions), steps


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
