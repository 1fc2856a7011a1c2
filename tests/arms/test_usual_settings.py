"""What is planned with for an arm where nobody says it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arms.accuracy import Accuracy
from planner.arms.arm import Arm
from planner.arms.arm_file import known_arms, load_arm
from planner.arms.usual_settings import usual_clearance_mm, usual_rate_hz, usual_tolerance_mm

ARM = load_arm("drawing_arm")


@pytest.mark.parametrize("name", known_arms())
def test_arms_that_come_along_keep_the_usual_tolerance(name: str) -> None:
    assert usual_tolerance_mm(load_arm(name)) == 0.05


@pytest.mark.parametrize("name", known_arms())
def test_arms_that_come_along_have_the_usual_clearance(name: str) -> None:
    arm = load_arm(name)
    assert usual_clearance_mm(arm) == arm.pen.clearance_mm == 1.0


def test_pulses_come_fifty_times_a_second_and_those_of_a_bus_as_its_arm_says() -> None:
    rates_hz = {name: usual_rate_hz(load_arm(name)) for name in ("drawing_arm", "drawing_arm_2022", "so101", "scara")}
    assert rates_hz == {
        "drawing_arm": pytest.approx(50.0),
        "drawing_arm_2022": pytest.approx(50.0),
        "so101": pytest.approx(100.0),
        "scara": 100.0,  # its file does not say
    }


@given(st.floats(0.0001, 0.1))
def test_servos_take_each_sample_or_as_many_whole_ones_as_make_fifty_a_second(period_s: float) -> None:
    rate_hz = usual_rate_hz(replace(ARM, set_point_period_s=period_s))
    assert 50.0 - 1e-6 <= rate_hz <= 10_000.0 + 1e-6
    if period_s <= 0.02:
        assert rate_hz == pytest.approx(1 / period_s)
    else:
        assert rate_hz < 50.0 + 1 / period_s + 1e-6
        assert rate_hz * period_s == pytest.approx(round(rate_hz * period_s))


@given(st.floats(0.0, 2.0))
def test_the_tolerance_follows_the_error_that_is_expected(tip_mm: float) -> None:
    arm = replace(ARM, accuracy=Accuracy(49, tip_mm, 0.1, (0.0,) * ARM.n_joints))
    assert usual_tolerance_mm(arm) == pytest.approx(max(0.05, tip_mm / 2**0.5), rel=0.05)


def _off_in_height(height_mm: float, lift_mm: float = 5.0) -> Arm:
    accuracy = Accuracy(49, 0.1, height_mm, (0.0,) * ARM.n_joints)
    return replace(ARM, accuracy=accuracy, pen=replace(ARM.pen, lift_mm=lift_mm))


@given(st.floats(0.0, 2.0), st.integers(0, 2**32 - 1))
def test_at_its_clearance_a_pen_has_left_the_paper_at_95_of_100_places(height_mm: float, seed: int) -> None:
    paper_mm = np.random.default_rng(seed).normal(0.0, height_mm, 2000)
    assert (paper_mm < usual_clearance_mm(_off_in_height(height_mm))).mean() >= 0.93


@given(st.floats(0.0, 3.0), st.floats(0.0, 3.0), st.floats(0.5, 20.0))
def test_a_better_arm_has_no_higher_clearance_and_none_has_one_above_its_lift(
    one_mm: float, other_mm: float, lift_mm: float
) -> None:
    low, high = (usual_clearance_mm(_off_in_height(height, lift_mm)) for height in sorted((one_mm, other_mm)))
    assert 0.0 < low <= high <= lift_mm
