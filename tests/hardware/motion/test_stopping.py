from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.motion.stopping import brake, interpolate, lift, set_off, slow_down
from hardware.motion.tip import tip_at
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.trajectory import Trajectory

RATE_HZ = 100.0


@given(coefficients=st.lists(st.floats(-2, 2), min_size=4, max_size=4), at=st.lists(st.floats(1, 18), min_size=1))
def test_interpolation_follows_constant_jerk(coefficients: list[float], at: list[float]) -> None:
    wanted = np.polynomial.Polynomial(coefficients)
    samples = wanted(np.arange(20.0) / 10)[:, None]
    np.testing.assert_allclose(interpolate(samples, np.array(at))[:, 0], wanted(np.array(at) / 10), atol=1e-9)


def test_interpolation_meets_the_samples_and_rests_outside() -> None:
    samples = np.random.default_rng(1).normal(size=(6, 2))
    np.testing.assert_allclose(interpolate(samples, np.arange(6.0)), samples)
    np.testing.assert_allclose(interpolate(samples, np.array([-3.0, 9.0])), samples[[0, -1]])


@pytest.mark.parametrize("sample", [0, 1, 7, 20, 30, 45, 59, 60])
def test_braking_keeps_to_the_path_and_the_limits(arm: Arm, arc: Callable[..., Trajectory], sample: int) -> None:
    path = arm.from_file_units(arc().positions)
    ramp = brake(arm, path, sample, RATE_HZ)
    np.testing.assert_allclose(ramp.points[:, 1:], np.tile(path[0, 1:], (len(ramp.points), 1)), atol=1e-12)
    assert (np.diff(np.concatenate((path[sample, :1], ramp.points[:, 0]))) >= -1e-5).all()
    np.testing.assert_allclose(ramp.points[-1], path[ramp.end], atol=1e-12)
    before = interpolate(path, sample + np.arange(-6.0, 1.0))
    _keeps_limits(arm, np.concatenate((before, ramp.points, np.tile(ramp.points[-1], (3, 1)))))
    assert len(ramp.points) / RATE_HZ <= 0.41


@pytest.mark.parametrize("sample", [0, 1, 7, 20, 30, 45, 59, 60])
def test_setting_off_joins_the_path_at_a_sample_and_at_its_pace(
    arm: Arm, arc: Callable[..., Trajectory], sample: int
) -> None:
    path = arm.from_file_units(arc().positions)
    ramp = set_off(arm, path, sample, RATE_HZ)
    np.testing.assert_allclose(ramp.points[:, 1:], np.tile(path[0, 1:], (len(ramp.points), 1)), atol=1e-12)
    np.testing.assert_allclose(ramp.points[-1], path[ramp.end], atol=1e-12)
    rest, after = np.tile(path[sample], (3, 1)), interpolate(path, ramp.end + np.arange(1.0, 6.0))
    _keeps_limits(arm, np.concatenate((rest, ramp.points, after)))


def _keeps_limits(arm: Arm, points: FloatArray) -> None:
    change = points
    for limit in (arm.max_velocity, arm.max_acceleration, arm.max_jerk):
        change = np.diff(change, axis=0) * RATE_HZ
        assert (np.abs(change) / limit).max() <= 1.1


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 1000.0])
def test_lift_is_within_limits_straight_and_ends_at_the_lift_height(arm: Arm, rate_hz: float) -> None:
    start = np.radians([25.0, 60.0, -60.0, -60.0, -30.0])
    points = lift(arm, start, rate_hz)
    everything = np.concatenate((np.tile(start, (3, 1)), points))
    assert slow_down(arm, everything, 1 / rate_hz) <= 1
    tips = np.array([tip_at(arm, point).position_mm for point in everything])
    assert (np.diff(tips[:, 2]) >= -1e-6).all()
    assert tips[-1, 2] == pytest.approx(arm.pen.lift_mm, abs=1e-3)
    np.testing.assert_allclose(tips[:, :2] - tips[0, :2], 0, atol=1e-3)
    assert len(points) / rate_hz < 0.3


def test_a_lifted_pen_is_left_alone(arm: Arm) -> None:
    up = lift(arm, np.radians([25.0, 60.0, -60.0, -60.0, -30.0]), RATE_HZ)[-1]
    assert len(lift(arm, up, RATE_HZ)) == 0


def test_slow_down_is_the_factor_that_meets_the_limits(arm: Arm, arc: Callable[..., Trajectory]) -> None:
    path = arm.from_file_units(arc(0.2).positions)
    factor = slow_down(arm, path, 1 / RATE_HZ)
    assert factor > 1
    assert slow_down(arm, path, factor / RATE_HZ) == pytest.approx(1)


@pytest.mark.parametrize("sample", [0, 7, 20, 33, 45])
@pytest.mark.parametrize("slower", [1.0, 2.0, 5.0])
def test_a_ramp_is_the_shortest_that_keeps_the_limits(
    arm: Arm, arc: Callable[..., Trajectory], sample: int, slower: float
) -> None:
    """Of those that there are, with what comes before and after; a path at its limits takes the longest."""
    planned = arm.from_file_units(arc().positions)
    path = interpolate(planned, np.arange(0.0, len(planned), 1 / slower))
    for ramp, joined in (
        (brake(arm, path, sample, RATE_HZ), lambda ramp: (interpolate(path, sample + np.arange(-3.0, 1.0)), ramp)),
        (
            set_off(arm, path, sample, RATE_HZ),
            lambda ramp: (path[[sample] * 3], ramp, interpolate(path, sample + len(ramp) / 2 + np.arange(1.0, 5.0))),
        ),
    ):
        assert ramp.at[-1] == pytest.approx(min(sample + len(ramp.points) / 2, len(path) - 1))
        seconds = len(ramp.points) / RATE_HZ
        if seconds < 0.8:
            assert _share_of_limits(arm, np.concatenate(joined(ramp.points))) <= 1.03
        n = 2 * round(seconds * RATE_HZ / 2) - 2
        assert n < 10 or seconds == pytest.approx(0.1, abs=0.02) or slower < 5.0


@pytest.mark.parametrize("sample", [5, 20, 33])
def test_setting_off_is_braking_seen_backwards(arm: Arm, arc: Callable[..., Trajectory], sample: int) -> None:
    path = interpolate(arm.from_file_units(arc().positions), np.arange(0.0, 60.0, 0.2))
    ramp = set_off(arm, path, sample, RATE_HZ)
    assert len(ramp.points) / RATE_HZ == pytest.approx(0.1)  # as slow as this path is, no longer one is needed
    braked = brake(arm, path[::-1], len(path) - 1 - ramp.end, RATE_HZ)
    assert len(braked.points) == len(ramp.points)
    there_and_back = np.concatenate((path[sample][None], ramp.points[:-1]))[::-1]
    np.testing.assert_allclose(braked.points, there_and_back, atol=1e-9)


def _share_of_limits(arm: Arm, points: FloatArray) -> float:
    """The largest share of a limit, in units of how much slower the motion would have to be."""
    worst, change = 0.0, points
    for order, limit in enumerate((arm.max_velocity, arm.max_acceleration, arm.max_jerk), 1):
        change = np.diff(change, axis=0) * RATE_HZ
        worst = max(worst, float((np.abs(change) / limit).max()) ** (1 / order))
    return worst
