"""How a pen that is held by its tool axis has to point."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray
from planner.checking.chain import base_vectors, chain_poses

_NEARLY_LEVEL_DEG = 5.0
_PROBES = 24
_STEP_RAD = 1e-4
_ALWAYS = 1e-6


def held_along(arm: Arm) -> FloatArray:
    """(3,) in the paper's frame: straight at the paper. Only an arm that cannot lean its pen sideways holds it to the
    base's vertical instead, before a paper that is not more than 5 degrees from level."""
    vertical = base_vectors(arm, np.array([[0.0], [0.0], [1.0]]))[:, 0]
    if np.degrees(np.arccos(np.clip(vertical[2], -1.0, 1.0))) <= _NEARLY_LEVEL_DEG and not _leans(arm, vertical):
        return -vertical
    return np.array([0.0, 0.0, -1.0])


def _leans(arm: Arm, vertical: FloatArray) -> bool:
    """Whether the pen can point elsewhere than within an upright plane. It cannot where it always is upright, or where
    one joint always turns it square to its own axis, and about a level one."""
    span = (len(arm.independent_joints), _PROBES)
    positions = arm.complete(np.random.default_rng(0).uniform(-np.pi, np.pi, span).T)
    tool = chain_poses(arm, positions).tool
    if (np.abs(vertical @ tool) > 1.0 - _ALWAYS).all():
        return False
    for index, joint in enumerate(arm.joints):
        if joint.kind is JointKind.REVOLUTE:
            step = np.zeros(arm.n_joints)
            step[index] = _STEP_RAD
            ahead, behind = (chain_poses(arm, positions + by).tool for by in (step, -step))
            turn = (ahead - behind) / (2.0 * np.sin(_STEP_RAD))
            about = np.cross(tool, turn, axis=0)
            if (np.abs(np.linalg.norm(turn, axis=0) - 1.0) < _ALWAYS).all() and (
                np.abs(vertical @ about) < _ALWAYS
            ).all():
                return False
    return True
