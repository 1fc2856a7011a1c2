"""From joint positions to commanded servo values, and back: pulses in microseconds, or counts on a bus.

The value is a monotone curve of the servo's own position, which turns with the joint or against it. A value outside a
servo's range is never returned: it raises an error that names joint, value and range.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from planner.arms.arm import Arm, BusServo, Joint, Servo
from planner.arrays import FloatArray
from planner.errors import ArmFileError, HardwareError

_ROUNDING = 1e-6
"""A value beyond its range by no more than this, in us or counts, is at its end: angles come from converted degrees."""

_JUMP = 0.05
"""Share of a servo's range. An unpowered servo may rest against its stop so far outside, and jumps back at once."""

_COUNT = 1.0
"""The step of servos on a bus, which take whole counts."""

_Described = TypeVar("_Described", Servo, BusServo)


@dataclass(frozen=True, slots=True)
class _Curve:
    """The value of one servo by its own position: `points` ascend in position and are strictly monotone in value.

    step, dead_band: in the unit of the value; backlash: rad or mm.
    """

    joint: Joint
    direction: int
    points: FloatArray
    low: float
    high: float
    step: float
    dead_band: float
    backlash: float


class Calibration:
    """The servo values of an arm. `unit`: "us" or "counts"; addresses: the channel or bus id of each joint."""

    def __init__(self, unit: str, addresses: tuple[int, ...], curves: tuple[_Curve, ...]) -> None:
        self.unit, self.addresses = unit, addresses
        self._curves = curves

    @property
    def ranges(self) -> FloatArray:
        """(n_joints, 2): least and most value of each servo."""
        return np.array([(curve.low, curve.high) for curve in self._curves])

    @property
    def reach(self) -> FloatArray:
        """(n_joints, 2): least and most position of each servo, rad or mm."""
        ends = self.to_joints(self.ranges.T).T
        return np.sort(ends, axis=1)

    @property
    def steps(self) -> FloatArray:
        """(n_joints,) the resolution of each servo's value, 0 where it is not known."""
        return np.array([curve.step for curve in self._curves])

    @property
    def dead_bands(self) -> FloatArray:
        """(n_joints,) differences of value that each servo does not correct."""
        return np.array([curve.dead_band for curve in self._curves])

    @property
    def backlash(self) -> FloatArray:
        """(n_joints,) rad or mm of play between each servo and its joint."""
        return np.array([curve.backlash for curve in self._curves])

    def to_servos(self, positions: FloatArray) -> FloatArray:
        """Pulses or counts (..., n_joints), not rounded, of positions (..., n_joints) in rad or mm.

        Errors: HardwareError naming joint, value and range for the first one outside its servo's range.
        """
        columns = [_commanded(curve, positions[..., k], self.unit) for k, curve in enumerate(self._curves)]
        return np.stack(columns, axis=-1)

    def within(self, values: FloatArray) -> FloatArray:
        """Measured values (n_joints,), moved to the ends of their ranges where they are just outside.

        Errors: HardwareError naming joint, value and range of one that is further outside.
        """
        low, high = self.ranges.T
        inside: FloatArray = np.clip(values, low, high)
        astray = np.abs(values - inside) > _JUMP * (high - low)
        if astray.any():
            k = int(np.argmax(astray))
            raise HardwareError(
                f"joint {self._curves[k].joint.name} is at {values[k]:g} {self.unit}, outside its "
                f"range of {low[k]:g} to {high[k]:g} {self.unit}; switch off its power and move it inside by hand"
            )
        return inside

    def to_joints(self, values: FloatArray) -> FloatArray:
        """Positions (..., n_joints) in rad or mm of pulses or counts, extended straight beyond a curve's ends."""
        columns = []
        for k, curve in enumerate(self._curves):
            by_value = curve.points[np.argsort(curve.points[:, 1])]
            columns.append(curve.direction * _interpolated(values[..., k], by_value[:, 1], by_value[:, 0]))
        return np.stack(columns, axis=-1)


def pulse_calibration(arm: Arm) -> Calibration:
    """The arm's servos as its file describes them. Errors: ArmFileError naming the key that a joint lacks."""
    servos = [_known(arm, joint, "servo", joint.servo) for joint in arm.joints]
    return Calibration(
        "us",
        tuple(servo.channel for servo in servos),
        tuple(_pulse_curve(joint, servo) for joint, servo in zip(arm.joints, servos, strict=True)),
    )


