"""A test motion: one joint after the other goes back and forth, each step of it a little harder than the one before.

Two ladders a joint. The first climbs in jerk, at an acceleration below the arm's limit; the second in acceleration,
with as little jerk as speed and room allow, until that goes beyond the factor too. The joint comes slowly to where its
ladders begin, and goes slowly back.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import PlanError
from planner.identification.profile import Way, there_and_back, way_of_acceleration, way_of_jerk
from planner.identification.room import room_of
from planner.trajectory import TEST_MOTION, TRAVELLING, Trajectory

USUAL_FACTOR, LEAST_FACTOR, MOST_FACTOR = 3.0, 1.2, 10.0
FIRST = 0.6
"""The first step, as a factor of the arm's limits: well within what they should be."""
RATIO = 1.05
_ACCELERATION = 0.8
"""Of its limit, where it is jerk that is tried."""
_VELOCITY = 0.95
_SLOW = 0.2
"""Of every limit, on the way to a ladder and back."""
_REST_S = 0.5
_GROWS = 1.01
"""A step that samples at the rate cannot show to be harder than the one before is none."""
_FEWEST = 8


class Quantity(StrEnum):
    JERK = "jerk"
    ACCELERATION = "acceleration"

    @property
    def order(self) -> int:
        return 3 if self is Quantity.JERK else 2


@dataclass(frozen=True, slots=True)
class Step:
    """Samples `first` to `last` of the motion. number: from 1 on, in its ladder. n_way, n_rest: samples of each way
    with its rest, and of the rest. level: the greatest difference of the samples, of the order of what is tried."""

    joint: int
    quantity: Quantity
    number: int
    first: int
    last: int
    n_way: int
    n_rest: int
    level: float


@dataclass(frozen=True, eq=False, slots=True)
class LadderMotion:
    """trajectory: with the pen up from end to end. steps: in their order."""

    trajectory: Trajectory
    steps: tuple[Step, ...]

    def ladder(self, joint: int, quantity: Quantity) -> tuple[Step, ...]:
        return tuple(step for step in self.steps if step.joint == joint and step.quantity is quantity)


def make_motion(arm: Arm, name: str, reach: FloatArray | None, rate_hz: float, factor: float) -> LadderMotion:
    """The test motion of `arm`, which its trajectory calls `name`, up to `factor` times its limits of acceleration and
    jerk. The same for the same arguments. reach: (n_joints, 2) where its servos get to. Errors: PlanError."""
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


def _ladders(
    arm: Arm, joint: int, low: float, length: float, rate_hz: float, factor: float, begin: int
) -> tuple[FloatArray, list[Step]]:
    """Positions (n,) of a joint, which is at `low` at sample `begin`, after that; and the steps. Errors: PlanError."""
    positions, steps = [], []
    for quantity in Quantity:
        level, number = 0.0, 0
        for at in FIRST * RATIO ** np.arange(int(np.log(factor / FIRST) / np.log(RATIO) + 1e-9) + 1):
            way = _way(arm, joint, quantity, float(at), length)
            if way.jerk > factor * arm.joints[joint].max_jerk:
                break
            samples, n_way, n_rest = there_and_back(way, rate_hz)
            reached = float(np.abs(np.diff(samples, quantity.order)).max()) * rate_hz**quantity.order
            if reached < _GROWS * level:
                break
            level, number = reached, number + 1
            positions.append(low + samples[1:])
            last = begin + len(samples) - 1
            steps.append(Step(joint, quantity, number, begin, last, n_way, n_rest, level))
            begin = last
        if number < _FEWEST:
            raise PlanError(
                f"arm {arm.name}: joint {arm.joints[joint].name} has room for {number} step(s) of {quantity}, of"
                f" {_FEWEST} that are needed; a higher --rate, or another park pose, may give it more"
            )
    return np.concatenate(positions), steps


def _way(arm: Arm, joint: int, quantity: Quantity, at: float, length: float) -> Way:
    one = arm.joints[joint]
    velocity = _VELOCITY * one.max_velocity
    if quantity is Quantity.JERK:
        return way_of_jerk(at * one.max_jerk, _ACCELERATION * one.max_acceleration, velocity, length)
    return way_of_acceleration(at * one.max_acceleration, velocity, length)


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
    """How many times the limits of acceleration and jerk the motion goes to, rounded up."""
    shares = [
        np.abs(np.diff(positions, order, axis=0)).max(axis=0) * rate_hz**order / limit
        for order, limit in ((2, arm.max_acceleration), (3, arm.max_jerk))
    ]
    return float(np.ceil(100 * np.max(shares)) / 100)
