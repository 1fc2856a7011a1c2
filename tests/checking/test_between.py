"""Interpolation and finite differences keep what their formulas promise, for any motion within its limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.checking.between import POINTS_PER_STEP, Interpolation, cubic_error, positions_between
from planner.checking.joints import rate_limits, rest_at_the_ends
from planner.trajectory import TRAVELLING, Trajectory
from tests.checking.rig import AFFINE, gantry, with_limit

STEP_S = 0.01
FINE = 4 * POINTS_PER_STEP
JERK = 1000.0


def motion(seed: int, n_steps: int) -> FloatArray:
    """(n_steps * FINE + 1,) a position whose jerk jumps between its limits at random fine instants."""
    rng = np.random.default_rng(seed)
    jerk = np.repeat(rng.choice([-JERK, 0.0, JERK], n_steps * FINE // 8 + 1), 8)[: n_steps * FINE]
    fine = STEP_S / FINE
    state = np.array([rng.uniform(-50, 50), rng.uniform(-10, 10), rng.uniform(-50, 50)])
    states = [state]
    for value in jerk:
        q, v, a = state
        state = np.array(
            [q + v * fine + a * fine**2 / 2 + value * fine**3 / 6, v + a * fine + value * fine**2 / 2, a + value * fine]
        )
        states.append(state)
    return np.array(states)


@given(seed=st.integers(0, 2**32 - 1), n_steps=st.integers(3, 9))
def test_cubics_stay_within_their_error(seed: int, n_steps: int) -> None:
    true = motion(seed, n_steps)[:, 0]
    blocks = list(positions_between(true[::FINE, np.newaxis], Interpolation.CUBIC))
    error = np.abs(np.concatenate(blocks)[:, 0] - true[:: FINE // POINTS_PER_STEP])
    assert error.max() <= cubic_error(np.array(JERK), STEP_S) + 1e-12
    assert np.all(error[::POINTS_PER_STEP] < 1e-12)


@given(seed=st.integers(0, 2**32 - 1), n_steps=st.integers(3, 9))
def test_a_motion_at_its_limits_passes_and_one_above_fails(seed: int, n_steps: int) -> None:
    states = motion(seed, n_steps)
    positions = np.zeros((n_steps + 1, 3))
    positions[:, 0] = np.round(states[::FINE, 0], 6)
    arm = with_limit(
        gantry(),
        "h",
        max_velocity=float(np.abs(states[:, 1]).max()),
        max_acceleration=float(np.abs(states[:, 2]).max()),
        max_jerk=JERK,
    )
    pen = np.zeros(n_steps + 1, dtype=bool)
    trajectory = Trajectory(
        "",
        "",
        "",
        1 / STEP_S,
        arm.column_names,
        positions,
        pen,
        np.full(n_steps + 1, TRAVELLING),
        AFFINE,
        decimals=np.full(positions.shape, 6, dtype=np.int8),
    )
    findings = rate_limits(trajectory, arm)
    assert all(finding.passed for finding in findings)
    figure = next(finding for finding in findings if finding.check == "velocity").worst
    assert figure is not None
    tight = with_limit(arm, "h", max_velocity=0.99 * figure - 1e-4)
    assert [finding.check for finding in rate_limits(trajectory, tight) if not finding.passed] == ["velocity"]


@given(st.integers(1, 6), st.integers(0, 2**32 - 1))
def test_lines_are_lines_and_cubics_are_cubics(n_samples: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    positions = rng.uniform(-1, 1, (n_samples, 2))
    points = np.arange((n_samples - 1) * POINTS_PER_STEP + 1) / POINTS_PER_STEP
    for column in range(2):
        lines = np.concatenate(list(positions_between(positions, Interpolation.LINEAR)))[:, column]
        np.testing.assert_allclose(lines, np.interp(points, np.arange(n_samples), positions[:, column]), atol=1e-12)
    cubic = np.polynomial.Polynomial(rng.uniform(-1, 1, min(n_samples, 4)))
    curves = np.concatenate(list(positions_between(cubic(np.arange(n_samples))[:, np.newaxis], Interpolation.CUBIC)))
    np.testing.assert_allclose(curves[:, 0], cubic(points), atol=1e-9)


def test_blocks_meet() -> None:
    positions = np.arange(10_000.0)[:, np.newaxis]
    for interpolation in Interpolation:
        points = np.concatenate(list(positions_between(positions, interpolation)))
        np.testing.assert_allclose(points[:, 0], np.arange(99_991) / POINTS_PER_STEP, atol=1e-8)


def there_and_back(rate_hz: float, decimals: int) -> Trajectory:
    """One joint under full jerk for 60 ms, four times: from rest to rest."""
    ends = 0.06 * np.arange(5)
    t = np.arange(0, ends[-1] + 1e-9, 1 / rate_hz)
    signs = np.array([1.0, -2.0, 0.0, 2.0])  # by how much the jerk changes at the beginning of each part
    rise = sum(change * np.clip(t - begin, 0, None) ** 3 / 6 for change, begin in zip(signs, ends, strict=False))
    positions = np.zeros((len(t), 3))
    positions[:, 0] = np.round(25 + JERK * rise, decimals)
    return Trajectory(
        "",
        "",
        "",
        rate_hz,
        gantry().column_names,
        positions,
        np.zeros(len(t), dtype=bool),
        np.full(len(t), TRAVELLING),
        AFFINE,
        decimals=np.full(positions.shape, decimals, dtype=np.int8),
    )


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 1000.0, 2000.0, 5000.0, 10_000.0])
@pytest.mark.parametrize("decimals", [6, 7, 9, 12])
def test_a_jerk_a_little_above_its_limit_is_found_at_any_rate(rate_hz: float, decimals: int) -> None:
    trajectory = there_and_back(rate_hz, decimals)
    wide = {"max_velocity": 1e6, "max_acceleration": 1e6}
    (rounding,) = set(trajectory.rounding[:, 1])
    assert rounding == pytest.approx(0.5 * 10.0**-decimals)
    sound, tight = (with_limit(gantry(), "h", max_jerk=limit, **wide) for limit in (JERK, JERK / 1.02))
    assert all(finding.passed for finding in rate_limits(trajectory, sound))
    assert [one.check for one in rate_limits(trajectory, tight) if not one.passed] == ["jerk"]


def test_each_cell_is_rounded_by_itself() -> None:
    trajectory = there_and_back(1000.0, 9)
    positions, decimals = trajectory.positions.copy(), np.full(trajectory.positions.shape, 9, dtype=np.int8)
    positions[40, 0], decimals[40, 0] = round(positions[40, 0], 6), 6
    arm = with_limit(gantry(), "h", max_jerk=JERK, max_velocity=1e6, max_acceleration=1e6)
    mixed = replace(trajectory, positions=positions, decimals=decimals)
    assert all(finding.passed for finding in rate_limits(mixed, arm))
    claimed = replace(mixed, decimals=np.full(positions.shape, 9, dtype=np.int8))
    assert not all(finding.passed for finding in rate_limits(claimed, arm))


@pytest.mark.parametrize("decimals", [6, 9])
@pytest.mark.parametrize("rate_hz", [100.0, 1000.0, 10_000.0])
def test_a_start_in_slow_motion_is_found(rate_hz: float, decimals: int) -> None:
    trajectory = there_and_back(rate_hz, decimals)
    arm = with_limit(gantry(), "h", max_jerk=JERK)
    assert all(finding.passed for finding in rest_at_the_ends(trajectory, arm))
    drift = trajectory.positions + 0.2 * trajectory.times_s[:, np.newaxis]  # 0.2 mm/s
    findings = rest_at_the_ends(replace(trajectory, positions=np.round(drift, decimals)), arm)
    assert [finding.passed for finding in findings] == [False, False]
