"""The expected error place by place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from planner.arms.accuracy import Accuracy
from planner.arms.arm_file import load_arm
from planner.error_model.believed import believed
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.left_open import errors_by
from planner.error_model.over_paper import expected_error
from planner.errors import ArmFileError
from planner.kinematics.sensitivity import sideways_error, tip_sensitivity

CHOSEN, ARMS = 12, 4000


@pytest.mark.parametrize("name", ["drawing_arm_2022", "so101"])
def test_it_is_what_arms_at_random_are_off_by(name: str) -> None:
    arm, random = load_arm(name), np.random.default_rng(0)
    joints = random.uniform(arm.minimum, arm.maximum, (CHOSEN, arm.n_joints))
    parameters = Parameters.of(believed(arm), arm)
    vectors = random.normal(size=(ARMS, len(parameters.sd))) * parameters.sd
    slack = random.choice((-1.0, 1.0), (ARMS, arm.n_joints)) * vectors[:, parameters.slack_entries]
    per_unit = tip_sensitivity(arm, joints)[:, :2] / arm.per_file_unit
    off_mm = errors_by(parameters, vectors, joints)[..., :2] + np.einsum("nij,kj->kni", per_unit, slack)
    rms = np.sqrt((off_mm**2).sum(axis=2).mean(axis=0))
    np.testing.assert_allclose(expected_error(arm, joints), rms, rtol=0.05)


def test_of_a_calibrated_arm_it_is_what_the_calibration_has_left() -> None:
    arm, random = load_arm("drawing_arm_2022"), np.random.default_rng(0)
    joints = random.uniform(arm.minimum, arm.maximum, (CHOSEN, arm.n_joints))
    still = replace(arm, accuracy=Accuracy(49, 0.3, 0.2, (0.0,) * arm.n_joints))
    np.testing.assert_allclose(expected_error(still, joints), 0.3 * np.sqrt(2))
    slack = np.radians(0.2)
    loose = replace(arm, accuracy=Accuracy(49, 0.0, 0.0, (slack,) * arm.n_joints))
    wanted = 0.2 * np.sqrt(arm.n_joints) * sideways_error(arm, joints)
    np.testing.assert_allclose(expected_error(loose, joints), wanted)


def test_an_arm_whose_servos_nobody_knows_has_none() -> None:
    arm = load_arm("scara")
    with pytest.raises(ArmFileError, match="is moved"):
        expected_error(arm, np.zeros((1, arm.n_joints)))
