"""What a person finds out about an arm by moving one joint at a time, as changes of its description.

Each takes an arm and gives a new one; values are what the servo is told, in us or counts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hardware.compensation.servo_values import own_calibration
from planner.arms.arm import Arm, Joint, Servo
from planner.arrays import FloatArray
from planner.errors import UsageError

_ROUNDING = 1e-9


def turned_round(arm: Arm, k: int, here: float) -> Arm:
    """Joint k, which stands at `here`, rad or mm, turns the other way than was thought: positions are mirrored
    there."""
    joint = arm.joints[k]
    if joint.servo is not None:
        turned = replace(joint, servo=_moved(joint.servo, -2 * here, -joint.servo.direction))
    else:
        assert joint.bus is not None
        bus = joint.bus
        curve = None if bus.curve is None else tuple((2 * here - at, count) for at, count in reversed(bus.curve))
        zero = bus.count_at_zero + 2 * bus.counts_per_unit * here
        turned = replace(joint, bus=replace(bus, count_at_zero=zero, counts_per_unit=-bus.counts_per_unit, curve=curve))
    return _with(arm, k, turned)


def standing_at(arm: Arm, k: int, here: float, position: float) -> Arm:
    """Joint k is at `position`, rad or mm, where it was thought to stand at `here`: all its positions move along.

    Errors: UsageError where the servo then cannot move the joint within its limits at all.
    """
    joint, off = arm.joints[k], position - here
    if joint.servo is not None:
        moved = replace(joint, servo=_moved(joint.servo, off, joint.servo.direction))
    else:
        assert joint.bus is not None
        bus = joint.bus
        curve = None if bus.curve is None else tuple((at + off, count) for at, count in bus.curve)
        zero = bus.count_at_zero - bus.counts_per_unit * off
        moved = replace(joint, bus=replace(bus, count_at_zero=zero, curve=curve))
    changed = _with(arm, k, moved)
    low, high = own_calibration(changed).reach[k]
    if not (low < joint.maximum and joint.minimum < high):
        raise UsageError(f"joint {joint.name}: with its zero there its servo reaches no position within its limits")
    return changed


def limited(arm: Arm, k: int, position: float, *, upper: bool) -> Arm:
    """Joint k goes no further than `position`. Errors: UsageError where no range would be left, or the park pose would
    be outside."""
    joint = arm.joints[k]
    changed = replace(joint, maximum=position) if upper else replace(joint, minimum=position)
    if changed.minimum >= changed.maximum:
        raise UsageError(
            f"joint {joint.name}: its lower limit {changed.minimum / joint.per_file_unit:.2f} would not be below its "
            f"upper one {changed.maximum / joint.per_file_unit:.2f} {joint.file_unit}"
        )
    parked = arm.park is not None and not changed.minimum <= arm.park[k] <= changed.maximum
    if parked:
        raise UsageError(f"joint {joint.name}: the [park] pose of the file would be outside; change that first")
    return _with(arm, k, changed)


def parked(arm: Arm, positions: FloatArray) -> Arm:
    """The arm is parked at `positions` (n_joints,) from now on; joints that a coupling drives are where that has them.
    Errors: UsageError where a joint would be outside its limits."""
    park = arm.complete(positions[list(arm.independent_joints)])
    beyond = (park < arm.minimum - _ROUNDING) | (park > arm.maximum + _ROUNDING)
    if beyond.any():
        joint = arm.joints[int(np.argmax(beyond))]
        raise UsageError(f"joint {joint.name} would be parked outside its limits")
    return replace(arm, park=tuple(np.clip(park, arm.minimum, arm.maximum).tolist()))


def paper_under(arm: Arm, tip_mm: FloatArray, card_mm: float) -> Arm:
    """The pen, at `tip_mm` (3,) in the paper's frame, stands on a card of so many mm: the paper is that far below."""
    return replace(arm, paper=arm.paper.moved(arm.paper.normal * (float(tip_mm[2]) - card_mm)))


def told(arm: Arm, k: int, position: float) -> float:
    """What its servo is told for a position, outside its range as well."""
    joint = arm.joints[k]
    if joint.servo is not None:
        xs, ys = np.array(joint.servo.curve).T
        return _straight_on(joint.servo.direction * position, xs, ys) + joint.servo.trim_us
    assert joint.bus is not None
    if joint.bus.curve is not None:
        return _straight_on(position, *np.array(joint.bus.curve).T)
    return joint.bus.count_at_zero + joint.bus.counts_per_unit * position


def _straight_on(x: float, xs: FloatArray, ys: FloatArray) -> float:
    """Between points, and on from the last two beyond an end."""
    first = int(np.clip(np.searchsorted(xs, x) - 1, 0, len(xs) - 2))
    return float(ys[first] + (ys[first + 1] - ys[first]) * (x - xs[first]) / (xs[first + 1] - xs[first]))


def _moved(servo: Servo, by: float, direction: int) -> Servo:
    """The servo `by` further along its joint before that is turned into `direction`; it is told the same pulses."""
    curve = tuple((at + servo.direction * by, pulse_us) for at, pulse_us in servo.curve)
    return replace(servo, curve=curve, direction=direction)


def _with(arm: Arm, k: int, joint: Joint) -> Arm:
    return replace(arm, joints=(*arm.joints[:k], joint, *arm.joints[k + 1 :]))
