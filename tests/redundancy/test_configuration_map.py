"""The configuration map: exact, within limits, smooth along the radius, and the same all around the base."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm, Coupling, JointKind
from planner.arms.arm_file import arms_folder, load_arm
from planner.arrays import FloatArray
from planner.errors import ArmFileError, PlanError
from planner.kinematics.limits import within_limits
from planner.kinematics.projection import project
from planner.kinematics.quickest_lift import quickest_lifts
from planner.redundancy.configuration_tests import slowest_direction_mm_s
from tests.arms.chains import DRAWING_ARMS, kinematics_of, load_once, model_of, tips_by_product

ARMS = st.sampled_from(DRAWING_ARMS).map(load_once)


def on_ray(radii_mm: FloatArray, azimuth_rad: float = 0.0, height_mm: float = 0.0) -> FloatArray:
    return np.column_stack(
        (radii_mm * np.cos(azimuth_rad), radii_mm * np.sin(azimuth_rad), np.full(len(radii_mm), height_mm))
    )


def ray_of(arm: Arm, count: int) -> FloatArray:
    configuration_map = model_of(arm).configuration_map()
    return np.linspace(configuration_map.radii_mm[0], configuration_map.radii_mm[-1], count)


def test_configurations_put_the_pen_on_the_paper_within_all_limits(arm: Arm) -> None:
    tips = on_ray(ray_of(arm, 300), azimuth_rad=-0.2)
    independent, good = model_of(arm).configuration_map().configurations_at(tips)
    joints = arm.complete(independent)
    assert good.all()
    assert ((joints >= arm.minimum) & (joints <= arm.maximum)).all()
    np.testing.assert_allclose(tips_by_product(arm, joints), tips, atol=1e-6)


def test_references_are_close_to_exact_already(arm: Arm) -> None:
    tips = on_ray(ray_of(arm, 300))
    assert np.abs(kinematics_of(arm).tip_mm(model_of(arm).configuration_map().reference(tips)) - tips).max() < 1e-3


@settings(deadline=None, max_examples=50)
@given(arm=ARMS, share=st.floats(0, 1), azimuth=st.floats(-1.5, 1.5), turn=st.floats(-1.5, 1.5), height=st.floats(0, 5))
def test_turning_the_target_turns_the_base_and_nothing_else(
    arm: Arm, share: float, azimuth: float, turn: float, height: float
) -> None:
    configuration_map = model_of(arm).configuration_map()
    radius = np.array(
        [configuration_map.radii_mm[0] + share * (configuration_map.radii_mm[-1] - configuration_map.radii_mm[0])]
    )
    here, _ = configuration_map.configurations_at(on_ray(radius, azimuth, height))
    there, _ = configuration_map.configurations_at(on_ray(radius, azimuth + turn, height))
    np.testing.assert_allclose(there - here, [[turn, 0, 0, 0]], atol=1e-7)


def test_the_configuration_path_is_smooth_along_the_radius(arm: Arm) -> None:
    """Steps and bends of the joints. Towards a stretched arm they grow as those of a square root, hence the room."""
    radii = ray_of(arm, 1000)
    step = radii[1] - radii[0]
    independent, _ = model_of(arm).configuration_map().configurations_at(on_ray(radii))
    slope, bend = np.diff(independent, axis=0) / step, np.diff(independent, 2, axis=0) / step**2
    assert np.abs(slope).max() < 0.1  # rad/mm
    inner = radii[2:] < radii[-1] - 5.0
    assert np.abs(bend[inner]).max() < 0.01  # rad/mm^2
    assert np.abs(bend).max() < 0.04
    assert np.abs(np.diff(bend, axis=0)).max() < 0.5 * np.abs(bend).max()  # no kink between two samples


def test_the_field_ends_where_configurations_stop_being_usable(arm: Arm) -> None:
    configuration_map, kinematics = model_of(arm).configuration_map(), kinematics_of(arm)
    room = 0.02 * (arm.maximum - arm.minimum)

    def usable(radius_mm: float, reference: FloatArray) -> bool:
        independent, exact = project(kinematics, reference[None], on_ray(np.array([radius_mm])))
        joints = arm.complete(independent)
        inside = ((joints >= arm.minimum + room - 1e-6) & (joints <= arm.maximum - room + 1e-6))[:, 1:].all()
        raised = joints + 1.1 * arm.pen.lift_mm * (
            quickest_lifts(kinematics, arm.max_jerk, independent) @ arm.coupling_matrix[0].T
        )
        inside &= ((raised >= arm.minimum - 1e-6) & (raised <= arm.maximum + 1e-6)).all()
        return bool(
            exact[0]
            and inside
            and radius_mm > arm.workspace.inner_radius_mm - 1e-6
            and slowest_direction_mm_s(kinematics, independent)[0] > 0.99 * arm.workspace.min_tip_speed_mm_s
        )

    assert usable(configuration_map.radii_mm[0], configuration_map.configurations[0])
    assert usable(configuration_map.radii_mm[-1], configuration_map.configurations[-1])
    assert not usable(configuration_map.radii_mm[-1] + 0.5, configuration_map.configurations[-1])
    assert not usable(configuration_map.radii_mm[0] - 0.5, configuration_map.configurations[0])


def test_limits_are_those_of_all_joints(arm: Arm) -> None:
    independent, _ = model_of(arm).configuration_map().configurations_at(on_ray(ray_of(arm, 3)))
    turned = independent + np.array([arm.maximum[0] - independent[0, 0] + 0.01, 0.0, 0.0, 0.0])
    assert within_limits(arm, arm.complete(independent)).all()
    assert not within_limits(arm, arm.complete(turned[:1])).any()
    low = independent.copy()
    low[:, 1] = arm.minimum[1] - 1e-3
    assert not within_limits(arm, arm.complete(low)).any()


def test_targets_beyond_reach_are_told(arm: Arm) -> None:
    _, good = model_of(arm).configuration_map().configurations_at(on_ray(np.array([160.0, 400.0])))
    assert not good.any()


def test_the_same_arm_has_the_same_configuration_map() -> None:
    one, other = (model_of(load("drawing_arm")).configuration_map() for load in (load_arm, load_once))
    np.testing.assert_array_equal(one.radii_mm, other.radii_mm)
    np.testing.assert_array_equal(one.configurations, other.configurations)


def test_an_arm_that_cannot_have_a_map_is_told_why() -> None:
    arm = load_once("drawing_arm")
    sliding = replace(arm, joints=(replace(arm.joints[0], kind=JointKind.PRISMATIC), *arm.joints[1:]))
    with pytest.raises(PlanError, match="no joint moves the tip in"):
        model_of(sliding).configuration_map()
    leaning = replace(arm, couplings=(Coupling(4, -np.pi / 2, ((0, 0.5), (1, -1.0), (2, -1.0), (3, -1.0))),))
    with pytest.raises(ArmFileError, match="degrees from straight at the paper"):
        model_of(leaning).configuration_map()
    raised = replace(arm, joints=(replace(arm.joints[0], d_mm=300.0), *arm.joints[1:]))
    with pytest.raises(PlanError, match="none gets there, joint limits aside; check d_mm"):
        model_of(raised).configuration_map()


@pytest.mark.parametrize(
    "edit",
    [("constant_deg = -90.0", "constant_deg = -60.0"), ("tool_axis = [1.0, 0.0, 0.0]", "tool_axis = [0.0, 0.0, 1.0]")],
)
def test_a_coupling_that_leaves_the_pen_tilted_is_refused(tmp_path: Path, edit: tuple[str, str]) -> None:
    text = (arms_folder() / "drawing_arm.toml").read_text(encoding="utf-8")
    assert edit[0] in text
    file = tmp_path / "tilted.toml"
    file.write_text(text.replace(*edit), encoding="utf-8")
    with pytest.raises(ArmFileError, match="degrees from straight at the paper"):
        model_of(load_arm(str(file))).configuration_map()
