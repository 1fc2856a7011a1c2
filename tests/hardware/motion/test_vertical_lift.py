from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.motion.tip import tip_at
from hardware.motion.vertical_lift import vertical_lift
from planner.arms.arm import Pen, PenHold
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray

ARM = load_arm("drawing_arm")
# Held by its axis instead of by the coupling, the arm has to find the upright pen by itself.
POINTING = replace(ARM, couplings=(), pen=Pen(PenHold.TOOL_AXIS, (1.0, 0.0, 0.0), 5.0, 1.0))


@st.composite
def configurations_on_paper(draw: st.DrawFn) -> FloatArray:
    """Three links whose rises cancel, and an upright pen as long as the base is high."""
    q1, first, third = (draw(st.floats(low, high)) for low, high in ((-90, 90), (50, 80), (-80, -40)))
    second = np.degrees(np.arcsin(-np.sin(np.radians(first)) - np.sin(np.radians(third))))
    return np.radians([q1, first, second - first, third - second, -90 - third])


@settings(max_examples=25)
@given(start=configurations_on_paper(), height_mm=st.floats(0.1, 12))
def test_the_tip_goes_straight_up(start: FloatArray, height_mm: float) -> None:
    for arm in (ARM, POINTING):
        lifted = vertical_lift(arm, start, height_mm)
        tips = [tip_at(arm, configuration) for configuration in lifted]
        tip_mm = np.array([tip.position_mm for tip in tips])
        np.testing.assert_array_equal(lifted[0], start)
        np.testing.assert_allclose(tip_mm[:, :2] - tip_mm[0, :2], 0, atol=1e-3)
        np.testing.assert_allclose(tip_mm[:, 2], np.linspace(0, height_mm, len(lifted)), atol=1e-3)
        np.testing.assert_allclose([tip.axis for tip in tips], np.tile([0.0, 0.0, -1.0], (len(tips), 1)), atol=1e-4)
        assert (lifted >= arm.minimum - 1e-12).all()
        assert (lifted <= arm.maximum + 1e-12).all()
        assert np.abs(np.diff(lifted, axis=0)).max() < np.radians(5)


@settings(max_examples=25)
@given(start=configurations_on_paper())
def test_a_joint_at_its_limit_stays_there_and_the_others_lift(start: FloatArray) -> None:
    barred = replace(
        ARM,
        joints=tuple(
            replace(joint, maximum=float(value)) if joint.name == "q2" else joint
            for joint, value in zip(ARM.joints, start, strict=True)
        ),
    )
    lifted = vertical_lift(barred, start, 3.0)
    assert lifted[:, 1].max() <= barred.maximum[1] + 1e-12
    np.testing.assert_allclose(
        tip_at(ARM, lifted[-1]).position_mm - tip_at(ARM, start).position_mm, [0, 0, 3], atol=1e-2
    )


def test_an_arm_that_cannot_rise_stays_where_it_is() -> None:
    start = np.radians([10.0, 60.0, -60.0, -60.0, -30.0])
    stuck = replace(
        ARM,
        joints=tuple(
            replace(joint, minimum=float(value) - 1e-9, maximum=float(value) + 1e-9)
            for joint, value in zip(ARM.joints, start, strict=True)
        ),
    )
    lifted = vertical_lift(stuck, start, 5.0)
    np.testing.assert_allclose(lifted, np.tile(start, (len(lifted), 1)), atol=1e-8)
