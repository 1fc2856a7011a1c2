"""What an arm file says of the arm, as an error model, and an error model as an arm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from planner.arms.arm import Arm, Joint, JointKind, Servo
from planner.arms.paper_pose import PaperPose
from planner.arms.slack import half_slack
from planner.arrays import FloatArray
from planner.error_model.chain import Geometry, rotation_of
from planner.error_model.curve import Curve, smooth_curve
from planner.error_model.model import ErrorModel
from planner.errors import ArmFileError

_MARGIN = 0.06
"""Of a joint's range: a curve is laid out so far beyond the limits at each end."""
_UPRIGHT = 1e-9
"""Cosine of a tilt that is a right angle but for rounding."""
_ROW = 0.04
"""Rows of a table that is written are so far apart, in rad; a slide has as many."""


def believed(arm: Arm) -> ErrorModel:
    """The error model that an arm file amounts to. Errors: ArmFileError where it does not say how joints are moved."""
    turns = np.array([joint.kind is JointKind.REVOLUTE for joint in arm.joints])
    theta, d_mm, a_mm, alpha = np.array(
        [(joint.theta_rad, joint.d_mm, joint.a_mm, joint.alpha_rad) for joint in arm.joints]
    ).T
    return ErrorModel(
        tuple(_curve(arm, joint) for joint in arm.joints),
        half_slack(arm),
        Geometry(
            theta,
            d_mm,
            a_mm,
            alpha,
            turns,
            _base_of(arm.paper),
            np.array([joint.origin.matrix for joint in arm.joints]),
            arm.tool.matrix,
        ),
    )


def arm_of(model: ErrorModel, arm: Arm) -> Arm:
    """`arm` with curves, slack, lengths, twists and paper of the model. Its limits stay those of its joints, and what
    servos may be told is widened to where slack and zeros ask for it.

    The rows then belong to no family, so that the arm names no closed form any more.
    """
    geometry = model.geometry
    joints = tuple(
        replace(_with_curve(joint, curve, float(slack)), d_mm=float(d), a_mm=float(a), alpha_rad=float(alpha))
        for joint, curve, slack, d, a, alpha in zip(
            arm.joints, model.curves, model.slack, geometry.d_mm, geometry.a_mm, geometry.alpha, strict=True
        )
    )
    T_paper_base: FloatArray = np.eye(4)
    T_paper_base[:3, :3] = rotation_of(*geometry.base[3:].tolist())
    T_paper_base[:3, 3] = geometry.base[:3]
    T_base_paper = np.asarray(np.linalg.inv(T_paper_base), np.float64)
    return replace(arm, joints=joints, paper=PaperPose.of(T_base_paper), closed_form=None)


def _curve(arm: Arm, joint: Joint) -> Curve:
    if joint.servo is not None:
        points = np.array(joint.servo.curve) * (joint.servo.direction, 1.0) + (0.0, joint.servo.trim_us)
    elif joint.bus is not None:
        bus = joint.bus
        ends = np.array([joint.minimum, joint.maximum])
        points = np.array(bus.curve or np.column_stack((ends, bus.count_at_zero + bus.counts_per_unit * ends)))
    else:
        raise ArmFileError(
            f"arm '{arm.name}'",
            [f"does not say how joint {joint.name} is moved; add servo = {{ ... }} or bus = {{ ... }} to that joint"],
        )
    points = points[np.argsort(points[:, 0])]
    room = _MARGIN * (joint.maximum - joint.minimum)
    return smooth_curve(points, joint.minimum - room, joint.maximum + room, _scale(joint))


def _scale(joint: Joint) -> float:
    """What a rad of a turning joint's priors is to this one: a slide of 100 mm is like a turn of 2 rad."""
    return 1.0 if joint.kind is JointKind.REVOLUTE else (joint.maximum - joint.minimum) / 2


def _with_curve(joint: Joint, curve: Curve, slack: float) -> Joint:
    room = _MARGIN * (joint.maximum - joint.minimum)
    low, high = joint.minimum - room, joint.maximum + room
    count = max(int(np.ceil((high - low) / (_ROW * _scale(joint)))), 2) + 1
    positions = np.concatenate(([low - slack], np.linspace(low, high, count), [high + slack]))
    told = curve.told(positions)
    per = (high - low) / abs(told[-2] - told[1])
    told[[0, -1]] = told[[1, -2]] + np.sign(told[-2] - told[1]) * np.array([-slack, slack]) / per  # at its mean slope
    if joint.servo is not None:
        servo = joint.servo
        band = min(servo.dead_band_us, slack / per)
        points = _sorted(servo.direction * positions, told)
        return replace(
            joint,
            servo=replace(
                servo,
                curve=points,
                trim_us=0.0,
                dead_band_us=band,
                backlash=2 * max(slack - band * per, 0.0),
                pulse_range_us=_widened(servo, told),
            ),
        )
    assert joint.bus is not None
    bus = joint.bus
    band = min(bus.dead_band_counts, slack / per)
    least, most = bus.count_range
    return replace(
        joint,
        bus=replace(
            bus,
            curve=_sorted(positions, told),
            dead_band_counts=band,
            backlash=2 * max(slack - band * per, 0.0),
            count_range=(min(least, int(np.floor(told.min()))), max(most, int(np.ceil(told.max())))),
        ),
    )


def _widened(servo: Servo, told: FloatArray) -> tuple[float, float]:
    least, most = servo.pulse_range_us
    return min(least, float(np.floor(told.min()))), max(most, float(np.ceil(told.max())))


def _sorted(positions: FloatArray, told: FloatArray) -> tuple[tuple[float, float], ...]:
    order = np.argsort(positions)
    return tuple(zip(positions[order].tolist(), told[order].tolist(), strict=True))


def _base_of(paper: PaperPose) -> FloatArray:
    """(6,) the base in the paper's frame, in the angles of Geometry."""
    T = paper.T_paper_base
    tilt_x = np.arcsin(np.clip(T[2, 1], -1.0, 1.0))
    yaw, tilt_y = np.arctan2(-T[0, 1], T[1, 1]), np.arctan2(-T[2, 0], T[2, 2])
    if np.hypot(T[0, 1], T[1, 1]) < _UPRIGHT:  # the two turn about the same axis
        yaw, tilt_y = np.arctan2(T[1, 0], T[0, 0]), 0.0
    return np.array([*T[:3, 3], yaw, tilt_x, tilt_y])
