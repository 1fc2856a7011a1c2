"""What has to be true of a trajectory before an arm plays it: the laws of the check that protect arm and pen. The check
itself tests them, so that both find the same faults and use the same words."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from hardware.compensation.servo_values import Calibration
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.checking.between import Interpolation, sweep
from planner.checking.check_result import Finding
from planner.checking.joints import columns, couplings, position_limits, rate_limits, rest_at_the_ends
from planner.checking.pen import above_the_paper, links_apart, on_the_paper
from planner.errors import HardwareError, TrajectoryFileError
from planner.trajectory import PATTERN, Trajectory

_FELT_MM = 4.5
"""A pattern feels for the paper: so far below it the pen goes on purpose."""
_OFF_PAPER_MM = 0.5
"""A planned pen is within micrometres of the paper; one that is off by this belongs to an arm of another shape."""


def set_points(trajectory: Trajectory, arm: Arm, source: Path) -> FloatArray:
    """(n_samples, n_joints) set points in rad or mm, once every one of them is known to be safe to send.

    The columns have to be the arm's joints; positions, couplings, velocities, accelerations and jerks have to be
    within their limits, at rest at the first sample and at the last; the pen on the paper where it draws, and nothing
    of the arm in it elsewhere. Errors: TrajectoryFileError with the line of `source`, the law and the joint.
    """
    for finding in _findings(trajectory, arm):
        if not finding.passed:
            line = None if finding.place is None else finding.place.line
            raise TrajectoryFileError(
                str(source),
                line,
                f"breaks a law of 'plan check' for arm '{arm.name}' (the file"
                f" names '{trajectory.arm}'): {finding.words}",
            )
    positions: FloatArray = np.clip(arm.from_file_units(trajectory.positions), arm.minimum, arm.maximum)
    return positions


def _findings(trajectory: Trajectory, arm: Arm) -> Iterator[Finding]:
    """One law after the other: later ones make no sense where an earlier one is broken."""
    yield columns(trajectory, arm)
    yield from position_limits(trajectory, arm)
    yield from rate_limits(trajectory, arm)
    yield from rest_at_the_ends(trajectory, arm)
    yield from couplings(trajectory, arm)
    poses = [sweep(trajectory, arm, Interpolation.LINEAR, per_step=1)]
    felt_mm = _FELT_MM if trajectory.method == PATTERN else 0.0
    yield from on_the_paper(trajectory, poses, _OFF_PAPER_MM, felt_mm)
    yield from above_the_paper(trajectory, poses, max(felt_mm, _OFF_PAPER_MM))
    yield from links_apart(trajectory, poses, _OFF_PAPER_MM)


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
