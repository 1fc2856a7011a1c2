"""Drawings on tables, easels, boards and ceilings: only how the paper lies to the arm counts, and the check agrees."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import pi, radians
from pathlib import Path

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arms.paper_pose import PaperPose
from planner.arms.rigid_transform import RigidTransform
from planner.checking.check import check_trajectory
from planner.errors import ArmFileError, PlanError, UsageError
from planner.inverse_kinematics.closed_forms import closed_form_of
from planner.pipeline import Plan, plan
from planner.progress import unreported
from planner.settings import PlanSettings
from planner.trajectory import read_trajectory, write_trajectory
from tests.arms.chains import load_once, model_of
from tests.arms.known_arms import UR5E
from tests.arms.unusual_arms import LIFT_SCARA
from tests.drawn_shapes import lines_svg

_DRAWING = '<path d="M5 5 L55 25 M55 5 C45 25 40 27 32 15 M45 15h0" fill="none" stroke="black"/>'

SIX = load_once("six_joint")
SIX = replace(SIX, closed_form=None, workspace=replace(SIX.workspace, inner_radius_mm=0.0))
BOARD = PaperPose(190.0, 0.0, 80.0, tilt_y_rad=-pi / 2)
SURFACES = {
    "easel": replace(SIX, paper=PaperPose(150.0, 0.0, 20.0, tilt_y_rad=radians(-40))),
    "board": replace(SIX, paper=BOARD),
    "board to the left": replace(SIX, paper=PaperPose(0.0, 190.0, 80.0, pi / 2, 0.0, -pi / 2)),
    "ceiling": replace(SIX, paper=PaperPose(100.0, 0.0, 230.0, tilt_y_rad=-pi)),
    "not quite level": replace(SIX, paper=PaperPose(0.0, 0.0, 5.0, 0.0, radians(1.5), radians(-3.0))),
    "UR5e at a board": replace(UR5E, paper=PaperPose(600.0, 0.0, 300.0, tilt_y_rad=-pi / 2)),
}


@pytest.fixture
def planned(tmp_path: Path) -> Callable[[Arm], Plan]:
    file = tmp_path / "drawing.svg"
    file.write_text(lines_svg(_DRAWING, 'viewBox="0 0 60 30"'), encoding="utf-8")
    return lambda arm: plan(file, PlanSettings(), unreported, arm=arm)


@pytest.mark.parametrize("name", SURFACES)
def test_drawings_on_any_surface_pass_the_check_and_outlive_their_file(
    name: str, planned: Callable[[Arm], Plan], tmp_path: Path
) -> None:
    arm = SURFACES[name]
    whole = planned(arm)
    file = tmp_path / "traj.csv"
    write_trajectory(whole.trajectory, file)
    read = read_trajectory(file)
    np.testing.assert_allclose(read.paper.T_base_paper, arm.paper.T_base_paper, atol=1e-6)
    result = check_trajectory(read, arm, whole.drawing)
    assert result.passed, str(result)


def test_the_check_finds_a_pen_that_leans_from_its_board(planned: Callable[[Arm], Plan]) -> None:
    """The same motion before a board that leans a little away is on the paper in one line at most, and never square."""
    whole = planned(SURFACES["board"])
    leaning = replace(SIX, paper=replace(BOARD, tilt_y_rad=radians(-89.0)))
    faults = {fault.check for fault in check_trajectory(whole.trajectory, leaning, whole.drawing).faults}
    assert {"pen upright on the paper", "tip on the paper while the pen is down"} <= faults


def test_only_how_the_paper_lies_to_the_arm_counts(planned: Callable[[Arm], Plan]) -> None:
    """The base is turned, and the paper with it: the joints move as before."""
    turn = RigidTransform(0.0, 0.0, 0.0, 0.4, -0.7, 1.1)
    first, *others = SIX.joints
    elsewhere = replace(
        SIX,
        joints=(replace(first, origin=turn), *others),
        paper=PaperPose.of(turn.matrix @ BOARD.T_base_paper),
    )
    one, other = (planned(arm).trajectory for arm in (SURFACES["board"], elsewhere))
    assert one.n_samples == other.n_samples
    np.testing.assert_allclose(other.positions, one.positions, atol=1e-5)  # degrees


@pytest.mark.parametrize("paper", [replace(BOARD, tilt_y_rad=pi / 2), replace(BOARD, x_mm=-5.0)])
def test_a_base_behind_its_paper_or_in_it_is_refused_as_such(paper: PaperPose) -> None:
    arm = replace(SIX, paper=paper)
    with pytest.raises(PlanError, match=r"the base stands \d+ mm behind the paper.*turn it around$"):
        model_of(arm).branches()


def test_a_pen_that_cannot_point_at_the_board_is_refused() -> None:
    with pytest.raises(ArmFileError, match=r"90.0 degrees from straight at the paper: correct .* or \[paper\]"):
        model_of(replace(LIFT_SCARA, paper=BOARD)).branches()


def test_links_keep_out_of_a_ceiling(planned: Callable[[Arm], Plan]) -> None:
    arm = SURFACES["ceiling"]
    free = arm.independent_of(arm.from_file_units(planned(arm).trajectory.positions))
    in_base_mm = arm.paper.to_base(model_of(arm).kinematics.nodes_mm(free))
    assert in_base_mm[..., 2].max() < arm.paper.z_mm + 0.01


def test_closed_forms_know_where_a_level_paper_lies_and_leave_boards_to_others() -> None:
    six = load_once("six_joint")
    moved = replace(six, paper=PaperPose(120.0, -30.0, 4.0, 0.5))
    tips_mm = np.array([[20.0, 10.0, 0.0], [60.0, -40.0, 3.0]])
    configurations = closed_form_of(moved)(tips_mm)
    np.testing.assert_allclose(model_of(moved).kinematics.tip_mm(configurations), tips_mm, atol=1e-6)
    with pytest.raises(UsageError, match="tilts it by 90 degrees"):
        closed_form_of(replace(six, paper=BOARD))
