from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hardware.compensation.servo_values import pulse_calibration
from hardware.playback.preflight import servo_values, set_points
from planner.arms.arm import Arm
from planner.checking.check import check_trajectory
from planner.errors import TrajectoryFileError
from planner.trajectory import TRAVELLING, Trajectory, read_trajectory, write_trajectory

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
    arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path
) -> None:
    trajectory = arc()
    points = set_points(trajectory, arm, tmp_path)
    np.testing.assert_allclose(np.degrees(points), trajectory.positions)


@pytest.mark.parametrize(
    ("new", "reason"),
    [
        ("190.0", r"position of q2: 190 of 180 deg within 0 and 180"),
        ("66.0", r"velocity of q2: 600 of 400 deg/s"),
        ("61.0", r"acceleration of q2: 20000 of 5000.\d* deg/s²"),
        ("60.2", r"jerk of q2: 6e\+05 of 1e\+05 deg/s³"),
    ],
)
def test_an_edited_cell_is_named_by_line_and_joint(
    arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path, new: str, reason: str
) -> None:
    source = tmp_path / "traj.csv"
    line = _edited(arc(), source, "60.0", new)
    with pytest.raises(TrajectoryFileError, match=reason) as caught:
        set_points(read_trajectory(source), arm, source)
    assert caught.value.line == pytest.approx(line, abs=1)  # a jerk is found amid the three steps that it takes


def test_a_broken_coupling_is_named(arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path) -> None:
    source = tmp_path / "traj.csv"
    line = _edited(arc(), source, "-30.000000000", "-30.010000000")
    reason = r"coupling of q5: 0.01 of 0.0001 deg"
    with pytest.raises(TrajectoryFileError, match=reason) as caught:
        set_points(read_trajectory(source), arm, source)
    assert caught.value.line == line


def test_another_arms_joints_are_refused(arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path) -> None:
    foreign = replace(arc(), columns=("a_deg", "b_deg", "c_deg", "d_deg", "e_deg"))
    with pytest.raises(TrajectoryFileError, match=r"a_deg.*arm 'drawing_arm' has q1_deg"):
        set_points(foreign, arm, tmp_path)


def test_a_file_that_was_cut_off_is_refused(arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path) -> None:
    trajectory = arc(4.0)  # slow: the joints are well within their limits where it is cut
    cut = replace(
        trajectory, positions=trajectory.positions[:60], pen=trajectory.pen[:60], stroke=trajectory.stroke[:60]
    )
    with pytest.raises(TrajectoryFileError, match=r"ends at rest of q1: .* \(is the file cut off\?\)") as end:
        set_points(cut, arm, tmp_path)
    assert end.value.line == cut.line(59)


def test_an_arm_of_another_shape_is_refused_though_its_joints_have_the_same_names(
    arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path
) -> None:
    trajectory = arc()
    longer = replace(arm, name="longer", joints=(replace(arm.joints[0], d_mm=52.0), *arm.joints[1:]))
    reason = r"for arm 'longer' \(the file names 'drawing_arm'\): tip on the paper .*: 2 of 0.5 mm"
    with pytest.raises(TrajectoryFileError, match=reason):
        set_points(trajectory, longer, tmp_path)


@pytest.mark.parametrize("sample", [0, 1, 20, 59, 60])
def test_a_pulse_outside_its_servos_range_is_named_by_line(
    arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path, sample: int
) -> None:
    trajectory = arc()
    servo = arm.joints[0].servo
    assert servo is not None
    positions = arm.from_file_units(trajectory.positions)
    within = pulse_calibration(arm).to_servos(positions)[:, 0]
    np.testing.assert_array_equal(servo_values(pulse_calibration(arm), positions, trajectory, tmp_path)[:, 0], within)
    # q1 only ever goes on: a range that ends between two samples is left at the second.
    low, high = np.sort(np.append(within, within[0] - np.sign(within[-1] - within[0])))[[0, -1]]
    edge = within[sample] - np.sign(within[-1] - within[0]) * 1e-4
    ends = (low - 1, edge) if within[-1] > within[0] else (edge, high + 1)
    narrow = replace(arm, joints=(replace(arm.joints[0], servo=replace(servo, pulse_range_us=ends)), *arm.joints[1:]))
    with pytest.raises(TrajectoryFileError, match=r"joint q1 at .* deg asks its servo for .* outside its range") as out:
        servo_values(pulse_calibration(narrow), positions, trajectory, tmp_path)
    assert out.value.line == trajectory.line(sample)


def test_rounding_at_a_limit_is_no_fault_and_is_clipped(
    arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path
) -> None:
    trajectory = replace(arc(), pen=np.zeros(61, dtype=bool), stroke=np.full(61, TRAVELLING))
    positions = trajectory.positions.copy()
    positions[:, 1], positions[:, 2] = 180.0000005, -90.0
    positions[:, 4] = -90.0 - positions[:, 1:4].sum(axis=1)
    written = replace(trajectory, positions=positions, decimals=np.full(positions.shape, 6, dtype=np.int8))
    points = set_points(written, arm, tmp_path)
    assert points[:, 1].max() <= arm.maximum[1]


def _moved(column: int, by: float, samples: slice = slice(SAMPLE, SAMPLE + 1)) -> Callable[[Trajectory], Trajectory]:
    def change(trajectory: Trajectory) -> Trajectory:
        positions = trajectory.positions.copy()
        positions[samples, column] += by
        return replace(trajectory, positions=positions)

    return change


def _tilted(by: float) -> Callable[[Trajectory], Trajectory]:
    """The last links bent throughout, the coupling kept: the tip is off the paper."""
    return lambda trajectory: _moved(4, -by, slice(None))(_moved(1, by, slice(None))(trajectory))


FAULTS: dict[str, Callable[[Trajectory], Trajectory]] = {
    "columns": lambda t: replace(t, columns=("a_deg", *t.columns[1:])),
    "position": _moved(0, 140.0, slice(None)),
    "velocity": _moved(0, 8.0),
    "jerk": _moved(0, 0.12),
    "starts at rest": lambda t: replace(t, positions=t.positions[25:], pen=t.pen[25:], stroke=t.stroke[25:]),
    "ends at rest": lambda t: replace(t, positions=t.positions[:25], pen=t.pen[:25], stroke=t.stroke[:25]),
    "coupling": _moved(4, 2e-4, slice(None)),
    "tip on the paper while the pen is down": _tilted(1.0),
    "tip below the paper while the pen is up": lambda t: replace(
        _tilted(-1.0)(t), pen=np.zeros(t.n_samples, dtype=bool), stroke=np.full(t.n_samples, TRAVELLING)
    ),
}


@pytest.mark.parametrize("law", FAULTS)
def test_the_check_finds_the_same_fault_by_the_same_words(
    law: str, arm: Arm, arc: Callable[..., Trajectory], tmp_path: Path
) -> None:
    spoilt = FAULTS[law](arc())
    (fault,) = [one for one in check_trajectory(spoilt, arm).faults if one.check == law]
    with pytest.raises(TrajectoryFileError) as caught:
        set_points(spoilt, arm, tmp_path)
    # Only the limit differs, where the pre-flight lets the pen be further off the paper.
    words = fault.words if "tip" not in law else fault.words.partition(" of ")[0]
    assert words in str(caught.value)
    if fault.place is not None and "tip" not in law:  # between samples the check may find it a little worse
        assert caught.value.line == fault.place.line
