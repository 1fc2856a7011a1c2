"""Projection onto a target: on it, nearest to the reference, and at rest where nothing has to be done."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.kinematics.projection import RESIDUAL_MM, joint_scale, project
from tests.arms.chains import DRAWING_ARMS, kinematics_of, load_once, reachable_configurations, tips_by_product

ARMS = st.sampled_from(DRAWING_ARMS).map(load_once)
SEEDS = st.integers(0, 2**32 - 1)
quick = settings(max_examples=15, deadline=None)


@quick
@given(arm=ARMS, seed=SEEDS)
def test_the_result_is_on_target_and_its_offset_has_no_part_in_the_null_space(arm: Arm, seed: int) -> None:
    """Stationary: q - r lies in the range of S^2 J^T, that is (q - r) / S in that of (J S)^T."""
    kinematics = kinematics_of(arm)
    reference = reachable_configurations(arm, seed, 40)
    target = kinematics.tip_mm(reference) + np.random.default_rng(seed).uniform(-3, 3, (40, 3))
    found, exact = project(kinematics, reference, target)
    assert exact.sum() > 20  # some targets lie beyond the stretched arm
    missed = np.linalg.norm(tips_by_product(arm, arm.complete(found[exact])) - target[exact], axis=1)
    assert missed.max() < 200 * RESIDUAL_MM
    speed = joint_scale(kinematics)
    _, jacobian = kinematics.task_and_jacobian(found[exact])
    null_space = np.linalg.svd(jacobian * speed)[2][:, kinematics.n_task :]
    offset_s = (found - reference)[exact] / speed
    assert np.abs(null_space @ offset_s[:, :, None]).max() < 1e-4
    assert np.abs(offset_s).max() > 1e-3  # there was something to do


@quick
@given(arm=ARMS, seed=SEEDS)
def test_no_other_configuration_on_the_target_is_nearer(arm: Arm, seed: int) -> None:
    """Against neighbours along the arm's redundancy, put back on the target."""
    kinematics = kinematics_of(arm)
    reference = reachable_configurations(arm, seed, 20)
    target = kinematics.tip_mm(reference) + np.random.default_rng(seed).uniform(-3, 3, (20, 3))
    found, exact = project(kinematics, reference, target)
    speed = joint_scale(kinematics)
    _, jacobian = kinematics.task_and_jacobian(found)
    along = np.linalg.svd(jacobian * speed)[2][:, -1] * speed
    for amount in (-0.01, 0.01):
        neighbour, met = project(kinematics, found + amount * along, target)
        both = exact & met
        near, far = (np.linalg.norm((q - reference)[both] / speed, axis=1) for q in (found, neighbour))
        assert (far > near - 1e-7).all()


@quick
@given(arm=ARMS, seed=SEEDS)
def test_a_reference_on_target_is_its_own_projection(arm: Arm, seed: int) -> None:
    kinematics = kinematics_of(arm)
    reference = reachable_configurations(arm, seed, 20)
    found, exact = project(kinematics, reference, kinematics.tip_mm(reference))
    assert exact.all()
    np.testing.assert_array_equal(found, reference)


def test_targets_are_independent_of_each_other(arm: Arm) -> None:
    kinematics = kinematics_of(arm)
    reference = reachable_configurations(arm, 5, 30)
    target = kinematics.tip_mm(reference) + np.array([1.0, -2.0, 0.5])
    together, _ = project(kinematics, reference, target)
    for index in (0, 11, 29):
        alone, _ = project(kinematics, reference[index : index + 1], target[index : index + 1])
        np.testing.assert_allclose(alone[0], together[index], atol=1e-12)


def test_the_projection_of_a_smooth_course_is_smooth(arm: Arm) -> None:
    """Third differences of the joints along a straight line, far below what timing would notice."""
    kinematics = kinematics_of(arm)
    reference = np.repeat(reachable_configurations(arm, 6, 1), 201, axis=0)
    start = kinematics.tip_mm(reference[:1])
    target = start - np.linspace(0, 5, 201)[:, None] * start / np.linalg.norm(start)
    found, exact = project(kinematics, reference, target)
    assert exact.all()
    assert np.abs(np.diff(found, 3, axis=0)).max() < 1e-5


def test_out_of_reach_is_told_and_nothing_is_raised(arm: Arm) -> None:
    kinematics = kinematics_of(arm)
    reference = reachable_configurations(arm, 7, 3)
    beyond = np.array([[400.0, 0.0, 0.0], [0.0, 0.0, 500.0], [np.nan, 0.0, 0.0]])
    _, exact = project(kinematics, reference, beyond)
    assert not exact.any()
    found, exact = project(kinematics, reference[:0], beyond[:0])
    assert found.shape == (0, 4) and exact.shape == (0,)
