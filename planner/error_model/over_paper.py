"""How far from where it is meant an arm is expected to put its pen, place by place."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.error_model.believed import believed
from planner.error_model.calibration.parameters import Parameters
from planner.kinematics.sensitivity import tip_sensitivity

_AT_ONCE = 2000


def expected_error(arm: Arm, joints: FloatArray) -> FloatArray:
    """(n,) mm along the paper at configurations (n, n_joints), rms over the arms that the file may mean, at rest, with
    the slack taken up that it knows of: what a calibration has left, or what the data sheet of an arm that nobody has
    calibrated does not say. Errors: ArmFileError where the file does not say how joints are moved."""
    parameters = Parameters.of(believed(arm), arm)
    if arm.accuracy is not None:
        at_rest, slack = np.full(len(joints), 2 * arm.accuracy.tip_mm**2), np.array(arm.accuracy.slack)
    else:
        pieces = np.split(joints, range(_AT_ONCE, len(joints), _AT_ONCE))
        shares = [(parameters.jacobian_at(some)[:, :2] * parameters.sd) ** 2 for some in pieces]
        at_rest, slack = (
            np.concatenate([share.sum(axis=(1, 2)) for share in shares]),
            parameters.slack_of(parameters.sd),
        )
    by_slack = tip_sensitivity(arm, joints)[:, :2] / arm.per_file_unit * slack
    error: FloatArray = np.sqrt(at_rest + (by_slack**2).sum(axis=(1, 2)))
    return error
