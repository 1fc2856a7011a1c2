"""Laws of the paper's pose: any turn has one, and it is read back as it was."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.jog.adjustments import paper_under
from planner.arms.arm import PenHold
from planner.arms.arm_file import load_arm, read_arm_file
from planner.arms.arm_text import arm_toml
from planner.arms.paper_pose import PaperPose
from planner.error_model.believed import arm_of, believed

angles = st.floats(-pi, pi) | st.sampled_from([-pi, -pi / 2, 0.0, pi / 2, pi])
lengths = st.floats(-500, 500)
poses = st.builds(PaperPose, lengths, lengths, lengths, angles, angles, angles)
BOARD = PaperPose(190.0, 5.0, 80.0, tilt_y_rad=-pi / 2)


@given(poses)
def test_any_pose_is_that_of_its_transform(pose: PaperPose) -> None:
    np.testing.assert_allclose(PaperPose.of(pose.T_base_paper).T_base_paper, pose.T_base_paper, atol=1e-9)


@given(st.floats(-pi, pi), st.sampled_from([-pi / 2, pi / 2]))
def test_a_board_that_is_turned_has_a_yaw_alone(yaw: float, tilt: float) -> None:
    pose = PaperPose.of(PaperPose(yaw_rad=yaw, tilt_y_rad=tilt).T_base_paper)
    assert pose.tilt_x_rad == pytest.approx(0.0, abs=1e-12)
    assert np.cos(pose.yaw_rad - yaw) == pytest.approx(1.0, abs=1e-12)


def test_who_looks_at_a_board_from_the_arm_sees_the_page_upright() -> None:
    top_left, top_right, bottom_right = BOARD.to_base(np.array([[60.0, 40.0, 0], [60.0, -40.0, 0], [-60.0, -40.0, 0]]))
    np.testing.assert_allclose(top_left - bottom_right, [0.0, 80.0, 120.0], atol=1e-9)  # y is left of who looks along x
    np.testing.assert_allclose(top_right - bottom_right, [0.0, 0.0, 120.0], atol=1e-9)
    np.testing.assert_allclose(BOARD.normal, [-1.0, 0.0, 0.0], atol=1e-12)


@pytest.mark.parametrize("tilt_deg", [-180, -90, -40, 90, 180])
def test_files_hold_any_tilt(tilt_deg: float, tmp_path: Path) -> None:
    paper = PaperPose(190.0, 0.0, 80.0, 0.1, radians(-170.0), radians(tilt_deg))
    file = tmp_path / "arm.toml"
    file.write_text(arm_toml(replace(load_arm("six_joint"), paper=paper)), encoding="utf-8")
    np.testing.assert_allclose(read_arm_file(file).paper.T_base_paper, paper.T_base_paper, atol=1e-8)


def test_a_card_moves_a_board_along_its_normal() -> None:
    moved = paper_under(replace(load_arm("six_joint"), paper=BOARD), np.array([10.0, 20.0, -3.0]), 1.0)
    np.testing.assert_allclose(moved.paper.T_base_paper[:3, 3], [194.0, 5.0, 80.0], atol=1e-9)
    assert replace(moved.paper, x_mm=190.0, y_mm=5.0, z_mm=80.0) == BOARD


def test_a_longer_pen_needs_the_board_nearer() -> None:
    arm = replace(load_arm("six_joint"), paper=BOARD)
    assert arm.holding(7.0).paper.x_mm == pytest.approx(183.0)
    upright = replace(arm, pen=replace(arm.pen, hold=PenHold.CONSTRUCTION))
    assert upright.holding(7.0).paper == replace(BOARD, z_mm=87.0)


@given(poses)
def test_calibrations_begin_with_the_paper_of_the_file(pose: PaperPose) -> None:
    arm = replace(load_arm("drawing_arm"), paper=pose)
    again = arm_of(believed(arm), arm).paper
    np.testing.assert_allclose(again.T_base_paper, pose.T_base_paper, atol=1e-6)
