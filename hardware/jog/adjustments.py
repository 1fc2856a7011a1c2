"""What a person finds out about an arm by moving one joint at a time, as changes of its description.

Each takes an arm and gives a new one; values are what the servo is told, in us or counts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hardware.compensation.servo_values import own_calibration
from planner.arms.arm import Arm, Joint
from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.errors import UsageError


def turned_round(arm: Arm, k: int) -> Arm:
    """Joint k turns the other way than was thought: the same value is the mirrored position."""
    joint = arm.joints[k]
    if joint.servo is not None:
        return _with(arm, k, replace(joint, servo=replace(joint.servo, direction=-joint.servo.direction)))
    assert joint.bus is not None
    bus = joint.bus
    curve = None if bus.curve is None else tuple((-at, count) for at, count in reversed(bus.curve))
    return _with(arm, k, replace(joint, bus=replace(bus, counts_per_unit=-bus.counts_per_unit, curve=curve)))


def standing_at(arm: Arm, k: int, position: float, value: float) -> Arm:
    """Joint k is at `position`, rad or mm, while its servo is told `value`: the whole curve moves along.

    Errors: UsageError where the servo then cannot move the joint within its limits at all.
    """
    joint, off = arm.joints[k], value - told(arm, k, position)
    if joint.servo is not None:
        moved = replace(joint, servo=replace(joint.servo, trim_us=joint.servo.trim_us + off))
    else:
        assert joint.bus is not None
        bus = joint.bus
        curve = None if bus.curve is None else tuple((at, count + off) for at, count in bus.curve)
        moved = replace(joint, bus=replace(bus, count_at_zero=bus.count_at_zero + off, curve=curve))
    changed = _with(arm, k, moved)
    low, high = own_calibration(changed).reach[k] if _has_range(changed, k) else (np.nan, np.nan)
    if not low < min(high, joint.maximum) or not max(low, joint.minimum) < high:
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


def paper_under(arm: Arm, tip_mm: FloatArray, card_mm: float) -> Arm:
    """The pen, at `tip_mm` (3,) in the paper's frame, stands on a card of so many mm: the paper is that far below."""
    pose = arm.paper.T_base_paper
    pose[:3, 3] += pose[:3, 2] * (float(tip_mm[2]) - card_mm)
    return replace(arm, paper=PaperPose.of(pose))


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


def _has_range(arm: Arm, k: int) -> bool:
    low, high = own_calibration(arm).ranges[k]
    return bool(low < high)


def _with(arm: Arm, k: int, joint: Joint) -> Arm:
    return replace(arm, joints=(*arm.joints[:k], joint, *arm.joints[k + 1 :]))
