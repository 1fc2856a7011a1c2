"""What keeps the pen of an arm to the paper, where nobody says: as much as its chain allows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from planner.arms.arm import Arm, PenHold
from planner.kinematics.chain import Kinematics

_PROBES = 16
_LEVEL = 1e-6
"""What the height of a unit vector may change by that stays upright."""


def with_hold(arm: Arm, hold: str) -> tuple[Arm, list[str]]:
    """The arm with its pen held so."""
    return replace(arm, pen=replace(arm.pen, hold=PenHold(hold))), []


def with_usual_hold(arm: Arm) -> tuple[Arm, list[str]]:
    """The arm with its pen pointed straight down, if it has the joints for that; by its chain, if that keeps the pen
    upright in every configuration; else with its tip held alone. And what is to be told of it."""
    pointed, _ = with_hold(arm, PenHold.TOOL_AXIS)
    kinematics = Kinematics(pointed)
    configurations = np.random.default_rng(0).uniform(-np.pi, np.pi, (_PROBES, kinematics.n_independent))
    upright = kinematics.tool_axis(configurations)[:, 2]
    if kinematics.n_task == 3 and np.ptp(upright) < _LEVEL:
        kept, _ = with_hold(arm, PenHold.CONSTRUCTION)
        if upright[0] < 0:
            return kept, []
        x, y, z = (-component + 0.0 for component in arm.pen.tool_axis)
        remark = "the chain keeps the tip's axis upright, and the nib points the other way, down"
        return replace(kept, pen=replace(kept.pen, tool_axis=(x, y, z))), [remark]
    if kinematics.n_redundant >= 0:
        return pointed, []
    return with_hold(arm, PenHold.FREE)[0], [
        f"{kinematics.n_independent} joints do not keep a pen straight down anywhere on the paper; its tilt is whatever"
        " the chain gives"
    ]
