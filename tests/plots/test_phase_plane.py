"""The limit curves of the phase plane against brute force, and what the picture shows of them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.checking.chain import chain_poses
from planner.errors import UsageError
from planner.plots.phase_plane import plot_phase_plane
from planner.plots.speed_limits import path_speeds
from planner.trajectory import Trajectory

MakeTrajectory = Callable[..., Trajectory]
RATE_HZ = 100.0
SCARA = load_arm("scara")


def smooth_path(arm: Arm, way_mm: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Joints (n, n_joints) that swing with the way, and their first and second derivatives by it."""
    unit = np.array([joint.per_file_unit for joint in arm.joints])
    swing, waves = 12.0 * unit, 0.05 + 0.03 * np.arange(arm.n_joints)
    phase = waves * way_mm[:, np.newaxis] + np.arange(arm.n_joints)
    return swing * np.sin(phase), swing * waves * np.cos(phase), -swing * waves**2 * np.sin(phase)


def test_both_curves_are_what_a_search_finds() -> None:
    """The velocity limit by bisection, the acceleration limit by a linear program in (a, v^2) at each place."""
    at_mm = np.concatenate(([0.0], np.cumsum(np.full(400, 0.1))))
    joints, _, _ = smooth_path(SCARA, at_mm)
    speeds = path_speeds(SCARA, joints, np.column_stack((at_mm, np.zeros_like(at_mm))), RATE_HZ)
    np.testing.assert_allclose(speeds.speed_mm_s, 0.1 * RATE_HZ)
    _, slope, _ = smooth_path(SCARA, speeds.way_mm)
    for k in range(0, len(speeds.way_mm), 37):
        low, high = 0.0, 1e7
        while high - low > 1e-6 * high:
            middle = (low + high) / 2
            keeps = bool((np.abs(slope[k]) * middle <= SCARA.max_velocity).all())
            low, high = (middle, high) if keeps else (low, middle)
        assert speeds.velocity_limit_mm_s[k] == pytest.approx(low, rel=1e-4)
        joint = int(speeds.binding[k])
        assert abs(slope[k, joint]) * low == pytest.approx(SCARA.max_velocity[joint], rel=1e-4)
    _, slope, bend = smooth_path(SCARA, speeds.acceleration_way_mm)
    for k in range(0, len(speeds.acceleration_way_mm), 37):
        rows = np.column_stack((slope[k], bend[k])) / SCARA.max_acceleration[:, np.newaxis]
        best = linprog(
            [0, -1], A_ub=np.vstack((rows, -rows)), b_ub=np.ones(2 * SCARA.n_joints), bounds=[(None, None), (0, None)]
        )
        assert speeds.acceleration_limit_mm_s[k] == pytest.approx(np.sqrt(best.x[1]), rel=2e-3)


@given(st.integers(0, 2**32 - 1))
def test_a_motion_that_keeps_the_velocities_stays_under_the_curve(seed: int) -> None:
    random = np.random.default_rng(seed)
    share = random.uniform(-1, 1, (60, SCARA.n_joints)) * random.choice([0.0, 1e-5, 1.0], (60, 1))
    joints = np.cumsum(share * SCARA.max_velocity / RATE_HZ, axis=0)
    tip_mm = np.cumsum(random.uniform(-1, 1, (60, 2)) * random.choice([0.0, 1e-6, 1.0], (60, 1)), axis=0)
    speeds = path_speeds(SCARA, joints, tip_mm, RATE_HZ)
    assert np.all(speeds.speed_mm_s <= speeds.velocity_limit_mm_s * (1 + 1e-9))
    assert np.all(np.diff(speeds.way_mm) > 0)


def tip_of(arm: Arm, trajectory: Trajectory) -> FloatArray:
    return chain_poses(arm, arm.from_file_units(trajectory.positions)).tip_mm.T


def test_the_picture_shows_the_stroke_that_is_asked_for(arm: Arm, make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory()
    tip_mm = tip_of(arm, trajectory)
    for asked, stroke in ((2, 2), (0, 0), (None, 0)):
        (axes,) = plot_phase_plane(trajectory, arm, tip_mm, asked).axes
        samples = trajectory.stroke == stroke
        speeds = path_speeds(arm, arm.from_file_units(trajectory.positions[samples]), tip_mm[samples], 100.0)
        lines = {str(line.get_label()): np.column_stack((line.get_xdata(), line.get_ydata())) for line in axes.lines}
        np.testing.assert_array_equal(lines["speed of the pen"], np.column_stack((speeds.way_mm, speeds.speed_mm_s)))
        np.testing.assert_array_equal(
            lines["velocity limit curve"], np.column_stack((speeds.way_mm, speeds.velocity_limit_mm_s))
        )
        np.testing.assert_array_equal(
            lines["acceleration limit curve"],
            np.column_stack((speeds.acceleration_way_mm, speeds.acceleration_limit_mm_s)),
        )
        assert axes.get_xlabel().endswith("(mm)")
        assert axes.get_ylabel().endswith("(mm/s)")
        assert axes.get_ylim()[1] > speeds.speed_mm_s.max()


@pytest.mark.parametrize(
    ("stroke", "message"), [(3, "no stroke 3: the trajectory has 3, 0 to 2"), (1, "stroke 1 is a tap")]
)
def test_a_stroke_that_has_no_speed_is_refused(
    arm: Arm, make_trajectory: MakeTrajectory, stroke: int, message: str
) -> None:
    trajectory = make_trajectory()
    with pytest.raises(UsageError, match=message):
        plot_phase_plane(trajectory, arm, tip_of(arm, trajectory), stroke)
