"""The check and the planner hold a pen the same way, each found by itself, and no paper in any pose has another one."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arms.arm import Arm, PenHold
from planner.arms.paper_pose import PaperPose
from planner.checking.held import held_along
from planner.kinematics.chain import Kinematics
from tests.arms.chains import load_once
from tests.arms.known_arms import UR5E
from tests.arms.unusual_arms import LIFT_DRAWING_ARM

SMALL = PaperPose(3.0, 2.0, 1.0, 0.3, radians(1.5), radians(-2.0))
SIX = load_once("six_joint")
IN_PLANE = replace(load_once("drawing_arm"), couplings=())
IN_PLANE = replace(IN_PLANE, pen=replace(IN_PLANE.pen, hold=PenHold.TOOL_AXIS))


def straight_down(arm: Arm) -> list[float]:
    down: list[float] = (-arm.paper.T_paper_base[:3, 2]).tolist()
    return down


@pytest.mark.parametrize("arm", [IN_PLANE, LIFT_DRAWING_ARM, SIX, UR5E], ids=lambda arm: arm.name)
@pytest.mark.parametrize("paper", [PaperPose(), SMALL, PaperPose(tilt_y_rad=-0.7), PaperPose(tilt_x_rad=pi)])
def test_plan_and_check_agree(arm: Arm, paper: PaperPose) -> None:
    arm = replace(arm, paper=paper, closed_form=None)
    planned = arm.paper.T_paper_base[:3, :3] @ Kinematics(arm).held_along
    np.testing.assert_allclose(held_along(arm), planned, atol=1e-12)


@pytest.mark.parametrize(("arm", "leans"), [(IN_PLANE, False), (LIFT_DRAWING_ARM, False), (SIX, True), (UR5E, True)])
def test_only_a_pen_that_nothing_leans_sideways_stays_upright(arm: Arm, leans: bool) -> None:
    arm = replace(arm, paper=SMALL, closed_form=None)
    np.testing.assert_allclose(held_along(arm), [0.0, 0.0, -1.0] if leans else straight_down(arm), atol=1e-12)


@given(st.floats(-pi, pi), st.floats(-pi, pi), st.floats(-pi, pi))
def test_six_joints_hold_it_square_to_any_paper(yaw: float, tilt_x: float, tilt_y: float) -> None:
    arm = replace(SIX, paper=PaperPose(0.0, 0.0, 0.0, yaw, tilt_x, tilt_y), closed_form=None)
    np.testing.assert_array_equal(held_along(arm), [0.0, 0.0, -1.0])
