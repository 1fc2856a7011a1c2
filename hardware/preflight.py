"""What has to be true of a trajectory before an arm is let loose on it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.errors import TrajectoryFileError
from planner.trajectory import Trajectory

_FILE_ROUNDING = 1e-6
"""Joint positions come from a file with six decimals or more, in deg or mm."""

_COUPLING_DEG = 1e-4


def set_points(trajectory: Trajectory, arm: Arm, source: Path) -> FloatArray:
    """(n_samples, n_joints) set points in rad or mm, once every one of them is known to be safe to send.

    The columns have to be the arm's joints, every sample within their positions and couplings and every step within
    their velocities. Errors: TrajectoryFileError with the line of `source` and the joint.
    """
    if trajectory.columns != arm.column_names:
        raise TrajectoryFileError(
            str(source), None, f"moves the joints {', '.join(trajectory.columns)}; "
            f"arm '{arm.name}' has {', '.join(arm.column_names)}")
    low, high = arm.to_file_units(np.stack((arm.minimum, arm.maximum)))
    beyond = np.maximum(low - trajectory.positions, trajectory.positions - high) > _FILE_ROUNDING
    if beyond.any():
        sample, joint = _first(beyond)
        unit = arm.joints[joint].file_unit
        raise TrajectoryFileError(
            str(source), trajectory.line(sample), f"joint {arm.joints[joint].name} at "
            f"{trajectory.positions[sample, joint]:.6g} {unit} is outside its limits of "
            f"{low[joint]:g} to {high[joint]:g} {unit}")
    steps = np.abs(np.diff(trajectory.positions, axis=0))
    fastest = arm.to_file_units(arm.max_velocity)
    too_fast = steps > fastest / trajectory.rate_hz + 2 * _FILE_ROUNDING
    if too_fast.any():
        sample, joint = _first(too_fast)
        unit = arm.joints[joint].file_unit
        raise TrajectoryFileError(
            str(source), trajectory.line(sample + 1), f"joint {arm.joints[joint].name} comes here at "
            f"{steps[sample, joint] * trajectory.rate_hz:.4g} {unit}/s; its limit is {fastest[joint]:g} {unit}/s")
    driven = arm.to_file_units(arm.complete(arm.from_file_units(trajectory.positions)[:, list(arm.free_joints)]))
    uncoupled = np.abs(driven - trajectory.positions) > _COUPLING_DEG
    if uncoupled.any():
        sample, joint = _first(uncoupled)
        raise TrajectoryFileError(
            str(source), trajectory.line(sample), f"joint {arm.joints[joint].name} at "
            f"{trajectory.positions[sample, joint]:.6g} deg breaks its coupling, which asks for"
            f" {driven[sample, joint]:.6g}")
    positions: FloatArray = np.clip(arm.from_file_units(trajectory.positions), arm.minimum, arm.maximum)
    return positions


def _first(bad: BoolArray) -> tuple[int, int]:
    """Indices (sample, joint) of the first True in time."""
    sample, joint = np.unravel_index(int(np.argmax(bad)), bad.shape)
    return int(sample), int(joint)

