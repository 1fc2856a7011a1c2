"""Arms that the planner did not grow up with: of half a metre and a metre, with six and seven joints, and those that
come along at other sizes. All of them have a configuration map, and draw what the check accepts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm, PenHold
from planner.arms.arm_file import known_arms, read_arm_file
from planner.arms.description import arm_description
from planner.cli import main
from planner.errors import PlanError
from planner.inverse_kinematics.stroke_configurations import joint_paths
from planner.kinematics.projection import project
from planner.placement.pen_path import smooth_paths
from planner.redundancy.samples import COARSE_STEP_MM, on_ray, stretched_to_edges
from planner.settings import CanvasKind, ConfigurationWeights, Method
from planner.workspace.canvas import canvas_of
from tests.arms.chains import kinematics_of, load_once, model_of, references_for, tips_by_product
from tests.arms.known_arms import KNOWN_ARMS, file_text, scaled

_DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 30" fill="none" stroke="black">
<circle cx="15" cy="15" r="12"/><path d="M32 3L57 27M57 3C45 25 40 27 32 15M45 15h0"/></svg>"""


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    file = tmp_path / "drawing.svg"
    file.write_text(_DRAWING, encoding="utf-8")
    return file


def require_exact_map(arm: Arm) -> None:
    for sheet in model_of(arm).branches():
        tips = on_ray(np.linspace(sheet.radii_mm[0], sheet.radii_mm[-1], 200))
        independent, good = sheet.configurations_at(tips)
        assert good.all()
        np.testing.assert_allclose(tips_by_product(arm, arm.complete(independent)), tips, atol=1e-6)
        steps_s = np.abs(np.diff(arm.complete(independent), axis=0)) / arm.max_velocity
        assert steps_s.max() / (tips[1, 0] - tips[0, 0]) < 1.0 / arm.workspace.min_tip_speed_mm_s * 4


@pytest.mark.parametrize("name", KNOWN_ARMS)
def test_known_arms_have_an_exact_map_without_jumps(name: str) -> None:
    require_exact_map(KNOWN_ARMS[name])


@settings(max_examples=5)
@given(st.sampled_from(known_arms()), st.floats(np.log(0.8), np.log(4.0)))
def test_arms_of_any_size_have_one(name: str, log_factor: float) -> None:
    arm = scaled(load_once(name), float(np.exp(log_factor)))
    require_exact_map(arm)
    for kind in (CanvasKind.USABLE, CanvasKind.OPTIMAL):
        assert np.isfinite(canvas_of(model_of(arm), kind, arm.pen.lift_mm).corners_arm_mm).all()


@pytest.mark.parametrize("name", ["panda"])
def test_they_draw_what_the_check_accepts(name: str, drawing: Path, tmp_path: Path) -> None:
    (tmp_path / f"{name}.toml").write_text(file_text(KNOWN_ARMS[name]), encoding="utf-8")
    trajectory = tmp_path / "out.csv"
    assert main([str(drawing), "--arm", str(tmp_path / f"{name}.toml"), "--quiet", "-o", str(trajectory)]) == 0
    assert main(["check", str(trajectory), "--drawing", str(drawing)]) == 0


def test_a_long_way_from_the_reference_a_pen_still_points_at_its_target() -> None:
    """Millimetres of a metre and radians of pointing stand side by side in one equation."""
    arm = KNOWN_ARMS["ur5e"]
    field, kinematics = model_of(arm).configuration_map(), kinematics_of(arm)
    radii = np.linspace(field.radii_mm[0] + 20, field.radii_mm[-1] - 20, 30)
    references = np.repeat(field.home[None], len(radii), axis=0)
    found, exact = project(kinematics, references, on_ray(radii))
    assert exact.sum() > len(radii) // 2
    task, _ = kinematics.task_and_jacobian(found[exact])
    assert np.abs(task - kinematics.task_target(on_ray(radii[exact]))).max() < 1e-8


def test_a_course_keeps_the_way_to_its_edges() -> None:
    """Where few configurations are sampled, the walk to the edge is long, and what lies between has to be near it."""
    arm = KNOWN_ARMS["ur5e"]
    field, kinematics = model_of(arm).configuration_map(), kinematics_of(arm)
    middle = len(field.radii_mm) // 2
    radii, configurations = stretched_to_edges(kinematics, field.radii_mm[middle : middle + 1], field.home[None])
    assert radii[-1] - radii[0] > 100 * COARSE_STEP_MM
    assert np.diff(radii).max() <= COARSE_STEP_MM
    np.testing.assert_allclose(tips_by_product(arm, arm.complete(configurations)), on_ray(radii), atol=1e-6)


