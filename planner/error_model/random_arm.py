"""An arm that could be the one in the hand of who wrote an arm file: what a rehearsal is held on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from planner.arms.arm import Arm, Joint
from planner.arrays import BoolArray, FloatArray
from planner.error_model.believed import arm_of, believed
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.chain import tips
from planner.error_model.left_open import too_high_mm
from planner.error_model.model import ErrorModel
from planner.error_model.slack import followed

_LAG_SPREAD = 0.25
_BUS_LAG_S = 0.02
_LEAST_SLACK = 0.002
"""rad or mm: no joint has none."""
_TRIES = 50
_CONFIGURATIONS = 200


def random_arm(arm: Arm, seed: int, positions: FloatArray, drawn: BoolArray) -> Arm:
    """An arm that differs from `arm` by as much as its file leaves open: all that a builder cannot know, or what its
    calibration left. Its curves rise all along. positions: (n, n_joints) that it is told to go through, with the pen on
    the paper where drawn (n,). Errors: ArmFileError where the file does not say how joints are moved."""
    random = np.random.default_rng(seed)
    model = believed(arm)
    parameters = Parameters.of(model, arm)
    share = 1.0 if arm.accuracy is None else arm.accuracy.tip_mm / _tip_sd_mm(parameters, positions)
    for _ in range(_TRIES):
        true = parameters.model(share * parameters.sd * random.normal(size=len(parameters.sd)))
        if all(curve.is_monotone for curve in true.curves):
            break
    left_open = parameters.slack_of(parameters.sd) if arm.accuracy is None else np.array(arm.accuracy.slack)
    slack = np.maximum(np.abs(model.slack + left_open * random.normal(size=arm.n_joints)), _LEAST_SLACK)
    true = replace(true, slack=slack)
    if arm.accuracy is None and drawn.any():
        true.geometry.base[2] -= too_high_mm(_way_mm(true, model, positions)[None], drawn, random)[0]
    made = arm_of(true, arm)
    lags = np.exp(_LAG_SPREAD * random.normal(size=arm.n_joints))
    return replace(
        made,
        accuracy=None,
        joints=tuple(_lagging(joint, float(lag)) for joint, lag in zip(made.joints, lags, strict=True)),
    )


def _lagging(joint: Joint, share: float) -> Joint:
    if joint.servo is not None:
        return replace(joint, servo=replace(joint.servo, lag_s=share * joint.servo.lag_s))
    assert joint.bus is not None
    return replace(joint, bus=replace(joint.bus, lag_s=share * (joint.bus.lag_s or _BUS_LAG_S)))


def _tip_sd_mm(parameters: Parameters, positions: FloatArray) -> float:
    """Along the paper, of an arm that nobody has calibrated."""
    jacobian = parameters.jacobian_at(positions[:: max(len(positions) // _CONFIGURATIONS, 1)])
    return float(np.sqrt(((jacobian[:, :2] ** 2) @ parameters.sd**2).mean()))


def _way_mm(true: ErrorModel, told: ErrorModel, positions: FloatArray) -> FloatArray:
    """(n, 3) where the tip of an arm goes whose servos are told to go through positions as another one's are."""
    goals = [
        true_curve.position(curve.told(column))
        for true_curve, curve, column in zip(true.curves, told.curves, positions.T, strict=True)
    ]
    return tips(true.geometry, followed(np.column_stack(goals), true.slack)).tip_mm
