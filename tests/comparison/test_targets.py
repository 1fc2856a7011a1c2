"""Targets: where they are, and that going backwards is going backwards."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.comparison import targets as module
from planner.comparison.targets import TargetKind, random_targets, single_targets, targets_along
from planner.errors import PlanError
from tests.arms.chains import kinematics_of, load_once

POINTS = st.tuples(st.floats(-100, 100), st.floats(-100, 100))
STROKES = st.lists(st.lists(POINTS, min_size=1, max_size=5).map(np.array), min_size=1, max_size=5)


@given(strokes=STROKES)
def test_targets_go_along_each_stroke_from_end_to_end(strokes: list[np.ndarray]) -> None:
    found = targets_along(strokes)
    assert len(found.firsts) == len(strokes)
    for stroke, tips, along in zip(
        strokes, np.split(found.tips_mm, found.firsts[1:]), np.split(found.along_mm, found.firsts[1:]), strict=True
    ):
        np.testing.assert_allclose(tips[[0, -1], :2], stroke[[0, -1]], atol=1e-9)
        assert (tips[:, 2] == 0).all() and along[0] == 0
        assert along[-1] == pytest.approx(np.hypot(*np.diff(stroke, axis=0).T).sum())
        step = np.diff(along)
        assert (step <= 1 + 1e-9).all() and np.ptp(step) < 1e-9 if len(step) else True
        assert (np.hypot(*np.diff(tips[:, :2], axis=0).T) <= step + 1e-9).all()  # a chord is no longer than its arc


@given(strokes=STROKES)
def test_backwards_is_every_stroke_from_its_end_and_twice_is_as_before(strokes: list[np.ndarray]) -> None:
    found = targets_along(strokes)
    back = found.backwards()
    sequences = np.split(found.tips_mm, found.firsts[1:])
    for sequence, reverse in zip(sequences[::-1], np.split(back.tips_mm, back.firsts[1:]), strict=True):
        np.testing.assert_array_equal(sequence[::-1], reverse)
    again = back.backwards()
    np.testing.assert_array_equal(again.tips_mm, found.tips_mm)
    np.testing.assert_array_equal(again.firsts, found.firsts)
    np.testing.assert_array_equal(again.along_mm, found.along_mm)


def test_random_targets_are_in_front_of_the_arm_on_the_paper_and_come_again_with_their_seed() -> None:
    arm = load_once("scara")
    found = random_targets(kinematics_of(arm), 30, 5)
    assert found.kind is TargetKind.RANDOM and found.tips_mm.shape == (30, 3)
    assert (found.tips_mm[:, 2] == 0).all() and (found.tips_mm[:, 0] >= 0).all()
    reach = sum(joint.a_mm for joint in arm.joints)
    radius = np.hypot(*found.tips_mm[:, :2].T)
    assert (radius >= arm.workspace.inner_radius_mm).all() and (radius <= reach).all() and np.ptp(radius) > reach / 3
    np.testing.assert_array_equal(found.tips_mm, random_targets(kinematics_of(arm), 30, 5).tips_mm)
    assert not np.array_equal(found.tips_mm, random_targets(kinematics_of(arm), 30, 6).tips_mm)
    assert len(found.firsts) == 30 and found.backwards().firsts.tolist() == [0]


def test_an_arm_that_hardly_reaches_the_paper_has_no_random_targets(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        module, "usable_configurations", lambda kinematics, independent: np.zeros(len(independent), dtype=bool)
    )
    monkeypatch.setattr(module, "_MOST_DRAWS", 2)
    with pytest.raises(PlanError, match="of 8192 random configurations only 0"):
        random_targets(kinematics_of(load_once("scara")), 3, 0)


def test_single_targets_are_a_course_each() -> None:
    found = single_targets(np.array([[50.0, 0.0, 0.0], [60.0, 0.0, 3.0]]))
    assert found.firsts.tolist() == [0, 1] and found.first().tips_mm.tolist() == [[50.0, 0.0, 0.0]]
