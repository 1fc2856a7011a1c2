"""Laws of every closed form: forward kinematics undoes each branch, and every configuration is among its branches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.errors import ArmFileError, UsageError
from planner.inverse_kinematics.closed_forms import FAMILIES, Branches, closed_form_of, family_of
from planner.inverse_kinematics.closed_forms.branches import nearest
from planner.kinematics.joint_time import joint_time_s
from planner.kinematics.limits import within_limits
from tests.arms.chains import random_configurations
from tests.inverse_kinematics.closed_forms.arms import (
    ALL,
    WITH_POSE,
    apart,
    arm_of,
    changed,
    family,
    poses_of,
    redundancy_of,
)

COUNT = 10_000
EXACT = 1e-9


@pytest.fixture(params=ALL)
def arm(request: pytest.FixtureRequest) -> Arm:
    return arm_of(request.param)


@pytest.fixture(params=WITH_POSE)
def posed(request: pytest.FixtureRequest) -> Arm:
    """The arms with a whole pose to meet."""
    return arm_of(request.param)


def solve(arm: Arm, independent: FloatArray) -> Branches:
    """The closed form at the pose, or tip and redundancy, of configurations (n, n_independent)."""
    pose = poses_of(arm, arm.complete(independent))
    at_pose = family(arm).at_pose
    return at_pose(arm, pose) if at_pose else family(arm).at_tip(arm, pose[:, :3, 3], redundancy_of(arm, independent))


def miss(arm: Arm, branches: Branches, pose: FloatArray) -> float:
    """How far off its pose the worst branch is, in mm and, where the arm has a whole pose to meet, parts of axes."""
    worst = 0.0
    for k in range(branches.configurations.shape[1]):
        exist = branches.exist[:, k]
        off = np.abs(poses_of(arm, arm.complete(branches.configurations[exist, k])) - pose[exist])
        worst = max(worst, float((off if family(arm).at_pose else off[:, :3, 3]).max(initial=0.0)))
    return worst


def found(arm: Arm, branches: Branches, independent: FloatArray) -> FloatArray:
    """(n,) distance of the branch nearest to each configuration."""
    away = apart(arm, branches.configurations, independent[:, None])
    return np.where(branches.exist, away, np.inf).min(axis=1)


def test_a_configuration_is_among_its_branches_and_each_branch_meets_the_pose(arm: Arm) -> None:
    independent = random_configurations(arm, 1, COUNT)
    branches = solve(arm, independent)
    assert (branches.gap_mm == 0).all() and not branches.singular.any()
    assert found(arm, branches, independent).max() < EXACT
    assert miss(arm, branches, poses_of(arm, arm.complete(independent))) < EXACT


def test_drawing_branches_meet_tip_and_redundancy(arm: Arm) -> None:
    """Configurations that hold the pen down, as `at_tip` gives them: seen from their tips they are among the
    branches."""
    rng = np.random.default_rng(2)
    tip = np.column_stack((rng.uniform(-150, 150, (4000, 2)), rng.uniform(-3, 8, 4000)))
    chosen = rng.uniform(-np.pi, np.pi, 4000)
    branches = family(arm).at_tip(arm, tip, chosen)
    assert branches.exist.any(axis=1).mean() > 0.3
    np.testing.assert_array_equal(branches.exist.any(axis=1), branches.gap_mm == 0)
    for k in range(branches.configurations.shape[1]):
        exist = branches.exist[:, k]
        independent = branches.configurations[exist, k]
        pose = poses_of(arm, arm.complete(independent))
        np.testing.assert_allclose(pose[:, :3, 3], tip[exist], atol=EXACT)
        if family(arm).redundancy:
            assert (
                np.abs(np.angle(np.exp(1j * (redundancy_of(arm, independent) - chosen[exist])))).max(initial=0) < EXACT
            )
        if arm.closed_form in ("six_joint", "stanford"):
            np.testing.assert_allclose(pose[:, :3, 2], np.tile([0, 0, -1], (len(independent), 1)), atol=EXACT)


def test_branches_differ(arm: Arm) -> None:
    """As many as there can be, and no two alike."""
    independent = random_configurations(arm, 3, 300)
    branches = solve(arm, independent)
    count = branches.configurations.shape[1]
    expected = {
        "drawing_arm": 4,
        "scara": 2,
        "three_joint": 4,
        "six_joint": 8,
        "stanford": 8 if arm.joints[2].minimum < 0 else 4,
    }
    assert count == expected[str(arm.closed_form)]
    assert branches.exist.all(axis=1).any()
    for first in range(count):
        for second in range(first):
            both = branches.exist[:, first] & branches.exist[:, second]
            assert (
                apart(arm, branches.configurations[both, first], branches.configurations[both, second]).min(initial=1)
                > 1e-6
            )


def straightened(arm: Arm, independent: FloatArray, bend: float) -> FloatArray | None:
    """The configurations with the angle between upper arm and forearm set; None where the arm has no elbow."""
    elbow = {"drawing_arm": 2, "scara": 1, "three_joint": 2, "six_joint": 2}.get(str(arm.closed_form))
    if elbow is None:
        return None
    fore = 0.0
    if arm.closed_form == "six_joint":
        fore = float(np.arctan2(-np.sin(arm.joints[2].alpha_rad) * arm.joints[3].d_mm, arm.joints[2].a_mm))
    independent = independent.copy()
    independent[:, elbow] = bend - arm.joints[elbow].theta_rad - fore
    return independent


def test_a_stretched_arm_is_singular_and_its_one_configuration_exact(arm: Arm) -> None:
    independent = straightened(arm, random_configurations(arm, 4, COUNT), 0.0)
    if independent is None:
        return
    branches = solve(arm, independent)
    assert branches.singular.all() and (branches.gap_mm == 0).all()
    assert found(arm, branches, independent).max() < EXACT
    assert miss(arm, branches, poses_of(arm, arm.complete(independent))) < EXACT


def test_a_folded_arm_meets_its_pose(arm: Arm) -> None:
    """Links of one length then have their ends at the shoulder, and the shoulder is free."""
    independent = straightened(arm, random_configurations(arm, 5, 2000), np.pi)
    if independent is None:
        return
    branches = solve(arm, independent)
    assert branches.singular.all() and (branches.gap_mm == 0).all() and branches.exist.any(axis=1).all()
    assert miss(arm, branches, poses_of(arm, arm.complete(independent))) < EXACT


@pytest.mark.parametrize("name", ["six_joint", "six_joint/offset", "stanford", "stanford/both_ways"])
@pytest.mark.parametrize("middle", [0.0, np.pi])
def test_aligned_wrist_axes_meet_the_pose_and_share_their_turn(name: str, middle: float) -> None:
    arm = arm_of(name)
    independent = random_configurations(arm, 6, COUNT)
    independent[:, 4] = middle - arm.joints[4].theta_rad
    branches = solve(arm, independent)
    assert branches.singular.all() and (branches.gap_mm == 0).all()
    assert miss(arm, branches, poses_of(arm, arm.complete(independent))) < EXACT
    # All but the share that q4 and q6 have in their common turn is as it was.
    joined, given = branches.configurations.copy(), independent.copy()
    for configurations in (joined, given):
        configurations[..., 5] += np.cos(middle) * configurations[..., 3]
        configurations[..., 3] = 0.0
    away = apart(arm, joined, given[:, None])
    assert np.where(branches.exist, away, np.inf).min(axis=1).max() < EXACT


def test_tips_on_the_base_axis(arm: Arm) -> None:
    """With the plane of the arm through the axis, any direction of the base will do, and one is given."""
    beside = {"drawing_arm": (1, 5), "three_joint": (1, 3), "six_joint": (1, 3), "stanford": (1, 2)}
    first, last = beside.get(str(arm.closed_form), (0, 0))
    offset = sum(joint.d_mm for joint in arm.joints[first:last])
    tip = np.column_stack((np.zeros((200, 2)), np.linspace(-100, 300, 200)))
    tip[100:, :2] = [1e-15, -3e-16]
    branches = family(arm).at_tip(arm, tip, np.zeros(200))
    if offset:
        np.testing.assert_allclose(branches.gap_mm[branches.gap_mm < 1.01 * abs(offset)], abs(offset))
        assert not branches.exist.any()
        return
    assert np.isfinite(branches.gap_mm).all()
    if arm.closed_form == "scara" and arm.joints[0].a_mm != arm.joints[1].a_mm:
        np.testing.assert_allclose(branches.gap_mm, abs(arm.joints[0].a_mm - arm.joints[1].a_mm))
        return
    reached = branches.exist.any(axis=1)
    assert reached.any() and branches.singular[reached].all()
    for k in range(branches.configurations.shape[1]):
        exist = branches.exist[:, k]
        pose = poses_of(arm, arm.complete(branches.configurations[exist, k]))
        np.testing.assert_allclose(pose[:, :3, 3], tip[exist], atol=EXACT)


@pytest.mark.parametrize("name", ["six_joint", "stanford/both_ways"])
def test_a_wrist_on_the_base_axis_or_at_the_shoulder_meets_the_pose(name: str) -> None:
    arm = arm_of(name)
    if name == "stanford/both_ways":
        arm = changed(arm, [{"a_mm": 0.0}, {"d_mm": 0.0}, {}, {}, {}, {}])
    pose = poses_of(arm, random_configurations(arm, 7, 300))
    height = np.linspace(0.0, 60.0, 300) + arm.joints[0].d_mm
    height[:150] = arm.joints[0].d_mm
    pose[:, :3, 3] = arm.joints[5].d_mm * pose[:, :3, 2] + np.column_stack((np.zeros((300, 2)), height))
    branches = family_of(arm).at_pose(arm, pose)  # type: ignore[misc]
    assert branches.singular.all() and branches.exist.any(axis=1).all()
    assert miss(arm, branches, pose) < EXACT


@pytest.mark.parametrize(
    ("name", "tip", "redundancy", "gap"),
    [
        ("drawing_arm", (201.0, 0.0, 0.0), 0.0, 51.0),  # 50 of wrist and 100 of links, level
        ("drawing_arm_2022", (0.0, 20.0, 13.0), 0.0, 7.0),  # 27 is the least distance of this pen from the axis
        ("scara", (0.0, 230.0, 0.0), 1.0, 30.0),
        ("scara/offset", (0.0, 5.0, 0.0), 1.0, 15.0),
        ("three_joint", (0.0, -300.0, 60.0), 0.0, 80.0),
        ("six_joint", (300.0, 0.0, 10.0), 0.0, 60.0),
        ("stanford", (0.0, 25.0, 10.0), 0.0, 15.0),
    ],
)
def test_beyond_reach_there_is_a_gap_and_no_configuration(
    name: str, tip: tuple[float, ...], redundancy: float, gap: float
) -> None:
    arm = arm_of(name)
    branches = family(arm).at_tip(arm, np.array([tip]), np.array([redundancy]))
    np.testing.assert_allclose(branches.gap_mm, gap)
    assert np.isnan(branches.configurations).all() and not branches.singular.any()


def test_scara_has_no_tilted_pose() -> None:
    arm = arm_of("scara")
    pose = poses_of(arm, random_configurations(arm, 8, 2))
    pose[0, :3, :3] = pose[0, :3, :3] @ np.diag([1.0, -1.0, -1.0])
    branches = family(arm).at_pose(arm, pose)  # type: ignore[misc]
    assert branches.gap_mm.tolist() == [np.inf, 0.0]
    assert branches.exist.any(axis=1).tolist() == [False, True]


def test_within_limits_asks_every_joint(arm: Arm) -> None:
    independent = random_configurations(arm, 9, 500)
    branches = solve(arm, independent)
    joints = arm.complete(branches.configurations)
    inside = within_limits(arm, joints)
    expected: BoolArray = ((joints > arm.minimum - 1e-8) & (joints < arm.maximum + 1e-8)).all(axis=-1)
    np.testing.assert_array_equal(inside, expected)
    mimic = arm.complete(independent)
    kept = ((mimic >= arm.minimum) & (mimic <= arm.maximum)).all(axis=1)
    assert inside[kept].any(axis=1).all()
    assert inside.any() and not inside.all()
    assert not within_limits(arm, arm.complete(branches.only(~inside).configurations)).any()


def test_angles_are_at_the_turn_nearest_the_middle_of_their_range(posed: Arm) -> None:
    branches = solve(posed, random_configurations(posed, 10, 500))
    middle = (posed.minimum + posed.maximum) / 2
    turning = np.array([joint.file_unit == "deg" for joint in posed.joints])
    away = np.abs(branches.configurations - middle)[branches.exist][:, turning]
    assert 3 < away.max() <= np.pi + 1e-12


def test_the_nearest_branch_takes_the_least_joint_time(arm: Arm) -> None:
    independent = random_configurations(arm, 11, 200)
    before = random_configurations(arm, 12, 200)
    branches = solve(arm, independent)
    index, time_s = nearest(arm, branches, before)
    for row in range(200):
        times = [
            joint_time_s(arm, arm.complete(before[row]), arm.complete(configuration))
            for configuration in branches.configurations[row]
        ]
        assert times[index[row]] == pytest.approx(np.nanmin(times)) == time_s[row]
    none = branches.only(np.zeros(branches.exist.shape, dtype=bool))
    index, time_s = nearest(arm, none, before)
    assert (index == -1).all() and (time_s == np.inf).all()


def test_blocks_do_not_show(arm: Arm) -> None:
    """Targets are solved in blocks: none, one, and several give the same rows."""
    independent = random_configurations(arm, 13, 9000)
    whole = solve(arm, independent).configurations
    assert solve(arm, independent[:0]).configurations.shape == (0, *whole.shape[1:])
    np.testing.assert_allclose(solve(arm, independent[4090:4100]).configurations, whole[4090:4100], atol=1e-9)


@pytest.mark.parametrize("name", FAMILIES)
def test_rows_of_another_form_are_refused_by_name(name: str) -> None:
    arm = arm_of(name)
    tip, chosen = np.array([[100.0, 0.0, 0.0]]), np.zeros(1)
    twisted = changed(arm, [{}, {"alpha_rad": 0.5}] + [{}] * (arm.n_joints - 2))
    with pytest.raises(ArmFileError, match=r"joints\[1\]\.alpha_deg.*28\.6479"):
        family(arm).at_tip(twisted, tip, chosen)
    fewer = replace(arm, joints=arm.joints[:-1], couplings=())
    with pytest.raises(ArmFileError, match=f"needs {arm.n_joints} of them"):
        FAMILIES[name].at_tip(fewer, tip, chosen)
    with pytest.raises(UsageError, match="no closed form"):
        closed_form_of(replace(arm, closed_form=None))


def test_wrists_whose_axes_do_not_meet_are_refused() -> None:
    arm = arm_of("six_joint")
    for row, value, key in (
        (4, {"d_mm": 5.0}, "d_mm"),
        (4, {"alpha_rad": -np.pi / 2}, "alpha_deg"),
        (3, {"a_mm": 5.0}, "a_mm"),
    ):
        rows: list[dict[str, float]] = [{} for _ in arm.joints]
        rows[row] = value
        with pytest.raises(ArmFileError, match=rf"joints\[{row}\]\.{key}"):
            family(arm).at_tip(changed(arm, rows), np.zeros((1, 3)), np.zeros(1))


def test_a_drawing_arm_needs_its_coupling_and_a_pointing_arm_its_axis() -> None:
    arm = arm_of("drawing_arm")
    loose = replace(arm, couplings=(replace(arm.couplings[0], coefficients=((1, -1.0),)),))
    with pytest.raises(ArmFileError, match="coupling"):
        family(arm).at_tip(loose, np.zeros((1, 3)), np.zeros(1))
    arm = arm_of("stanford")
    sideways = replace(arm, pen=replace(arm.pen, tool_axis=(1.0, 0.0, 0.0)))
    with pytest.raises(ArmFileError, match=r"pen\.tool_axis"):
        family(arm).at_tip(sideways, np.zeros((1, 3)), np.zeros(1))
