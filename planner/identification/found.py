"""Limits that an arm is found to have: by what was measured of a test motion, or by what somebody saw of it.

A step that is not followed asks for too much of something. It is what its ladder tries, where all else that the step
asks for was followed in the other ladders; or else nothing is told of it but what was followed. Nothing is proposed
that was not followed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from planner.arms.arm import Arm
from planner.errors import CalibrationError
from planner.identification.measured import Measured
from planner.identification.motion import LadderMotion, Step, greatest_differences, limits_of
from planner.identification.profile import Limits, Quantity, there_and_back
from planner.identification.response import BY, Following, Trial, answer, followings

MARGIN = {Quantity.VELOCITY: 0.95, Quantity.ACCELERATION: 0.9, Quantity.JERK: 0.9}
"""Of what was followed, what is proposed: servos get warm, and batteries empty."""
_FEWEST_A_WAY = 4
_CHANGED = 0.05
_CLOSE = 1.15**2
"""A limit is found where the first step that is not followed asks for no more than so many times the last that is: its
middle is off by 15 % at most."""


class Outcome(Enum):
    FOUND = "found"
    ROUGHLY = "between two steps that are far apart"
    HIDDEN = "something else gave in first"
    NOT_REACHED = "every step was followed"
    UNKNOWN = "nothing was told by any step"


@dataclass(frozen=True, slots=True)
class Found:
    """Of a joint, in rad or mm. followed: the most that was, 0 where nothing is known; beyond: what the first step
    asked for that was not, infinite where there is none. step: of `steps`, the last that was followed. proposed: for
    the arm file; what that says already where nothing speaks against it. hidden_by: what may have given in before
    it."""

    joint: int
    quantity: Quantity
    outcome: Outcome
    step: int
    steps: int
    followed: float
    beyond: float
    proposed: float
    hidden_by: tuple[Quantity, ...] = ()


def found_by_positions(
    arm: Arm, motion: LadderMotion, measured: Measured, source: str, joints: Sequence[int] | None = None
) -> list[Found]:
    """joints: which, None for all. Errors: CalibrationError where too little of a joint was measured."""
    found = []
    rate_hz = motion.trajectory.rate_hz
    for joint in range(arm.n_joints) if joints is None else joints:
        ladders = motion.ladders(joint)
        trials = {
            quantity: [_trial(arm, motion, measured, step, source) for step in ladder]
            for quantity, ladder in ladders.items()
        }
        followed = dict(zip(ladders, followings(list(trials.values()), rate_hz), strict=True))
        asked = {
            quantity: [
                _asked(step, trial, followed[quantity], rate_hz)
                for step, trial in zip(ladder, trials[quantity], strict=True)
            ]
            for quantity, ladder in ladders.items()
        }
        found += _found(
            arm, joint, ladders, asked, {quantity: (one.followed, one.refused) for quantity, one in followed.items()}
        )
    return found


def found_by_verdicts(arm: Arm, motion: LadderMotion, verdicts: Mapping[str, Mapping[Quantity, int]]) -> list[Found]:
    """verdicts: of each joint the last step of each ladder that looked right, 0 for none. Errors: CalibrationError for
    a step that there is not."""
    found = []
    for name, numbers in verdicts.items():
        joint = [one.name for one in arm.joints].index(name)
        ladders = motion.ladders(joint)
        for quantity, number in numbers.items():
            if number > len(ladders.get(quantity, ())):
                raise CalibrationError(
                    "--verdicts",
                    f"joint {name} has {len(ladders.get(quantity, ()))} steps of {quantity}, from 1 on; there is no"
                    f" {number}",
                )
        asked = {quantity: [step.levels for step in ladder] for quantity, ladder in ladders.items()}
        followed = {
            quantity: (numbers[quantity], numbers[quantity] + 1 if numbers[quantity] < len(ladder) else None)
            for quantity, ladder in ladders.items()
        }
        found += _found(arm, joint, ladders, asked, followed)
    return found


def _found(
    arm: Arm,
    joint: int,
    ladders: Mapping[Quantity, Sequence[Step]],
    asked: Mapping[Quantity, list[Limits]],
    followed: Mapping[Quantity, tuple[int, int | None]],
) -> list[Found]:
    """asked: of the motor, by each step of the ladders of a joint; of which so many were followed, and from some step
    on none was."""
    most = {
        quantity: max(
            (
                one.of(quantity)
                for ladder, steps in asked.items()
                if ladder is quantity or quantity is Quantity.VELOCITY  # which shows wherever it gives in
                for one in steps[: followed[ladder][0]]
            ),
            default=0.0,
        )
        for quantity in Quantity
    }
    refused = {quantity: asked[quantity][strange - 1] for quantity, (_, strange) in followed.items() if strange}
    suspects = {
        ladder: [quantity for quantity in Quantity if quantity is ladder or step.of(quantity) > most[quantity]]
        for ladder, step in refused.items()
    }
    found = []
    for quantity, before in limits_of(arm.joints[joint]).pairs():
        number, strange = followed.get(quantity, (0, None))
        beyond = ladders[quantity][strange - 1].level if strange else np.inf
        others = tuple(one for one in suspects.get(quantity, ()) if one is not quantity)
        if not most[quantity]:
            outcome = Outcome.UNKNOWN
        elif not strange:
            outcome = Outcome.NOT_REACHED
        elif others:
            outcome = Outcome.HIDDEN
        else:
            outcome = Outcome.FOUND if beyond <= _CLOSE * most[quantity] else Outcome.ROUGHLY
        is_bracket = outcome in (Outcome.FOUND, Outcome.ROUGHLY)
        doubted = any(before > step.of(quantity) for ladder, step in refused.items() if quantity in suspects[ladder])
        proposed = MARGIN[quantity] * most[quantity]
        if outcome is Outcome.UNKNOWN or not (is_bracket or doubted or proposed > before):
            proposed = before
        per = arm.joints[joint].per_file_unit
        rounded = _three_digits(proposed / per) * per if proposed != before else before
        found.append(
            Found(
                joint,
                quantity,
                outcome,
                number,
                len(ladders.get(quantity, ())),
                most[quantity],
                beyond,
                rounded,
                others if outcome is Outcome.HIDDEN else (),
            )
        )
    return found


def may_tell_more(arm: Arm, found: Sequence[Found]) -> list[int]:
    """Joints that another test motion, of an arm with what is proposed, may tell more of."""
    return [
        joint
        for joint in sorted({one.joint for one in found})
        if any(one.joint == joint and one.outcome is not Outcome.FOUND for one in found)
        and any(
            abs(one.proposed / limits_of(arm.joints[joint]).of(one.quantity) - 1) > _CHANGED
            for one in found
            if one.joint == joint
        )
    ]


def with_limits(arm: Arm, found: list[Found]) -> Arm:
    """The arm with the proposed limits."""
    joints = list(arm.joints)
    for one in found:
        key = f"max_{one.quantity}"
        joints[one.joint] = replace(joints[one.joint], **{key: one.proposed})  # type: ignore[arg-type]
    return replace(arm, joints=tuple(joints))


def _asked(step: Step, trial: Trial, following: Following, rate_hz: float) -> Limits:
    """What a step asks of the motor, behind its lag, and not above what it is told."""
    behind = greatest_differences(answer(trial.told, following.weights, rate_hz), rate_hz)
    return Limits(*(min(one, behind.of(quantity)) for quantity, one in step.levels.pairs()))


def _three_digits(value: float) -> float:
    """Rounded down."""
    scale = 10.0 ** (np.floor(np.log10(value)) - 2)
    return float(np.floor(value / scale + 1e-9) * scale)


def _trial(arm: Arm, motion: LadderMotion, measured: Measured, step: Step, source: str) -> Trial:
    trajectory = motion.trajectory
    rate_hz = trajectory.rate_hz
    told = arm.from_file_units(trajectory.positions[step.first : step.last + 1])[:, step.joint]
    begin_s, end_s = step.first / trajectory.rate_hz, step.last / trajectory.rate_hz
    times_s, positions = measured.of(step.joint)
    inside = (times_s > begin_s) & (times_s <= end_s)
    ways = (step.last - step.first) // step.n_way
    if np.count_nonzero(inside) < _FEWEST_A_WAY * ways:
        raise CalibrationError(
            source,
            f"joint {arm.joints[step.joint].name} was measured {np.count_nonzero(inside)} times in step {step.number}"
            f" of {step.quantity}; {_FEWEST_A_WAY * ways} times are needed: a faster --baud may give more",
        )
    limited = told[0] + there_and_back(step.way.limited(step.quantity, BY), rate_hz, step.n_way)
    return Trial(told, limited, times_s[inside] - begin_s, positions[inside], step.n_way, step.n_rest)
