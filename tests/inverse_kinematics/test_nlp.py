"""The nonlinear program: on target, within the limits of all joints, near the configuration before."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from planner.arms.arm import Arm, PenHold
from planner.comparison.compare import default_start
from planner.comparison.targets import TargetKind, random_targets
from planner.kinematics.projection import joint_scale, project
from planner.workspace.canvas import usable_canvas
from tests.arms.chains import kinematics_of, load_once, model_of, reachable_configurations, solver_of, tips_by_product
from tests.arms.known_arms import KNOWN_ARMS
from tests.arms.unusual_arms import PLANE_ARMS


def test_solutions_are_on_target_and_within_limits(arm: Arm) -> None:
    """All over the canvas, pen down and pen up, each from the middle of the joint ranges."""
    canvas, solver = usable_canvas(model_of(arm), 5.0), solver_of(arm)
    share = np.random.default_rng(1).uniform(size=(60, 3))
    on_canvas = canvas.to_arm_mm(share[:, :2] * [canvas.width_mm, canvas.height_mm])
    targets = np.column_stack((on_canvas, 5.0 * share[:, 2]))
    middle = ((arm.minimum + arm.maximum) / 2)[list(arm.independent_joints)]
    solved = [solver.solve(target, middle) for target in targets]
    assert all(good for _, good, _, _ in solved)
    joints = arm.complete(np.array([configuration for configuration, _, _, _ in solved]))
    assert ((joints >= arm.minimum - 1e-6) & (joints <= arm.maximum + 1e-6)).all()
    assert np.linalg.norm(tips_by_product(arm, joints) - targets, axis=1).max() < 2e-3


def test_a_limit_in_the_way_is_kept_by_moving_the_other_joints() -> None:
    """A mimic joint's limit, where the nearest configuration would pass it."""
    arm = load_once("drawing_arm")
    kinematics = kinematics_of(arm)
    before = arm.from_file_units([0.0, 60.0, -60.0, -60.0, -30.0])[:4]
    target = kinematics.tip_mm(before[None])[0] + np.array([-10.0, 0.0, 0.0])
    independent_choice, _, _, _ = solver_of(arm).solve(target, before)
    bound = float(arm.complete(independent_choice)[4]) - 0.05
    tight = replace(arm, joints=(*arm.joints[:4], replace(arm.joints[4], maximum=bound)))
    found, good, _, _ = solver_of(tight).solve(target, before)
    assert good
    room = 6e-3 * (bound - tight.minimum[4])  # the program keeps a little from the limit
    assert bound - room < tight.complete(found)[4] <= bound
    assert np.linalg.norm(tips_by_product(tight, tight.complete(found)[None])[0] - target) < 2e-3


def test_solutions_follow_a_line_in_small_steps(arm: Arm) -> None:
    kinematics = kinematics_of(arm)
    start = reachable_configurations(arm, 1, 1)[0]
    begin = kinematics.tip_mm(start[None])[0]
    targets = begin + np.linspace(0, 1, 21)[:, None] * (np.array([100.0, 0.0, 0.0]) - begin)
    found = solver_of(arm).solve_sequence(targets, start)
    assert found.converged.all() and (found.iterations > 0).all() and (found.error_mm < 2e-3).all()
    steps_s = np.abs(np.diff(found.configurations, axis=0)) / joint_scale(kinematics)
    travelled_mm = np.linalg.norm(np.diff(targets, axis=0), axis=1)
    assert (steps_s.max(axis=1) < 0.02 * travelled_mm).all()  # s for each mm: no change of branch


def test_where_no_limit_interferes_the_solution_is_close_to_the_nearest_configuration(arm: Arm) -> None:
    """The centring term moves it along the redundancy by a little; the projection has none."""
    kinematics = kinematics_of(arm)
    roomy = replace(arm, joints=tuple(replace(joint, minimum=-3.0, maximum=3.0) for joint in arm.joints))
    for before in reachable_configurations(arm, 2, 5):
        target = kinematics.tip_mm(before[None])[0] * [0.98, 0.98, 1.0]
        nearest, exact = project(kinematics, before[None], target[None])
        assert exact[0]
        found, good, _, _ = solver_of(roomy).solve(target, before)
        assert good
        apart_s, moved_s = (
            np.linalg.norm(offset / joint_scale(kinematics)) for offset in (found - nearest[0], nearest[0] - before)
        )
        assert apart_s < moved_s + 0.05


