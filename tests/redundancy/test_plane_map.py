"""Maps over the plane: exact, within limits and without jumps, for arms that do not turn over their paper."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares

from planner.arms.arm import Arm, PenHold
from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.checking.check import check_trajectory
from planner.errors import PlanError
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import within_limits
from planner.pipeline import plan
from planner.progress import unreported
from planner.redundancy.paper_grid import PaperGrid
from planner.redundancy.plane_map import PlaneMap
from planner.settings import CanvasKind, PlanSettings
from planner.workspace.canvas import canvas_of
from planner.workspace.paper_map import paper_map
from planner.workspace.reach import paper_in_reach
from tests.arms.chains import dh_frames, load_once, model_of
from tests.arms.unusual_arms import GANTRY, LIFT_DRAWING_ARM, LIFT_SCARA, PLANE_ARMS, RAIL_SCARA, facing
from tests.drawn_shapes import lines_svg

_DRAWING = '<path d="M5 5 L55 25 M55 5 C45 25 40 27 32 15 M45 15h0" fill="none" stroke="black"/>'


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    file = tmp_path / "drawing.svg"
    file.write_text(lines_svg(_DRAWING, 'viewBox="0 0 60 30"'), encoding="utf-8")
    return file


def places(arm: Arm, count: int, seed: int = 0) -> FloatArray:
    """(n, 2) random places that the first branch reaches."""
    branch = model_of(arm).branches()[0]
    points = np.random.default_rng(seed).uniform(*branch.box_mm, (count, 2))
    return points[branch.reaches(points)]


@pytest.mark.parametrize("name", PLANE_ARMS)
def test_every_place_that_is_reached_has_an_exact_configuration_with_the_pen_held(name: str) -> None:
    arm = PLANE_ARMS[name]
    branches = model_of(arm).branches()
    assert all(isinstance(branch, PlaneMap) for branch in branches)
    points = places(arm, 400)
    assert len(points) > 60
    tips = np.column_stack((points, np.zeros(len(points))))
    independent, good = branches[0].configurations_at(tips)
    joints = arm.complete(independent)
    assert good.all() and within_limits(arm, joints).all()
    for tip, configuration in zip(tips, joints, strict=True):
        pose = arm.paper.T_paper_base @ dh_frames(arm, configuration)[-1]
        np.testing.assert_allclose(pose[:3, 3], tip, atol=1e-6)
        if arm.pen.hold is not PenHold.FREE:
            np.testing.assert_allclose(pose[:3, :3] @ arm.pen.tool_axis, [0.0, 0.0, -1.0], atol=1e-6)


@pytest.mark.parametrize("name", PLANE_ARMS)
def test_lines_within_the_map_are_followed_without_jumps(name: str) -> None:
    arm = PLANE_ARMS[name]
    branch = model_of(arm).branches()[0]
    points = places(arm, 60, seed=1)
    followed = 0
    for start, end in pairwise(points):
        count = int(np.linalg.norm(end - start)) + 2
        line = start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)
        if not branch.reaches(line).all():
            continue
        joints = arm.complete(branch.configurations_at(np.column_stack((line, np.zeros(count))))[0])
        steps_s = np.abs(np.diff(joints, axis=0)) / arm.max_velocity
        assert steps_s.max() < 4.0 / arm.workspace.min_tip_speed_mm_s  # a step is a millimetre at most
        followed += 1
    assert followed > 5


def test_a_place_has_the_same_configuration_whatever_is_asked_with_it() -> None:
    branch = model_of(LIFT_SCARA).branches()[0]
    tips = np.column_stack((places(LIFT_SCARA, 40), np.zeros(len(places(LIFT_SCARA, 40)))))
    together = branch.reference(tips)
    for tip, reference in zip(tips, together, strict=True):
        np.testing.assert_array_equal(branch.reference(tip[None])[0], reference)


def test_the_same_arm_has_the_same_map() -> None:
    one, other = (model_of(replace(GANTRY, source=source)).branches()[0] for source in ("one", "other"))
    assert isinstance(one, PlaneMap) and isinstance(other, PlaneMap)
    np.testing.assert_array_equal(one.configurations, other.configurations)


def test_a_map_is_made_again_of_its_arrays() -> None:
    (branch, *_) = model_of(RAIL_SCARA).planes()
    again = PlaneMap.of(branch.kinematics, branch.arrays)
    tips = np.column_stack((places(RAIL_SCARA, 50), np.zeros(len(places(RAIL_SCARA, 50)))))
    np.testing.assert_array_equal(again.reference(tips), branch.reference(tips))
    np.testing.assert_array_equal(again.reaches(tips[:, :2]), branch.reaches(tips[:, :2]))


def test_a_gantry_reaches_its_whole_table() -> None:
    reach = paper_in_reach(model_of(GANTRY))
    assert reach.ring_mm is None
    room = 0.02 * 300  # what joints keep from their limits
    assert min(reach.width_mm, reach.height_mm) > 300 - 2 * room - 10.0  # and a square of the canvas on each side
    assert max(reach.width_mm, reach.height_mm) < 300


def test_a_slide_is_used() -> None:
    rail = RAIL_SCARA.joints[0]
    held = replace(RAIL_SCARA, joints=(replace(rail, minimum=300.0, maximum=300.5), *RAIL_SCARA.joints[1:]))
    alone, railed = (paper_in_reach(model_of(arm)) for arm in (held, RAIL_SCARA))
    assert railed.width_mm * railed.height_mm > 2 * alone.width_mm * alone.height_mm


@pytest.mark.parametrize("name", ["lift_scara", "rail_scara", "gantry", "lift_drawing_arm", "rolling"])
def test_they_draw_what_the_check_accepts(name: str, drawing: Path) -> None:
    arm = PLANE_ARMS[name]
    planned = plan(drawing, PlanSettings(), unreported, arm=arm)
    result = check_trajectory(planned.trajectory, arm, planned.drawing)
    assert result.passed, str(result)


@pytest.mark.parametrize("arm", [facing(90, -70, 70), facing(0, 90, 270), facing(135, -40, 40)], ids=lambda a: a.name)
def test_arms_that_face_elsewhere_than_ahead_draw_there(arm: Arm, drawing: Path) -> None:
    planned = plan(drawing, PlanSettings(), unreported, arm=arm)
    result = check_trajectory(planned.trajectory, arm, planned.drawing)
    assert result.passed, str(result)
    corners = canvas_of(model_of(arm), CanvasKind.USABLE, arm.pen.lift_mm).corners_arm_mm
    towards = arm.joints[0].theta_rad + (arm.joints[0].minimum + arm.joints[0].maximum) / 2
    assert (corners.mean(axis=0) @ [np.cos(towards), np.sin(towards)]) > 60.0


def test_an_arm_over_a_level_paper_draws_before_its_base() -> None:
    assert canvas_of(model_of(LIFT_SCARA), CanvasKind.USABLE, 5.0).near_mm >= 0.0


def test_only_rings_have_the_documented_canvases() -> None:
    with pytest.raises(PlanError, match="try --canvas usable"):
        canvas_of(model_of(LIFT_DRAWING_ARM), CanvasKind.OPTIMAL, 5.0)


def test_the_picture_of_the_workspace_has_what_is_reached() -> None:
    figures = paper_map(model_of(LIFT_SCARA))
    shown = np.isfinite(figures.manipulability)
    points = np.column_stack((figures.x_mm[shown], figures.y_mm[shown]))
    reached = np.any([branch.reaches(points) for branch in model_of(LIFT_SCARA).branches()], axis=0)
    assert shown.any() and reached.all()


@pytest.mark.parametrize("offset_mm", [-120.0, 400.0])
def test_a_paper_that_is_refused_is_out_of_reach_for_another_solver_too(offset_mm: float) -> None:
    arm = replace(LIFT_SCARA, paper=PaperPose(z_mm=offset_mm))
    with pytest.raises(PlanError, match=r"of \d+ tried \d+ get there, and of these \d+ have a joint beyond.*\(lift in"):
        model_of(arm).branches()
    assert nearest_mm(arm) > 1.0


@pytest.mark.parametrize("name", PLANE_ARMS)
def test_what_another_solver_reaches_is_not_refused(name: str) -> None:
    assert nearest_mm(PLANE_ARMS[name]) < 1e-6
    assert model_of(PLANE_ARMS[name]).branches()


def nearest_mm(arm: Arm) -> float:
    """How near the pen comes to the paper, held as it is held, by bounded least squares from many starts."""
    kinematics = Kinematics(arm)
    low, high = kinematics.independent_of(arm.minimum), kinematics.independent_of(arm.maximum)

    def off(independent: FloatArray) -> FloatArray:
        task, _ = kinematics.task_and_jacobian(independent[None])
        return task[0, 2:] * np.append(1.0, np.full(kinematics.n_task - 3, 100.0))

    starts = np.random.default_rng(1).uniform(low, high, (12, len(low)))
    return min(float(np.abs(least_squares(off, start, bounds=(low, high)).fun).max()) for start in starts)


def test_an_arm_that_moves_in_a_plane_is_told_which_way_it_does_not() -> None:
    arm = load_once("drawing_arm")
    slide = LIFT_SCARA.joints[0]
    flat = replace(arm, joints=(replace(slide, name="q1", alpha_rad=np.pi / 2, minimum=0.0), *arm.joints[1:]))
    with pytest.raises(PlanError, match=r"have a direction that no joint moves the tip in \(along y of the paper\)"):
        model_of(flat).branches()


@settings(max_examples=30)
@given(
    st.integers(4, 9),
    st.integers(4, 9),
    st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-2, 2)),
    st.integers(0, 2**32 - 1),
)
def test_a_straight_field_goes_on_straight(
    columns: int, rows: int, plane: tuple[float, float, float], seed: int
) -> None:
    grid = PaperGrid(np.array([-3.0, 5.0]), 2.0, (columns, rows))
    field = (grid.tips_mm[:, :2] @ plane[:2] + plane[2])[:, None]
    node = int(np.random.default_rng(seed).integers(grid.n_nodes))
    known = np.ones(grid.n_nodes, dtype=np.bool_)
    known[node] = False
    mean, _, near_known = grid.carried_on(field[None], known[None], np.array([0]), np.array([node]))
    np.testing.assert_allclose(mean[0], field[node], atol=1e-9)
    assert near_known.sum() >= 2
    np.testing.assert_array_equal(grid.nearest(grid.tips_mm), np.arange(grid.n_nodes))
    filled = grid.filled(field, known)
    np.testing.assert_array_equal(filled[known], field[known])
    assert np.isfinite(grid.filled(field, np.arange(grid.n_nodes) == node)).all()
