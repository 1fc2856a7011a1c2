"""Damped least squares: every printed figure of the worked example, and what the method promises beyond it."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray
from planner.comparison.worked_example import ERRATA, ITERATIONS, LAMBDA_SQUARED, TARGET_CM
from planner.inverse_kinematics.dls import DOCUMENTED, FOR_DRAWING, DlsSettings, DlsSolver
from tests.arms.chains import kinematics_of, load_once, random_configurations, reachable_configurations, tips_by_product
from tests.inverse_kinematics.worked_example import DAMPED_PSEUDOINVERSE, J_JT, JACOBIAN

PRINTED = 0.5e-4 * (1 + 1e-6)
"""Half a unit of the fourth decimal."""
TARGET_MM = 10 * np.array(TARGET_CM)


@pytest.fixture(scope="module")
def documented() -> Arm:
    return load_once("drawing_arm")


@pytest.fixture(scope="module")
def computed(documented: Arm) -> list[dict[str, FloatArray]]:
    """The ten lines of the table, by column, in cm and degrees."""
    start = documented.from_file_units(ITERATIONS[0].angles_deg)
    return [
        {
            "angles_deg": np.degrees(state.joints),
            "position_cm": state.tip_mm / 10,
            "error_cm": state.error_mm / 10,
            "error_plane_cm": np.array([np.hypot(*state.error_mm[:2]) / 10]),
            "error_height_cm": np.array([abs(state.error_mm[2]) / 10]),
            "step_deg": np.degrees(state.step),
        }
        for state in islice(
            DlsSolver(kinematics_of(documented)).iterate(start, TARGET_MM, LAMBDA_SQUARED), len(ITERATIONS)
        )
    ]


def jacobian_cm(arm: Arm) -> FloatArray:
    jacobian = kinematics_of(arm).jacobian(arm.from_file_units(ITERATIONS[0].angles_deg)[None])[0]
    return jacobian * np.array([[0.1], [0.1], [0.1], [1.0], [1.0], [1.0]])


def test_start_position(documented: Arm) -> None:
    start = documented.from_file_units(ITERATIONS[0].angles_deg)
    tip_cm = kinematics_of(documented).tip_mm(kinematics_of(documented).independent_of(start[None]))[0] / 10
    np.testing.assert_allclose(tip_cm, [11.5286, 0.0, 3.5402], rtol=0, atol=PRINTED)


def test_first_jacobian_and_what_is_made_of_it(documented: Arm) -> None:
    J = jacobian_cm(documented)
    np.testing.assert_allclose(J, JACOBIAN, rtol=0, atol=PRINTED)
    np.testing.assert_allclose(J @ J.T, J_JT, rtol=0, atol=PRINTED)
    inverse = J.T @ np.linalg.inv(J @ J.T + LAMBDA_SQUARED * np.eye(6))
    np.testing.assert_allclose(inverse, DAMPED_PSEUDOINVERSE, rtol=0, atol=PRINTED)


@pytest.mark.parametrize(
    "column", ["angles_deg", "position_cm", "error_cm", "error_plane_cm", "error_height_cm", "step_deg"]
)
@pytest.mark.parametrize("iteration", range(len(ITERATIONS)))
def test_iteration_table(computed: list[dict[str, FloatArray]], iteration: int, column: str) -> None:
    """To the printed decimals, but for the three errata: there the print is off and the corrected figure holds."""
    printed = getattr(ITERATIONS[iteration], column)
    if printed is None:
        assert (iteration, column) == (9, "step_deg")
        return
    printed = np.atleast_1d(printed)
    figures = computed[iteration][column]
    assert figures.shape == printed.shape
    for place, (figure, print_) in enumerate(zip(figures, printed, strict=True)):
        correct = ERRATA.get((iteration, column, place))
        if correct is not None:
            assert abs(figure - print_) > 10 * PRINTED
        assert figure == pytest.approx(print_ if correct is None else correct, rel=0, abs=PRINTED)


def test_converged_at_iteration_nine_and_not_before(documented: Arm) -> None:
    start = documented.from_file_units(ITERATIONS[0].angles_deg)
    found = DlsSolver(kinematics_of(documented)).solve_sequence(TARGET_MM[None], start, DOCUMENTED)
    assert found.converged[0] and found.iterations[0] == 9
    np.testing.assert_allclose(np.degrees(found.configurations[0]), ITERATIONS[9].angles_deg[:4], rtol=0, atol=PRINTED)
    assert found.error_mm[0] == pytest.approx(10 * np.linalg.norm(ITERATIONS[9].error_cm), abs=2e-3)
    stopped = DlsSolver(kinematics_of(documented)).solve_sequence(
        TARGET_MM[None], start, DlsSettings(most_iterations=8)
    )
    assert not stopped.converged[0] and stopped.iterations[0] == 8


def test_only_lengths_in_centimetres_give_the_documented_step(documented: Arm) -> None:
    start = documented.from_file_units(ITERATIONS[0].angles_deg)
    in_mm = next(DlsSolver(kinematics_of(documented)).iterate(start, TARGET_MM, 100 * LAMBDA_SQUARED)).step
    assert np.abs(np.degrees(in_mm) - ITERATIONS[0].step_deg).max() > 1.0


def test_a_step_is_the_damped_least_squares_solution_and_keeps_the_coupling(arm: Arm) -> None:
    joints = arm.complete(random_configurations(arm, 1, 1))[0]
    first, second = islice(DlsSolver(kinematics_of(arm)).iterate(joints, np.array([80.0, 20.0, 0.0]), 7.0), 2)
    J = kinematics_of(arm).jacobian(joints[None])[0] / np.array([[10.0], [10.0], [10.0], [1.0], [1.0], [1.0]])
    error = np.concatenate((first.error_mm / 10, np.zeros(3)))
    np.testing.assert_allclose(first.error_mm, [80.0, 20.0, 0.0] - tips_by_product(arm, joints[None])[0], atol=1e-9)
    np.testing.assert_allclose(J.T @ J @ first.step + 7.0 * first.step, J.T @ error, atol=1e-9)
    moved = joints + first.step
    np.testing.assert_allclose(second.joints[:4], moved[:4], atol=1e-12)
    assert second.joints[1:].sum() == pytest.approx(-np.pi / 2, abs=1e-12)
    assert moved[1:].sum() != pytest.approx(-np.pi / 2, abs=1e-6)  # the step by itself would tilt the pen


@pytest.mark.parametrize("settings", [DOCUMENTED, FOR_DRAWING])
def test_tolerances_along_and_across_the_paper_are_met(arm: Arm, settings: DlsSettings) -> None:
    configurations = reachable_configurations(arm, 3, 6)
    targets = kinematics_of(arm).tip_mm(configurations)
    found = DlsSolver(kinematics_of(arm)).solve_sequence(targets, arm.complete(configurations[0] + 0.05), settings)
    miss = tips_by_product(arm, arm.complete(found.configurations)) - targets
    np.testing.assert_allclose(found.error_mm, np.linalg.norm(miss, axis=1), atol=1e-9)
    met = (np.hypot(*miss[:, :2].T) < settings.tolerance_xy_mm) & (np.abs(miss[:, 2]) < settings.tolerance_z_mm)
    np.testing.assert_array_equal(found.converged, met)
    assert met.sum() >= 4


def test_a_tighter_tolerance_takes_more_iterations_and_ends_nearer(documented: Arm) -> None:
    start = documented.from_file_units(ITERATIONS[0].angles_deg)
    rough, fine = (
        DlsSolver(kinematics_of(documented)).solve_sequence(TARGET_MM[None], start, each)
        for each in (DOCUMENTED, FOR_DRAWING)
    )
    assert fine.converged[0] and fine.iterations[0] > rough.iterations[0]
    assert fine.error_mm[0] < 0.02 < rough.error_mm[0]


def test_each_target_starts_from_the_configuration_before(documented: Arm) -> None:
    start = documented.from_file_units(ITERATIONS[0].angles_deg)
    found = DlsSolver(kinematics_of(documented)).solve_sequence(np.tile(TARGET_MM, (3, 1)), start, FOR_DRAWING)
    assert found.iterations[0] > 0 and (found.iterations[1:] == 0).all()
    np.testing.assert_array_equal(found.configurations[2], found.configurations[0])


def test_out_of_reach_is_a_value(arm: Arm) -> None:
    middle = arm.complete(((arm.minimum + arm.maximum) / 2)[list(arm.independent_joints)])
    found = DlsSolver(kinematics_of(arm)).solve_sequence(
        np.array([[300.0, 0.0, 0.0]]), middle, DlsSettings(most_iterations=300)
    )
    assert not found.converged[0] and found.iterations[0] == 300
    assert found.error_mm[0] > 140.0
    nothing = DlsSolver(kinematics_of(arm)).solve_sequence(np.empty((0, 3)), middle, DOCUMENTED)
    assert nothing.configurations.shape == (0, 4) and nothing.converged.shape == (0,)


def test_a_joint_that_slides_counts_in_centimetres_as_all_lengths_do() -> None:
    arm = load_once("stanford")
    joints = (arm.minimum + arm.maximum) / 2
    found = next(DlsSolver(kinematics_of(arm)).iterate(joints, np.array([150.0, 40.0, 0.0]), 7.0))
    slides = np.array([10.0 if joint.kind is JointKind.PRISMATIC else 1.0 for joint in arm.joints])
    J = kinematics_of(arm).jacobian(joints[None])[0] / np.array([[10.0], [10.0], [10.0], [0.1], [0.1], [0.1]]) * slides
    axis = kinematics_of(arm).tool_axis(kinematics_of(arm).independent_of(joints[None]))[0]
    error = np.concatenate((found.error_mm / 10, 10.0 * np.cross(axis, [0.0, 0.0, -1.0])))
    step = found.step / slides
    np.testing.assert_allclose(J.T @ J @ step + 7.0 * step, J.T @ error, atol=1e-9)
