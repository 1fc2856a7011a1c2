"""What was found about an arm goes into its file, and all else in that stays as somebody wrote it."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.accuracy import Accuracy
from planner.arms.arm import Arm
from planner.arms.arm_edit import edited
from planner.arms.arm_file import arm_file_text, known_arms, load_arm, read_arm_file
from planner.arms.arm_text import arm_toml
from planner.arms.paper_pose import PaperPose
from planner.arms.usual_servos import with_usual_servos
from planner.settings import ConfigurationWeights


def comments(text: str) -> list[str]:
    return [line.partition("#")[2] for line in text.splitlines() if "#" in line]


def other(arm: Arm, number: float) -> Arm:
    """An arm that differs in all that is ever found."""
    joints = []
    for joint in arm.joints:
        assert joint.servo is not None or joint.bus is not None
        moved = replace(joint, d_mm=joint.d_mm + number, minimum=joint.minimum * 0.9 - 0.01, alpha_rad=number / 10)
        points = tuple((0.1 * k, 1000.0 + 100 * k + number) for k in range(8))
        if joint.servo is not None:
            servo = replace(joint.servo, curve=points, direction=-joint.servo.direction, trim_us=number)
            moved = replace(moved, servo=servo)
        else:
            assert joint.bus is not None
            moved = replace(moved, bus=replace(joint.bus, curve=points, count_at_zero=2000 + number, lag_s=0.03))
        joints.append(moved)
    return replace(
        arm,
        joints=tuple(joints),
        paper=PaperPose(number, 1.0, 2.0, 0.01, 0.0, -0.02),
        accuracy=Accuracy(49, 0.1, 0.2, tuple(0.01 for _ in joints)),
        weights=ConfigurationWeights(2.0, 0.5, 0.0, 1.0),
        pen=replace(arm.pen, speed_mm_s=25.0),
        closed_form=None,
    )


def canonical(arm: Arm) -> dict[str, object]:
    return tomllib.loads(arm_toml(arm))


def reread(text: str, folder: Path) -> Arm:
    (folder / "arm.toml").write_text(text, encoding="utf-8")
    return read_arm_file(folder / "arm.toml")


@pytest.mark.parametrize("name", ["drawing_arm", "drawing_arm_2022", "so101"])
@given(number=st.floats(-5, 5, allow_subnormal=False).map(lambda value: round(value, 6)))
@settings(max_examples=5, deadline=None)
def test_it_is_read_back_as_the_arm_that_was_found(
    name: str, number: float, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder, text, before = tmp_path_factory.mktemp("arm"), arm_file_text(name), load_arm(name)
    after = other(before, number)
    changed = edited(text, before, after, "Found by a test.")
    assert canonical(reread(changed, folder)) == canonical(after)
    assert comments(changed) == [" Found by a test.", *comments(text)]
    back = edited(changed, after, before, "Found by a test.")
    assert canonical(reread(back, folder)) == canonical(before)
    assert comments(back) == comments(changed)


@pytest.mark.parametrize("name", known_arms())
def test_what_did_not_change_stays_letter_by_letter(name: str) -> None:
    text, arm = arm_file_text(name), load_arm(name)
    assert edited(text, arm, arm, "Nothing.") == f"# Nothing.\n{text}"
    lifted = replace(arm, pen=replace(arm.pen, lift_mm=arm.pen.lift_mm + 1.5))
    lines = [(a, b) for a, b in zip(text.splitlines(), edited(text, arm, lifted, "R.").splitlines()[1:], strict=True)]
    assert [(a.partition("=")[0], b.partition("=")[0]) for a, b in lines if a != b] == [("lift_mm ", "lift_mm ")]


def test_links_of_modified_rows_are_changed_as_those_of_standard_ones(tmp_path: Path) -> None:
    text = 'dh = "modified"\n' + arm_file_text("so101")
    before = reread(text, tmp_path)
    assert before.joints[1].origin.is_identity and not before.joints[0].origin.is_identity
    after = other(before, 1.5)
    assert canonical(reread(edited(text, before, after, "Found."), tmp_path)) == canonical(after)
    quick = replace(before, pen=replace(before.pen, speed_mm_s=22.0))
    changed = edited(text, before, quick, "Found.")
    assert canonical(reread(changed, tmp_path)) == canonical(quick)
    assert comments(changed) == [" Found.", *comments(text)]


WRITTEN_OTHERWISE = """
name = "odd"   # a name
source = 'me'
pen.hold = "construction"
pen.lift_mm = 4  # dotted
workspace = { inner_radius_mm = 10, min_tip_speed_mm_s = 5 }
joints = [
  # the first
  { name = "a", kind = "revolute", alpha_deg = 90, min_deg = -90, max_deg = 90, max_velocity_deg_s = 100, \
max_acceleration_deg_s2 = 100, max_jerk_deg_s3 = 100, d_mm = 40 },
  { name = "b", kind = "prismatic", min_mm = 0, max_mm = 90, max_velocity_mm_s = 100, max_acceleration_mm_s2 = 100, \
max_jerk_mm_s3 = 100, servo = { channel = 3, pulse_at_zero_us = 600, us_per_mm = 20, pulse_range_us = [600, 2400] } },
]
"""


def test_a_file_in_another_of_tomls_forms_is_changed_as_well(tmp_path: Path) -> None:
    before = reread(WRITTEN_OTHERWISE, tmp_path)
    after = other(with_usual_servos(before), 1.25)
    changed = edited(WRITTEN_OTHERWISE, before, after, "Found.")
    assert canonical(reread(changed, tmp_path)) == canonical(after)
    assert comments(changed) == [" Found.", " a name", " dotted", " the first"]
    np.testing.assert_allclose(reread(changed, tmp_path).paper.T_base_paper, after.paper.T_base_paper, atol=1e-6)
