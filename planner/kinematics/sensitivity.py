"""How far the tip strays where a joint is not quite where it should be."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.kinematics.frame_jacobian import frame_jacobian


def tip_sensitivity(arm: Arm, joints: FloatArray) -> FloatArray:
    """(n, 3, n_joints) mm of the tip per degree (or mm) of error of each joint, at configurations (n, n_joints).

    Each servo errs for itself: a coupling is a rule of the plan, and no other joint makes up for an error.
    """
    sensitivity: FloatArray = frame_jacobian(arm, joints)[:, :3] * arm.per_file_unit
    return sensitivity


def sideways_error(arm: Arm, joints: FloatArray) -> FloatArray:
    """(n,) mm on the paper, root mean square over the joints, per degree (or mm) of error of each."""
    along_paper = tip_sensitivity(arm, joints)[:, :2]
    error: FloatArray = np.sqrt((along_paper**2).sum(axis=(1, 2)) / arm.n_joints)
    return error
