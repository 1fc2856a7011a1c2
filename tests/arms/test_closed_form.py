"""The drawing arm's closed form: forward kinematics undoes it on both elbows, and its gaps are true distances."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.arms.closed_forms import closed_form_postures
from planner.arms.closed_forms.drawing_arm import centred_postures, postures
from planner.arms.kinematics import kinematics_of
from planner.arms.posture_field import posture_field, within_limits
from planner.arms.projection import project
from planner.errors import UsageError
from tests.arms.chains import DRAWING_ARMS, load_once, reachable_postures, tips_by_product

ARMS = st.sampled_from(DRAWING_ARMS).map(load_once)


def wrapped(angles_rad: np.ndarray) -> np.ndarray:
    return (angles_rad + np.pi) % (2 * np.pi) - np.pi


@settings(deadline=None, max_examples=20)
@given(arm=ARMS, seed=st.integers(0, 2**32 - 1))
def test_forward_kinematics_undoes_it_on_both_elbows(arm: Arm, seed: int) -> None:
    free = reachable_postures(arm, seed, 30)
    tips = kinematics_of(arm).tip_mm(free)
    base = arm.joints[0].d_mm
    wrist_radius = 50 * np.cos(np.cumsum(free[:, 1:], axis=1)).sum(axis=1)
    free, tips = free[wrist_radius > 1.0], tips[wrist_radius > 1.0]  # beyond the axis the base would turn around
    assert len(free) > 10 and base > 0
    pitch = free[:, 1:].sum(axis=1)
    found, gap = postures(arm, tips, pitch)
    assert (gap == 0).all()
    up, down = found[:, 0], found[:, 1]
    assert (np.sin(up[:, 2]) <= 1e-9).all() and (np.sin(down[:, 2]) >= -1e-9).all()
    for elbow in (up, down):
        np.testing.assert_allclose(tips_by_product(arm, arm.complete(elbow)), tips, atol=1e-6)
        np.testing.assert_allclose(wrapped(elbow[:, 1:].sum(axis=1) - pitch), 0, atol=1e-9)
    own = np.where(free[:, 2:3] < 0, up, down)
    np.testing.assert_allclose(wrapped(own - free), 0, atol=1e-5)  # an arc cosine near 1 halves the digits


@settings(deadline=None)
@given(upper=st.floats(30, 70), fore=st.floats(30, 70), distance=st.floats(0.5, 200),
       direction=st.floats(-np.pi, np.pi), pitch=st.floats(-np.pi, np.pi), azimuth=st.floats(-1.5, 1.5),
       offset=st.floats(-30, 30), l5=st.floats(20, 60))
def test_the_gap_is_what_is_missing_of_the_triangle(
        upper: float, fore: float, distance: float, direction: float, pitch: float, azimuth: float, offset: float,
        l5: float) -> None:
    """The end of link 3 lies at a chosen distance from the shoulder: reachable from |L2 - L3| to L2 + L3."""
    built = load_once("drawing_arm")
    arm = replace(built, joints=(
        built.joints[0], replace(built.joints[1], a_mm=upper), replace(built.joints[2], a_mm=fore), built.joints[3],
        replace(built.joints[4], a_mm=l5, d_mm=offset)))
    radius = distance * np.cos(direction) + 50 * np.cos(pitch)
    height = 50 + distance * np.sin(direction) + 50 * np.sin(pitch) - l5
    assume(radius > 0.1)
    c, s = np.cos(azimuth), np.sin(azimuth)
    tip = np.array([[radius * c + offset * s, radius * s - offset * c, height]])
    missing = max(distance - (upper + fore), abs(upper - fore) - distance, 0.0)
    assume(missing == 0.0 or missing > 1e-6)
    found, gap = postures(arm, tip, np.array([pitch]))
    assert gap[0] == pytest.approx(missing, abs=1e-6)
    assume(abs(distance - (upper + fore)) > 1e-3 and abs(distance - abs(upper - fore)) > 1e-3)
    assert np.isnan(found).all() == (missing > 0)
    if missing == 0:
        np.testing.assert_allclose(tips_by_product(arm, arm.complete(found[0])), np.tile(tip, (2, 1)), atol=1e-6)


def test_a_tip_closer_to_the_axis_than_the_pens_offset_is_out_of_reach() -> None:
    """The pen of the arm of 2022 passes the base axis at 27 mm, whatever the posture."""
    arm = load_once("drawing_arm_2022")
    found, gap = postures(arm, np.array([[20.0, 0.0, 0.0], [0.0, 26.9, 0.0]]), np.radians([-60.0, -60.0]))
    assert np.isnan(found).all()
    assert gap[0] >= 7.0 and gap[1] >= 0.1 - 1e-12


def test_centred_postures_lead_to_exact_ones_within_limits(arm: Arm) -> None:
    radii = posture_field(arm).radii_mm
    radius = np.linspace(radii[0] + 1, radii[-1] - 1, 200)
    tips = np.column_stack((radius, np.zeros((200, 2))))
    reference = closed_form_postures(arm)(arm, tips)
    np.testing.assert_array_equal(reference, centred_postures(arm, tips))
    free, exact = project(kinematics_of(arm), reference, tips)
    assert exact.all()
    assert within_limits(arm, free).all()
    assert np.abs(np.diff(free, axis=0)).max() < 0.1  # one elbow all the way, half a millimetre a step
    assert np.isnan(centred_postures(arm, np.array([[200.0, 0.0, 0.0]]))).all()


def test_an_arm_without_closed_form_is_told_of_other_methods() -> None:
    with pytest.raises(UsageError, match="--method"):
        closed_form_postures(replace(load_once("drawing_arm"), closed_form=None))


def test_an_arm_that_only_claims_the_closed_form_is_refused() -> None:
    arm = load_once("drawing_arm")
    short = replace(arm, joints=arm.joints[:4], couplings=())
    twisted = replace(arm, joints=(*arm.joints[:3], replace(arm.joints[3], alpha_rad=0.1), arm.joints[4]))
    turned = replace(arm, joints=(arm.joints[0], replace(arm.joints[1], theta_rad=0.1), *arm.joints[2:]))
    leaning = replace(arm, couplings=(replace(arm.couplings[0], constant_rad=-1.0),))
    for other in (short, twisted, turned, leaning):
        with pytest.raises(UsageError, match="closed form"):
            closed_form_postures(other)
