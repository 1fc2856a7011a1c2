"""The chord-error limit: joints that move straight from sample to sample keep the tip near the chord, and go no slower
than that takes."""

from __future__ import annotations

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.inverse_kinematics.stroke_configurations import joint_paths
from planner.motion.chord_error_limit import chord_error_limit
from planner.placement.pen_path import smooth_paths
from planner.settings import Method
from tests.arms.chains import kinematics_of, references_for

_CHORD_ERROR_MM, _RATE_HZ = 0.002, 100.0


@pytest.mark.parametrize("rate_hz", [50.0, 100.0])
def test_a_step_at_the_limit_strays_by_the_chord_error(arm: Arm, rate_hz: float) -> None:
    """By less it would be slower than need be, by more the tip would leave its place."""
    kinematics = kinematics_of(arm)
    strokes = [np.array([[90.0, -20.0], [120.0, 10.0], [100.0, 15.0]]), np.array([[95.0, 0.0], [125.0, 0.1]])]
    splines, infeasible = joint_paths(kinematics, references_for(arm, Method.PATH), smooth_paths(strokes, 0.02))
    assert not infeasible
    step = chord_error_limit(kinematics, splines, _CHORD_ERROR_MM, rate_hz) / rate_hz
    half = np.array([0.5])
    joints, slope = splines.positions(half)[:, 0], splines.positions(half, 1)[:, 0]
    before, middle, behind = (
        kinematics.tip_mm(kinematics.independent_of(joints + k * step[:, None] * slope)) for k in (-0.5, 0.0, 0.5)
    )
    stray_mm = np.linalg.norm(0.5 * (before + behind) - middle, axis=1)
    assert (step > 0).all()
    np.testing.assert_allclose(stray_mm, _CHORD_ERROR_MM, rtol=0.05)