def count_calibration(arm: Arm) -> Calibration:
    """The arm's bus servos as its file describes them. Errors: ArmFileError naming the key that a joint lacks."""
    servos = [_known(arm, joint, "bus", joint.bus) for joint in arm.joints]
    return Calibration(
        "counts",
        tuple(servo.id for servo in servos),
        tuple(_count_curve(joint, servo) for joint, servo in zip(arm.joints, servos, strict=True)),
    )


def own_calibration(arm: Arm) -> Calibration:
    """The arm's servos, moved by pulses or on a bus, whichever its file describes more of.

    Errors: ArmFileError naming the key that a joint lacks.
    """
    on_bus = sum(joint.bus is not None for joint in arm.joints)
    by_pulses = sum(joint.servo is not None for joint in arm.joints)
    return count_calibration(arm) if on_bus > by_pulses else pulse_calibration(arm)


def _known(arm: Arm, joint: Joint, key: str, servo: _Described | None) -> _Described:
    if servo is None:
        keys = {
            "servo": f"pulse_at_zero_us = ..., us_per_{joint.file_unit} = ..., pulse_range_us = [..., ...]",
            "bus": f"id = ..., count_at_zero = ..., counts_per_{joint.file_unit} = ..., count_range = [..., ...]",
        }
        raise ArmFileError(
            f"arm '{arm.name}'",
            [
                f"does not say how joint {joint.name} is moved; add to that joint in "
                f"the arm file: {key} = {{ {keys[key]} }}"
            ],
        )
    return servo


def _pulse_curve(joint: Joint, servo: Servo) -> _Curve:
    """A measured table is not trusted beyond its ends, so that the range is what range and table share."""
    points = np.array(servo.curve) + np.array([0.0, servo.trim_us])
    low, high = servo.pulse_range_us
    return _Curve(
        joint,
        servo.direction,
        points,
        max(low, points[:, 1].min()),
        min(high, points[:, 1].max()),
        servo.resolution_us,
        servo.dead_band_us,
        servo.backlash,
    )


def _count_curve(joint: Joint, servo: BusServo) -> _Curve:
    low, high = servo.count_range
    if servo.curve is not None:
        points = np.array(servo.curve)
        return _Curve(
            joint,
            1,
            points,
            max(low, points[:, 1].min()),
            min(high, points[:, 1].max()),
            _COUNT,
            servo.dead_band_counts,
            servo.backlash,
        )
    positions = (np.array([low, high]) - servo.count_at_zero) / servo.counts_per_unit
    points = np.column_stack((positions, (low, high)))
    return _Curve(joint, 1, points[np.argsort(positions)], low, high, _COUNT, servo.dead_band_counts, servo.backlash)


def _commanded(curve: _Curve, positions: FloatArray, unit: str) -> FloatArray:
    values = _interpolated(curve.direction * positions, curve.points[:, 0], curve.points[:, 1])
    beyond = ~((values >= curve.low - _ROUNDING) & (values <= curve.high + _ROUNDING))  # no number is beyond, too
    if np.any(beyond):
        first = int(np.argmax(beyond))
        position = np.ravel(positions)[first] / curve.joint.per_file_unit
        raise HardwareError(
            f"joint {curve.joint.name} at {position:.6g} {curve.joint.file_unit} asks its servo for "
            f"{np.ravel(values)[first]:.6g} {unit}, outside its range of {curve.low:g} to {curve.high:g} {unit}"
        )
    return np.clip(values, curve.low, curve.high)


def _interpolated(x: FloatArray, xs: FloatArray, ys: FloatArray) -> FloatArray:
    """Linear between points of ascending `xs`, and straight on beyond the first and the last."""
    first, last = (ys[1] - ys[0]) / (xs[1] - xs[0]), (ys[-1] - ys[-2]) / (xs[-1] - xs[-2])
    values: FloatArray = np.interp(x, xs, ys) + first * np.minimum(x - xs[0], 0.0) + last * np.maximum(x - xs[-1], 0.0)
    return values