def test_out_of_reach_is_a_value_and_the_next_target_is_solved_all_the_same(arm: Arm) -> None:
    start = reachable_configurations(arm, 3, 1)[0]
    reached = kinematics_of(arm).tip_mm(start[None])[0]
    found = solver_of(arm).solve_sequence(np.array([reached, [300.0, 0.0, 0.0], reached]), start)
    assert found.converged.tolist() == [True, False, True]
    assert found.error_mm[1] > 100.0
    np.testing.assert_allclose(found.configurations[2], found.configurations[0], atol=0.1)


def test_a_target_that_only_the_limits_forbid_is_not_converged() -> None:
    arm = load_once("drawing_arm")
    behind = np.array([[-80.0, 1.0, 0.0]])
    found = solver_of(arm).solve_sequence(behind, reachable_configurations(arm, 4, 1)[0])
    assert not found.converged[0]
    assert found.configurations.shape == (1, 4)


def test_the_error_is_the_distance_to_the_target_and_no_targets_are_no_configurations(arm: Arm) -> None:
    start = reachable_configurations(arm, 5, 1)[0]
    target = np.array([[250.0, 100.0, 0.0]])
    found = solver_of(arm).solve_sequence(target, start)
    distance = np.linalg.norm(tips_by_product(arm, arm.complete(found.configurations)) - target)
    np.testing.assert_allclose(found.error_mm, distance, rtol=1e-6)
    nothing = solver_of(arm).solve_sequence(target[:0], start)
    assert nothing.configurations.shape == (0, 4) and nothing.converged.dtype == np.bool_


def test_settling_comes_nearer_to_where_a_further_solution_stays_and_is_counted() -> None:
    arm = load_once("drawing_arm")
    start, target = reachable_configurations(arm, 4, 1)[0], np.array([[80.0, 20.0, 0.0]])
    found = [solver_of(arm).solve_sequence(target, start, settle=settle) for settle in (True, False)]
    converged, at_once = (
        np.abs(solver_of(arm).solve(target[0], each.configurations[0])[0] - each.configurations[0]).max()
        for each in found
    )
    assert converged < 0.5 * at_once
    assert found[0].iterations[0] > found[1].iterations[0] > 0


@pytest.mark.parametrize("name", ["drawing_arm", "scara", "so101", "ur5e", "lift_drawing_arm", "board_six"])
def test_every_random_target_in_reach_is_solved_from_the_start_with_the_pen_down(name: str) -> None:
    arm = (KNOWN_ARMS | PLANE_ARMS)[name] if name in KNOWN_ARMS | PLANE_ARMS else load_once(name)
    targets = random_targets(kinematics_of(arm), 60, 0).tips_mm
    kinematics = kinematics_of(arm)
    start = kinematics.independent_of(default_start(model_of(arm), TargetKind.RANDOM))
    found = solver_of(arm).solve_sequence(targets, start, settle=False)
    assert found.converged.all()
    joints = arm.complete(found.configurations)
    assert ((joints >= arm.minimum - 1e-6) & (joints <= arm.maximum + 1e-6)).all()
    tips = tips_by_product(arm, joints)
    assert np.linalg.norm(tips - arm.paper.to_base(targets), axis=1).max() < 2e-3
    if arm.pen.hold is PenHold.TOOL_AXIS:
        assert (kinematics.tool_axis(found.configurations)[:, 2] < 0).all()


def test_a_configuration_that_only_the_very_limit_allows_is_found_last() -> None:
    arm = load_once("three_joint")
    configuration = kinematics_of(arm).independent_of(arm.maximum - 1e-3 * (arm.maximum - arm.minimum))
    target = kinematics_of(arm).tip_mm(configuration[None])[0]
    _, good, _, miss_mm = solver_of(arm).solve(
        target, kinematics_of(arm).independent_of((arm.minimum + arm.maximum) / 2)
    )
    assert good and miss_mm < 1e-3
