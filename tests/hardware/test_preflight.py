from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hardware.preflight import set_points
from planner.arms.arm import Arm
from planner.errors import TrajectoryFileError
from planner.trajectory import Trajectory, read_trajectory, write_trajectory

SAMPLE = 20


def _edited(trajectory: Trajectory, target: Path, old: str, new: str) -> int:
    """Write the file and change one cell of sample SAMPLE; the line's number."""
    write_trajectory(trajectory, target)
    lines = target.read_text().splitlines()
    index = lines.index(next(line for line in lines if line.startswith("t_s"))) + 1 + SAMPLE
    assert old in lines[index]
    lines[index] = lines[index].replace(old, new, 1)
    target.write_text("\n".join(lines) + "\n")
    return index + 1


def test_a_sound_trajectory_becomes_set_points_in_inner_units(
        arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path) -> None:
    trajectory = arc()
    points = set_points(trajectory, arm, tmp_path)
    np.testing.assert_allclose(np.degrees(points), trajectory.positions)


@pytest.mark.parametrize(("new", "reason"), [
    ("190.0", r"joint q2 at 190 deg is outside its limits of 0 to 180 deg"),
    ("66.0", r"joint q2 comes here at 600 deg/s; its limit is 400 deg/s"),
])
def test_an_edited_cell_is_named_by_line_and_joint(
        arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path, new: str, reason: str) -> None:
    source = tmp_path / "traj.csv"
    line = _edited(arc(), source, "60.0", new)
    with pytest.raises(TrajectoryFileError, match=reason) as caught:
        set_points(read_trajectory(source), arm, source)
    assert caught.value.line == line


def test_a_broken_coupling_is_named(arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path) -> None:
    source = tmp_path / "traj.csv"
    line = _edited(arc(), source, "-30.000000000", "-30.010000000")
    reason = "joint q5 at -30.01 deg breaks its coupling, which asks for -30"
    with pytest.raises(TrajectoryFileError, match=reason) as caught:
        set_points(read_trajectory(source), arm, source)
    assert caught.value.line == line


def test_another_arms_joints_are_refused(arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path) -> None:
    foreign = replace(arc(), columns=("a_deg", "b_deg", "c_deg", "d_deg", "e_deg"))
    with pytest.raises(TrajectoryFileError, match=r"a_deg.*arm 'drawing_arm' has q1_deg"):
        set_points(foreign, arm, tmp_path)


def test_rounding_at_a_limit_is_no_fault_and_is_clipped(
        arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path) -> None:
    trajectory = arc()
    positions = trajectory.positions.copy()
    positions[:, 1], positions[:, 2] = 180.0000005, -90.0
    positions[:, 4] = -90.0 - positions[:, 1:4].sum(axis=1)
    points = set_points(replace(trajectory, positions=positions), arm, tmp_path)
    assert points[:, 1].max() <= arm.maximum[1]
