"""Servos for an arm whose file says nothing of them: what a rehearsal takes for those that somebody will build in."""

from __future__ import annotations

from dataclasses import replace

from planner.arms.arm import Arm, BusServo, Joint, Servo

_PULSES_US = (600.0, 2400.0)
_RESOLUTION_US, _DEAD_BAND_US = 0.5, 5.0
_COUNTS = (512, 3584)
_DEAD_BAND_COUNTS = 1.0
_ROOM = 0.05
"""Of a joint's range: its servo turns so far beyond each end."""
_PLAY = 1 / 180
"""Of a joint's range: a degree of play in a servo that turns by half a turn, geared to what the joint asks for."""


def describes_servos(arm: Arm) -> bool:
    """Whether all joints say how they are moved, and all in the same way."""
    return all(joint.servo is not None for joint in arm.joints) or all(joint.bus is not None for joint in arm.joints)


def with_usual_servos(arm: Arm) -> Arm:
    """The arm with a servo of a usual kind at each joint that says of none; one that describes all its servos as it is.

    On a bus where more joints are on one than are moved by pulses. A servo goes through its range while the joint goes
    from limit to limit.
    """
    if describes_servos(arm):
        return arm
    on_bus = sum(joint.bus is not None for joint in arm.joints) > sum(joint.servo is not None for joint in arm.joints)
    return replace(
        arm,
        joints=tuple(
            replace(joint, bus=joint.bus or _bus(joint, place + 1), servo=None)
            if on_bus
            else replace(joint, servo=joint.servo or _servo(joint, place), bus=None)
            for place, joint in enumerate(arm.joints)
        ),
    )


def _servo(joint: Joint, place: int) -> Servo:
    (low, high), play = _turns(joint)
    curve = ((low, _PULSES_US[0]), (high, _PULSES_US[1]))
    return Servo(place, curve, 1, 0.0, _PULSES_US, _RESOLUTION_US, _DEAD_BAND_US, play)


def _bus(joint: Joint, number: int) -> BusServo:
    (low, high), play = _turns(joint)
    slope = (_COUNTS[1] - _COUNTS[0]) / (high - low)
    return BusServo(number, _COUNTS[0] - slope * low, slope, _COUNTS, _DEAD_BAND_COUNTS, play)


def _turns(joint: Joint) -> tuple[tuple[float, float], float]:
    """From where to where the servo brings the joint, and its play, rad or mm."""
    width = joint.maximum - joint.minimum
    return (joint.minimum - _ROOM * width, joint.maximum + _ROOM * width), _PLAY * width
