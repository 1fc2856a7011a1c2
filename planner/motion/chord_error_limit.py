"""How fast a path may be gone along so that straight joint lines between samples keep the tip near straight lines.

Joints that move evenly from one sample to the next take the tip along an arc: halfway it is `|d2 tip| / 8` off the
chord, with d2 tip the second derivative along the step. It leaves the paper's plane as well as the line drawn on it.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import JointPaths
from planner.kinematics.chain import Kinematics

_MIDDLE = np.array([0.5])
_STEP_S = 0.01
"""Second derivatives are differences over so long a motion of the fastest joint at its full speed."""


def chord_error_limit(kinematics: Kinematics, paths: JointPaths, chord_error_mm: float, rate_hz: float) -> FloatArray:
    """(total cells,) cap on dsigma/dt in each cell, inf where the tip keeps to the chord."""
    joints, slope = paths.positions(_MIDDLE)[:, 0], paths.positions(_MIDDLE, 1)[:, 0]
    hurry = np.abs(slope / kinematics.arm.max_velocity).max(axis=1)
    step = _STEP_S / np.maximum(hurry, 1e-12)
    before, at, behind = (
        kinematics.tip_mm(kinematics.independent_of(joints + k * step[:, None] * slope)) for k in (-1, 0, 1)
    )
    bend = np.linalg.norm(before - 2 * at + behind, axis=1) / step**2
    with np.errstate(divide="ignore"):
        cap: FloatArray = rate_hz * np.sqrt(8 * chord_error_mm / bend)
    return cap