def test_the_file_of_a_known_arm_is_that_arm(tmp_path: Path) -> None:
    arm = KNOWN_ARMS["panda"]
    (tmp_path / "panda.toml").write_text(file_text(arm), encoding="utf-8")
    assert arm_description(read_arm_file(tmp_path / "panda.toml")) == arm_description(arm)


@pytest.mark.parametrize("name", known_arms())
@pytest.mark.parametrize("kind", CanvasKind)
def test_every_canvas_of_every_arm_is_finite_and_in_reach(name: str, kind: CanvasKind) -> None:
    arm = load_once(name)
    canvas = canvas_of(model_of(arm), kind, arm.pen.lift_mm)
    longest = sum(abs(joint.a_mm) + abs(joint.d_mm) for joint in arm.joints) + sum(
        joint.maximum for joint in arm.joints if joint.file_unit == "mm"
    )
    assert 0 < canvas.width_mm < 2 * longest
    assert 0 < canvas.height_mm < longest


def test_an_arm_with_fewer_joints_than_a_pen_needs_is_told_so() -> None:
    arm = load_once("six_joint")
    with pytest.raises(PlanError, match=r"takes \d joints that move by themselves, and it has 2"):
        model_of(replace(arm, joints=arm.joints[:2])).configuration_map()


_REFUSALS = {
    "beyond limits": (
        lambda joint: replace(joint, minimum=2.9, maximum=3.0) if joint.name == "q3" else joint,
        r"\d+ have a joint beyond its limits or nearly so \(.*q3 in \d+.*widen these limits",
    ),
    "too slow": (
        lambda joint: replace(joint, max_velocity=1e-4),
        r"\d+ cannot move the tip fast enough in every direction.*lower workspace.min_tip_speed_mm_s",
    ),
    "too high": (lambda joint: replace(joint, d_mm=900.0) if joint.name == "q1" else joint, "none gets there"),
    "too thick": (
        lambda joint: replace(joint, thickness_mm=300.0) if joint.a_mm else joint,
        r"\d+ bring links too close.*check thickness_mm",
    ),
}


@pytest.mark.parametrize("cause", _REFUSALS)
def test_an_arm_without_a_configuration_is_told_what_most_of_them_lack(cause: str) -> None:
    change, said = _REFUSALS[cause]
    arm = load_once("drawing_arm")
    with pytest.raises(PlanError, match=said):
        model_of(replace(arm, joints=tuple(map(change, arm.joints)))).configuration_map()


def test_a_pen_that_never_points_down_is_told_so() -> None:
    arm = load_once("scara")
    upwards = replace(arm, pen=replace(arm.pen, hold=PenHold.TOOL_AXIS, tool_axis=(0.0, 0.0, 1.0)))
    axis = kinematics_of(upwards).tool_axis(np.zeros((1, 4)))[0, 2]
    if axis < 0:
        upwards = replace(upwards, pen=replace(upwards.pen, tool_axis=(0.0, 0.0, -1.0)))
    with pytest.raises(PlanError, match="tool_axis never points at it"):
        model_of(upwards).configuration_map()


@settings(max_examples=6)
@given(
    st.sampled_from(["drawing_arm_2022", "scara", "three_joint"]),
    st.tuples(*[st.sampled_from([0.0, 0.0, 1e-3, 1.0, 7.0])] * 4).filter(any),
)
def test_any_weights_leave_a_course_that_a_pen_can_follow(
    name: str, weights: tuple[float, float, float, float]
) -> None:
    arm = load_once(name)
    canvas = canvas_of(model_of(arm), CanvasKind.USABLE, arm.pen.lift_mm)
    x0, x1, y0, y1 = canvas.near_mm + 3, canvas.far_mm - 3, canvas.right_mm + 3, canvas.left_mm - 3
    strokes = [np.array([[x0, 0.0], [x1, 0.1]]), np.array([[x0, y0], [x1, y1], [x1, y0]])]
    references = references_for(arm, Method.PATH, ConfigurationWeights(*weights))
    _, infeasible_paths = joint_paths(kinematics_of(arm), references, smooth_paths(strokes, 0.025))
    assert not infeasible_paths


def test_weights_without_a_price_on_motion_do_not_jump() -> None:
    arm = load_once("scara")
    canvas = canvas_of(model_of(arm), CanvasKind.USABLE, arm.pen.lift_mm)
    strokes = [np.array([[canvas.near_mm + 3, 0.0], [canvas.far_mm - 3, canvas.left_mm - 3]])]
    references = references_for(arm, Method.PATH, ConfigurationWeights(0.0, 1.0, 0.0, 0.0))
    _, infeasible_paths = joint_paths(kinematics_of(arm), references, smooth_paths(strokes, 0.025))
    assert not infeasible_paths
