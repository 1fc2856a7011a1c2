"""An arm that could be the one in the hand of who wrote an arm file: what a rehearsal is held on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from planner.arms.arm import Arm, Joint
from planner.error_model.believed import arm_of, believed
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.drawn import drawn_joints, jacobian_at
from planner.redundancy.arm_model import ArmModel

_LAG_SPREAD = 0.25
_BUS_LAG_S = 0.02
_LEAST_SLACK = 0.002
"""rad or mm: no joint has none."""
_TRIES = 50


def random_arm(arm: Arm, seed: int) -> Arm:
    """An arm that differs from `arm` by as much as its file leaves open: all that a builder cannot know, or what its
    calibration left. Its curves rise all along. Errors: ArmFileError where it does not say how joints are moved."""
    random = np.random.default_rng(seed)
    model = believed(arm)
    parameters = Parameters.of(model, arm)
    share = 1.0 if arm.accuracy is None else arm.accuracy.tip_mm / _tip_sd_mm(arm, parameters)
    for _ in range(_TRIES):
        true = parameters.model(share * parameters.sd * random.normal(size=len(parameters.sd)))
        if all(curve.is_monotone for curve in true.curves):
            break
    left_open = parameters.slack_of(parameters.sd) if arm.accuracy is None else np.array(arm.accuracy.slack)
    slack = np.maximum(np.abs(model.slack + left_open * random.normal(size=arm.n_joints)), _LEAST_SLACK)
    made = arm_of(replace(true, slack=slack), arm)
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


def _tip_sd_mm(arm: Arm, parameters: Parameters) -> float:
    """Along the paper, of an arm that nobody has calibrated."""
    jacobian = jacobian_at(parameters, parameters.prior, drawn_joints(ArmModel(arm)))
    return float(np.sqrt(((jacobian[:, :2] ** 2) @ parameters.sd**2).mean()))
