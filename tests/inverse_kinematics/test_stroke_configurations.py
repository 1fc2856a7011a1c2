"""Joint paths by every method: on the pen path, within limits, in one branch; and what cannot be followed is named."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.inverse_kinematics.stroke_configurations import exact_configurations, joint_paths
from planner.kinematics.projection import joint_scale
from planner.placement.pen_path import PenPaths, smooth_paths
from planner.settings import Method
from planner.workspace.canvas import usable_canvas
from tests.arms.chains import kinematics_of, load_once, model_of, references_for, tips_by_product

METHODS = pytest.mark.parametrize("method", list(Method))
FRACTIONS = np.array([0.0, 0.31, 0.77, 1.0])


def on_canvas(arm: Arm, shares: Sequence[tuple[float, float]]) -> FloatArray:
    canvas = usable_canvas(model_of(arm), 5.0)
    return canvas.to_arm_mm(np.array(shares) * [canvas.width_mm, canvas.height_mm])


def two_strokes(arm: Arm) -> PenPaths:
    turn = np.linspace(0, 1.8 * np.pi, 25)
    curve = on_canvas(arm, [(0.5 + 0.2 * np.cos(angle), 0.5 + 0.3 * np.sin(angle)) for angle in turn])
    return smooth_paths([on_canvas(arm, [(0.15, 0.2), (0.25, 0.7), (0.3, 0.25)]), curve], 0.02)


@METHODS
def test_joint_paths_follow_the_pen_path_within_limits(arm: Arm, method: Method) -> None:
    paths = two_strokes(arm)
    splines, infeasible_paths = joint_paths(kinematics_of(arm), references_for(arm, method), paths)
    assert infeasible_paths == []
    joints = splines.positions(FRACTIONS).reshape(-1, arm.n_joints)
    assert ((joints >= arm.minimum - 1e-6) & (joints <= arm.maximum + 1e-6)).all()
    wanted = paths.positions(FRACTIONS).reshape(-1, 2)
    tips = tips_by_product(arm, joints)
    assert np.hypot(*(tips[:, :2] - wanted).T).max() < 0.01
    assert np.abs(tips[:, 2]).max() < 0.01
    np.testing.assert_allclose(joints[:, 1:].sum(axis=1), -np.pi / 2, atol=1e-9)


@METHODS
def test_a_stroke_stays_in_one_branch(arm: Arm, method: Method) -> None:
    """Joint time spent for each millimetre of the pen: a jump between branches would take a thousand times as much."""
    paths = two_strokes(arm)
    splines, _ = joint_paths(kinematics_of(arm), references_for(arm, method), paths)
    fractions = np.linspace(0, 1, 5)
    joints, points = splines.positions(fractions), paths.positions(fractions)
    taken_s = np.abs(np.diff(joints[..., list(arm.independent_joints)], axis=1)) / joint_scale(kinematics_of(arm))
    drawn_mm = np.linalg.norm(np.diff(points, axis=1), axis=2)
    moving = drawn_mm > 0.02  # but for the first crawl out of rest
    assert (taken_s.max(axis=2)[moving] / drawn_mm[moving]).max() < 0.05


@METHODS
def test_single_targets_have_exact_configurations(arm: Arm, method: Method) -> None:
    points = on_canvas(arm, [(0.1, 0.1), (0.5, 0.5), (0.9, 0.2)])
    tips = np.column_stack((points, np.zeros(3)))
    references = references_for(arm, method).at(tips)
    independent, infeasible_paths = exact_configurations(kinematics_of(arm), references, tips)
    assert infeasible_paths == []
    np.testing.assert_allclose(tips_by_product(arm, arm.complete(independent)), tips, atol=1e-6)
    assert references_for(arm, method).at(tips[:0]).shape == (0, 4)


@pytest.mark.parametrize("method", [Method.PATH, Method.CLOSED_FORM])
def test_a_stroke_beyond_reach_is_named_and_the_other_is_not(arm: Arm, method: Method) -> None:
    inside = on_canvas(arm, [(0.3, 0.3), (0.5, 0.5)])
    paths = smooth_paths([inside, np.array([[120.0, 0.0], [180.0, 0.0]])], 0.02)
    _, infeasible_paths = joint_paths(kinematics_of(arm), references_for(arm, method), paths)
    assert [infeasible_path.path for infeasible_path in infeasible_paths] == [1]
    infeasible_path = infeasible_paths[0]
    assert infeasible_path.joint is None and "reach" in infeasible_path.reason
    assert 140.0 < infeasible_path.tip_mm[0] < 153.0 and abs(infeasible_path.tip_mm[1]) < 1.0


def test_a_stroke_beyond_a_joint_limit_names_joint_and_limit() -> None:
    """The base of the arm of 2022 turns to 40 degrees only."""
    arm = load_once("drawing_arm_2022")
    angles = np.radians(np.linspace(0, 75, 30))
    paths = smooth_paths([100 * np.column_stack((np.cos(angles), np.sin(angles)))], 0.02)
    _, infeasible_paths = joint_paths(kinematics_of(arm), references_for(arm, Method.PATH), paths)
    assert len(infeasible_paths) == 1
    infeasible_path = infeasible_paths[0]
    assert (infeasible_path.joint, infeasible_path.limit) == ("q1", "upper limit 40 deg")
    assert "q1" in infeasible_path.reason and "40 deg" in infeasible_path.reason
    single = np.array([[*infeasible_path.tip_mm, 0.0], [0.0, 100.0, 0.0], [300.0, 0.0, 0.0]])
    _, each = exact_configurations(kinematics_of(arm), references_for(arm, Method.PATH).at(single), single)
    assert [(one.path, one.joint) for one in each if one.path > 0] == [(1, "q1"), (2, None)]
