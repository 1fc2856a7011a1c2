"""The choice of branch and redundancy for drawing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.errors import PlanError
from planner.inverse_kinematics.closed_forms import closed_form_of, family_of
from planner.inverse_kinematics.closed_forms.selection import select
from tests.inverse_kinematics.closed_forms.arms import NAMES, arm_of, changed, poses_of

REACH_MM = {
    "drawing_arm": (34, 148),
    "drawing_arm_2022": (65, 143),
    "scara": (61, 199),
    "three_joint": (61, 210),
    "six_joint": (81, 238),
    "stanford": (91, 288),
}


@pytest.fixture(params=NAMES)
def arm(request: pytest.FixtureRequest) -> Arm:
    return arm_of(request.param)


def fan(arm: Arm, azimuth_rad: float) -> np.ndarray:
    radius = np.linspace(*REACH_MM[arm.name], 500)
    return np.column_stack((radius * np.cos(azimuth_rad), radius * np.sin(azimuth_rad), np.zeros(500)))


@pytest.mark.parametrize("azimuth_deg", [-30, 0])
def test_selected_configurations_draw_within_limits_and_smoothly(arm: Arm, azimuth_deg: float) -> None:
    tip = fan(arm, np.radians(azimuth_deg))
    independent = closed_form_of(arm)(tip)
    joints = arm.complete(independent)
    np.testing.assert_allclose(poses_of(arm, joints)[:, :3, 3], tip, atol=1e-9)
    assert (joints >= arm.minimum - 1e-9).all() and (joints <= arm.maximum + 1e-9).all()
    # A third of a millimetre apart: no joint goes over to another branch or turn.
    assert (np.abs(np.diff(joints, axis=0)) / arm.max_velocity).max() < 0.08


def test_beyond_reach_there_is_no_configuration(arm: Arm) -> None:
    tip = np.array([[2000.0, 0.0, 0.0]])
    assert arm.closed_form == "stanford" or np.isnan(closed_form_of(arm)(tip)).all()


def test_the_middle_of_the_window_has_room_on_both_sides() -> None:
    """The spin of a tool in the middle of its joint's range: q6 at 0, whatever turns the rest of the chain makes."""
    arm = arm_of("six_joint")
    assert np.abs(closed_form_of(arm)(fan(arm, 0.2))[:, 5]).max() < np.radians(2)


def test_an_arm_whose_limits_leave_nothing_is_refused() -> None:
    arm = arm_of("three_joint")
    arm = replace(changed(arm, [{}, {"minimum": 1.5, "maximum": 1.6}, {"minimum": -0.1, "maximum": 0.1}]))
    with pytest.raises(PlanError, match="no configuration within the joint limits"):
        select(arm, family_of(arm).at_tip, False)
