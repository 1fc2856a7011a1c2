"""Limits that an arm is found to have: by what was measured of a test motion, or by what somebody saw of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from planner.arms.arm import Arm
from planner.errors import CalibrationError
from planner.identification.measured import Measured
from planner.identification.motion import LadderMotion, Quantity, Step
from planner.identification.response import GENTLE, Trial, answer, steps_followed

MARGIN = {Quantity.JERK: 0.83, Quantity.ACCELERATION: 0.9}
"""Of what was found, what is proposed: a step that is not quite followed may not show, jerk less than acceleration, and
servos get warm."""
_NOISE = 0.0005
"""Least error that shows, as a share of a way."""
_FEWEST_A_WAY = 4
_AT_LIMIT = 0.95


@dataclass(frozen=True, slots=True)
class Found:
    """Of a joint, in rad or mm: the hardest that was followed, of `step` of `steps`; is_end: whether that was followed
    because nothing harder was asked; by_jerk: whether the next one asked for more jerk than the joint has. proposed:
    the limit for the arm file."""

    joint: int
    quantity: Quantity
    step: int
    steps: int
    level: float
    is_end: bool
    by_jerk: bool
    proposed: float


def found_by_positions(arm: Arm, motion: LadderMotion, measured: Measured, source: str) -> list[Found]:
    """Errors: CalibrationError where too little of a joint was measured, or it follows nothing."""
    found = []
    for joint in range(arm.n_joints):
        jerk = found_of_ladder(arm, motion, measured, joint, Quantity.JERK, source, np.inf)
        found += [jerk, found_of_ladder(arm, motion, measured, joint, Quantity.ACCELERATION, source, jerk.level)]
    return found


def found_of_ladder(
    arm: Arm, motion: LadderMotion, measured: Measured, joint: int, quantity: Quantity, source: str, most_jerk: float
) -> Found:
    """By one ladder of a joint. most_jerk: what the joint was found to follow. Errors: as `found_by_positions`."""
    ladder = motion.ladder(joint, quantity)
    rate_hz = motion.trajectory.rate_hz
    trials = [_trial(arm, motion, measured, step, source) for step in ladder]
    followed, weights = steps_followed(trials, rate_hz, _NOISE * float(np.ptp(trials[0].told)))
    if followed == GENTLE:
        raise CalibrationError(
            source,
            f"joint {arm.joints[joint].name} follows none of the steps of {quantity} after the gentlest {GENTLE} as it"
            " follows these: its limits in the arm file are too high, or what was measured is too coarse; halve them,"
            " and plan another test motion",
        )

    def level(step: int, order: int) -> float:
        """Of its answer, and not above what it was told."""
        most = [
            np.abs(np.diff(one, order)).max()
            for one in (answer(trials[step].told, weights, rate_hz), trials[step].told)
        ]
        return float(min(most)) * rate_hz**order

    is_end = followed == len(ladder)
    by_jerk = quantity is Quantity.ACCELERATION and not is_end and level(followed, 3) > _AT_LIMIT * most_jerk
    return _proposed(arm, ladder[followed - 1], len(ladder), level(followed - 1, quantity.order), is_end, by_jerk)


def found_by_verdicts(arm: Arm, motion: LadderMotion, verdicts: Mapping[str, tuple[int, int]]) -> list[Found]:
    """verdicts: of each joint the last steps, of jerk and of acceleration, that looked right. Errors:
    CalibrationError for a step that there is not."""
    found = []
    for name, numbers in verdicts.items():
        joint = [one.name for one in arm.joints].index(name)
        for quantity, number in zip(Quantity, numbers, strict=True):
            ladder = motion.ladder(joint, quantity)
            if not 1 <= number <= len(ladder):
                raise CalibrationError(
                    "--verdicts", f"joint {name} has {len(ladder)} steps of {quantity}, from 1 on; there is no {number}"
                )
            step = ladder[number - 1]
            found.append(_proposed(arm, step, len(ladder), step.level, number == len(ladder), by_jerk=False))
    return found


def with_limits(arm: Arm, found: list[Found]) -> Arm:
    """The arm with the proposed limits."""
    joints = list(arm.joints)
    for one in found:
        key = f"max_{one.quantity}"
        joints[one.joint] = replace(joints[one.joint], **{key: one.proposed})  # type: ignore[arg-type]
    return replace(arm, joints=tuple(joints))


def _proposed(arm: Arm, step: Step, steps: int, level: float, is_end: bool, by_jerk: bool) -> Found:
    """A limit that was never reached is not lowered, and one that jerk hid is left as it is."""
    one = arm.joints[step.joint]
    before = one.max_jerk if step.quantity is Quantity.JERK else one.max_acceleration
    proposed = (
        before if by_jerk else max(before, MARGIN[step.quantity] * level) if is_end else MARGIN[step.quantity] * level
    )
    rounded = _three_digits(proposed / one.per_file_unit) * one.per_file_unit if proposed != before else before
    return Found(step.joint, step.quantity, step.number, steps, level, is_end, by_jerk, rounded)


def _three_digits(value: float) -> float:
    """Rounded down."""
    scale = 10.0 ** (np.floor(np.log10(value)) - 2)
    return float(np.floor(value / scale + 1e-9) * scale)


def _trial(arm: Arm, motion: LadderMotion, measured: Measured, step: Step, source: str) -> Trial:
    trajectory = motion.trajectory
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
    return Trial(told, times_s[inside] - begin_s, positions[inside], step.n_way, step.n_rest)
