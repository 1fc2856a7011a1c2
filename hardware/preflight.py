"""What has to be true of a trajectory before an arm is let loose on it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from hardware.calibration import Calibration
from hardware.tip import link_nodes_mm
from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.errors import HardwareError, TrajectoryFileError
from planner.trajectory import Trajectory

_FILE_ROUNDING = 1e-6
"""Joint positions come from a file with six decimals or more, in deg or mm."""
_ALLOWANCE = 1.001
"""A difference of order k is a mean of the k-th derivative, so that what keeps a limit seems to keep it."""
_COUPLING_DEG = 1e-4
_OFF_PAPER_MM = 0.5
"""A planned pen is within micrometres of the paper; one that is off by this belongs to an arm of another shape."""
_CHANGES = (("comes here at", "/s"), ("accelerates here by", "/s2"), ("is jerked here by", "/s3"))


def set_points(trajectory: Trajectory, arm: Arm, source: Path) -> FloatArray:
    """(n_samples, n_joints) set points in rad or mm, once every one of them is known to be safe to send.

    The columns have to be the arm's joints; positions, couplings, velocities, accelerations and jerks have to be
    within their limits, at rest before the first sample and after the last; and the pen on the paper where it draws.
    Errors: TrajectoryFileError with the line of `source` and the joint.
    """
    def refuse(sample: int, reason: str) -> None:
        raise TrajectoryFileError(str(source), trajectory.line(min(sample, trajectory.n_samples - 1)), reason)

    if trajectory.columns != arm.column_names:
        raise TrajectoryFileError(
            str(source), None, f"moves the joints {', '.join(trajectory.columns)}; "
            f"arm '{arm.name}' has {', '.join(arm.column_names)}")
    low, high = arm.to_file_units(np.stack((arm.minimum, arm.maximum)))
    beyond = np.maximum(low - trajectory.positions, trajectory.positions - high) > _FILE_ROUNDING
    if beyond.any():
        sample, joint = _first(beyond)
        unit = arm.joints[joint].file_unit
        refuse(sample, f"joint {arm.joints[joint].name} at {trajectory.positions[sample, joint]:.6g} {unit} is outside "
                       f"its limits of {low[joint]:g} to {high[joint]:g} {unit}")
    limits = arm.to_file_units(np.stack((arm.max_velocity, arm.max_acceleration, arm.max_jerk)))
    change = np.pad(trajectory.positions, ((3, 3), (0, 0)), mode="edge")
    for order, (verb, per) in enumerate(_CHANGES, start=1):
        change = np.diff(change, axis=0) * trajectory.rate_hz
        allowed = limits[order - 1] * _ALLOWANCE + _FILE_ROUNDING * (2 * trajectory.rate_hz) ** order
        too_much = np.abs(change) > allowed
        if too_much.any():
            row, joint = _first(too_much)
            unit = arm.joints[joint].file_unit + per
            refuse(max(row - 3 + order, 0), f"joint {arm.joints[joint].name} {verb} {abs(change[row, joint]):.4g} "
                                            f"{unit}; its limit is {limits[order - 1, joint]:g} {unit}")
    _refuse_motion_at_ends(trajectory, arm, source, limits[2])
    driven = arm.to_file_units(arm.complete(arm.from_file_units(trajectory.positions)[:, list(arm.free_joints)]))
    uncoupled = np.abs(driven - trajectory.positions) > _COUPLING_DEG
    if uncoupled.any():
        sample, joint = _first(uncoupled)
        refuse(sample, f"joint {arm.joints[joint].name} at {trajectory.positions[sample, joint]:.6g} deg breaks its "
                       f"coupling, which asks for {driven[sample, joint]:.6g}")
    positions: FloatArray = np.clip(arm.from_file_units(trajectory.positions), arm.minimum, arm.maximum)
    height_mm = link_nodes_mm(arm, positions)[:, -1, 2]
    off = np.where(trajectory.pen, np.abs(height_mm), -height_mm) > _OFF_PAPER_MM
    if off.any():
        sample = int(np.argmax(off))
        doing = "draws" if trajectory.pen[sample] else "travels"
        refuse(sample, f"the pen of arm '{arm.name}' would be {height_mm[sample]:.3g} mm above the paper where it "
                       f"{doing}; the file says that it is for arm '{trajectory.arm}'")
    return positions


def servo_values(calibration: Calibration, positions: FloatArray, trajectory: Trajectory, source: Path) -> FloatArray:
    """(n, n_joints) pulses or counts of set points that are the samples of a trajectory.

    Errors: TrajectoryFileError with the first line that asks a servo for what is outside its range.
    """
    try:
        return calibration.to_servos(positions)
    except HardwareError:
        sound, beyond = 0, len(positions)  # numbers of samples: so many are known to be sound, so many are not
        while beyond - sound > 1:
            middle = (sound + beyond) // 2
            if _within_ranges(calibration, positions[sound:middle]):
                sound = middle
            else:
                beyond = middle
        try:
            calibration.to_servos(positions[sound])
        except HardwareError as error:
            raise TrajectoryFileError(str(source), trajectory.line(sound), str(error)) from error
        raise


def _within_ranges(calibration: Calibration, positions: FloatArray) -> bool:
    try:
        calibration.to_servos(positions)
    except HardwareError:
        return False
    return True


def _refuse_motion_at_ends(trajectory: Trajectory, arm: Arm, source: Path, max_jerk: FloatArray) -> None:
    """From or to rest, a step is J h^3 / 6 at most."""
    rest = max_jerk / trajectory.rate_hz**3 / 6 * _ALLOWANCE + 2 * _FILE_ROUNDING
    for sample, neighbour, reason in ((0, 1, "sets off from rest at the beginning"),
                                      (-1, -2, "comes to rest at the end (is the file cut off?)")):
        if trajectory.n_samples < 2:
            break
        moving = np.abs(trajectory.positions[sample] - trajectory.positions[neighbour]) > rest
        if moving.any():
            raise TrajectoryFileError(str(source), trajectory.line(sample % trajectory.n_samples),
                                      f"joint {arm.joints[int(np.argmax(moving))].name} is moving, but an arm {reason}")


def _first(bad: BoolArray) -> tuple[int, int]:
    """Indices (sample, joint) of the first True in time."""
    sample, joint = np.unravel_index(int(np.argmax(bad)), bad.shape)
    return int(sample), int(joint)
