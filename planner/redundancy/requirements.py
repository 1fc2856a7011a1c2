"""What every arm has to have before configurations are sought for it."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import PenHold
from planner.errors import ArmFileError, PlanError
from planner.kinematics.chain import Kinematics

_UPRIGHT_PROBES = 16
_UPRIGHT_DEG = 3.0
"""A real arm leaves its pen so far from upright; what is beyond is a mistake in its file."""


def require_drawing_arm(kinematics: Kinematics) -> None:
    """Errors: PlanError for an arm with too few joints, ArmFileError for one whose couplings or whose chain do not keep
    the pen upright, though its file says so."""
    arm = kinematics.arm
    if kinematics.n_redundant < 0:
        pointed = ", and pointed," if arm.pen.hold is PenHold.TOOL_AXIS else ""
        raise PlanError(
            f"arm {arm.name} cannot be planned for: to have its pen held{pointed} anywhere on the paper"
            f" takes {kinematics.n_task} joints that move by themselves, and it has {kinematics.n_independent}"
        )
    if arm.pen.hold not in (PenHold.COUPLING, PenHold.CONSTRUCTION):
        return
    configurations = np.random.default_rng(0).uniform(
        kinematics.independent_of(arm.minimum),
        kinematics.independent_of(arm.maximum),
        (_UPRIGHT_PROBES, kinematics.n_independent),
    )
    tilt = float(np.degrees(np.arccos(np.clip(-kinematics.tool_axis(configurations)[:, 2], -1.0, 1.0))).max())
    if tilt > _UPRIGHT_DEG:
        raise ArmFileError(
            arm.name,
            [
                f"pen.hold is '{arm.pen.hold}', but the joints leave pen.tool_axis up to"
                f" {tilt:.1f} degrees from straight at the paper: correct the coupling, the DH rows,"
                " pen.tool_axis or [paper], or let the planner hold the pen with 'tool_axis' or 'free'"
            ],
        )
