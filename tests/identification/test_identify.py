"""Laws of test motions, and what is found by them of servos that hide their limits."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from hardware.compensation.servo_values import own_calibration
from hardware.playback.program import make_program
from hardware.playback.recording import write_record
from planner.arms.arm import Arm
from planner.arms.arm_file import arms_folder, load_arm
from planner.arrays import FloatArray
from planner.checking.check import check_trajectory
from planner.cli import main
from planner.errors import CalibrationError, TrajectoryFileError, UsageError
from planner.identification.found import MARGIN, found_by_positions, found_by_verdicts, found_of_ladder, with_limits
from planner.identification.measured import Measured, begins_at_s, read_verdicts
from planner.identification.motion import LadderMotion, Quantity, make_motion
from planner.trajectory import read_trajectory, write_trajectory
from tests.identification.hidden_servo import HiddenServo

NAME, RATE_HZ = "drawing_arm_2022", 100.0
ARM = load_arm(NAME)


@cache
def motion_of(name: str = NAME) -> LadderMotion:
    arm = load_arm(name)
    return make_motion(arm, name, own_calibration(arm).reach, RATE_HZ, 3.0)


def told(joint: int) -> FloatArray:
    return ARM.from_file_units(motion_of().trajectory.positions)[:, joint]


def measured(servos: dict[int, HiddenServo], seed: int = 0, every: int = 1) -> Measured:
    """Of these joints; they are caught after each step, and stand still where the next one begins."""
    random = np.random.default_rng(seed)
    motion = motion_of()
    positions = np.full_like(motion.trajectory.positions, np.nan)
    for step in motion.steps:
        if step.joint in servos:
            part = slice(step.first, step.last + 1)
            positions[part, step.joint] = servos[step.joint].measured(told(step.joint)[part], RATE_HZ, random)
    return Measured(np.arange(0, len(positions), every) / RATE_HZ, positions[::every])


def servo(acceleration: float, jerk: float, joint: int = 0) -> HiddenServo:
    """With so many times the limits of the arm file, and with what a servo of 4096 counts shows of itself."""
    one, degree = ARM.joints[joint], np.radians(1.0)
    return HiddenServo(
        acceleration * one.max_acceleration,
        jerk * one.max_jerk,
        play=0.3 * degree,
        noise=0.02 * degree,
        count=0.088 * degree,
    )


@pytest.mark.parametrize("name", [NAME, "so101", "scara", "stanford"])
def test_a_test_motion_is_safe(name: str) -> None:
    arm, trajectory = load_arm(name), motion_of(name).trajectory if name in (NAME, "so101") else None
    if trajectory is None:
        trajectory = make_motion(arm, name, None, 200.0, 2.0).trajectory
    result = check_trajectory(trajectory, arm)
    assert result.passed, result.faults
    assert not trajectory.pen.any()
    assert 1.0 < trajectory.beyond_limits <= 3.0
    moving = np.diff(trajectory.positions, axis=0) != 0
    assert moving.sum(axis=1).max() == 1, "one joint at a time"
    if name in (NAME, "so101"):
        own_calibration(arm).to_servos(arm.from_file_units(trajectory.positions))


def test_steps_grow_and_are_what_the_samples_say() -> None:
    motion = motion_of()
    for joint in range(ARM.n_joints):
        for quantity in Quantity:
            ladder = motion.ladder(joint, quantity)
            assert [step.number for step in ladder] == list(range(1, len(ladder) + 1))
            assert all(after.level > before.level for before, after in pairwise(ladder))
            for step in ladder[:: len(ladder) - 1]:
                differences = np.diff(told(joint)[step.first : step.last + 1], quantity.order)
                assert np.abs(differences).max() * RATE_HZ**quantity.order == pytest.approx(step.level)


@pytest.mark.parametrize(("acceleration", "jerk"), [(0.9, 1.1), (0.9, 1.4)])
@pytest.mark.parametrize("seed", [0, 1])
def test_limits_are_found_within_fifteen_per_cent_and_never_above(acceleration: float, jerk: float, seed: int) -> None:
    hidden = servo(acceleration, jerk)
    seen = measured({0: hidden}, seed)
    by_jerk = found_of_ladder(ARM, motion_of(), seen, 0, Quantity.JERK, "measured.csv", np.inf)
    by_acceleration = found_of_ladder(ARM, motion_of(), seen, 0, Quantity.ACCELERATION, "measured.csv", by_jerk.level)
    for found, true in ((by_jerk, hidden.jerk), (by_acceleration, hidden.acceleration)):
        assert 0.85 * true <= found.proposed <= true


def test_what_was_followed_to_the_end_is_not_lowered() -> None:
    found = found_of_ladder(ARM, motion_of(), measured({0: servo(9.0, 9.0)}), 0, Quantity.ACCELERATION, "m", np.inf)
    assert found.is_end
    assert found.proposed >= ARM.joints[0].max_acceleration


def test_a_joint_that_was_hardly_measured_is_named() -> None:
    with pytest.raises(CalibrationError, match=r"joint q2 was measured 0 times in step 1 of jerk"):
        found_by_positions(ARM, motion_of(), measured({0: servo(2.0, 2.0)}), "m.csv")
    with pytest.raises(CalibrationError, match=r"joint q1 was measured \d+ times"):
        found_by_positions(ARM, motion_of(), measured({0: servo(2.0, 2.0)}, every=40), "m.csv")


def test_verdicts_become_limits_and_nothing_else() -> None:
    found = found_by_verdicts(ARM, motion_of(), read_verdicts("q1=12,q3=20/5", ARM))
    after = with_limits(ARM, found)
    assert [one.name for one, other in zip(ARM.joints, after.joints, strict=True) if one != other] == ["q1", "q3"]
    step = motion_of().ladder(2, Quantity.ACCELERATION)[4]
    assert after.joints[2].max_acceleration == pytest.approx(MARGIN[Quantity.ACCELERATION] * step.level, rel=0.01)
    assert after.joints[2].max_acceleration <= MARGIN[Quantity.ACCELERATION] * step.level
    unchanged = [replace(one, max_acceleration=0.0, max_jerk=0.0) for one in after.joints]
    assert unchanged == [replace(one, max_acceleration=0.0, max_jerk=0.0) for one in ARM.joints]


@pytest.mark.parametrize(
    "text", ["", "q1", "q1=", "q1=x", "q1=3/", "q1=-1", "q9=1", "q1=1,q1=2", "q1=1,,q2=1", "q1=" + "9" * 30]
)
def test_verdicts_that_are_none(text: str) -> None:
    with pytest.raises(UsageError, match="--verdicts"):
        read_verdicts(text, ARM)


@pytest.mark.parametrize("text", ["q1=0", "q1=99", "q1=3/99"])
def test_verdicts_on_steps_that_are_not_there(text: str) -> None:
    with pytest.raises(CalibrationError, match="joint q1 has"):
        found_by_verdicts(ARM, motion_of(), read_verdicts(text, ARM))


def test_a_trajectory_goes_beyond_limits_only_as_a_test_motion(tmp_path: Path) -> None:
    file = tmp_path / "test.csv"
    write_trajectory(motion_of().trajectory, file)
    assert read_trajectory(file).beyond_limits == motion_of().trajectory.beyond_limits
    text = file.read_text()
    for forged in (text.replace("# method: identify", "# method: path"), re.sub("limits: .*", "limits: 99", text)):
        file.write_text(forged)
        with pytest.raises(TrajectoryFileError, match="beyond"):
            read_trajectory(file)


def test_plan_run_plays_it_only_when_asked_to(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "test.csv"
    assert main(["identify", "--arm", NAME, "-o", str(file), "--quiet"]) == 0
    assert main(["run", str(file), "--dry-run"]) == 2
    assert "--beyond-limits" in capsys.readouterr().err
    assert main(["run", str(file), "--dry-run", "--beyond-limits"]) == 0
    assert main(["check", str(file)]) == 0


def _recorded(folder: Path, arm: Arm, motion: LadderMotion) -> tuple[Path, float]:
    """What `plan run --record` writes, and when in it the motion begins."""
    trajectory = motion.trajectory
    positions = arm.from_file_units(trajectory.positions)
    program = make_program(arm, positions, trajectory.stroke, RATE_HZ, park=arm.park)
    target = folder / "told.csv"
    write_record(arm, trajectory, program, own_calibration(arm), target)
    return target, program.approach / RATE_HZ


def test_from_a_record_to_a_new_arm_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mine, positions, new = tmp_path / "mine.toml", tmp_path / "at.csv", tmp_path / "new.toml"
    mine.write_text("# My own arm.\n" + (arms_folder() / f"{NAME}.toml").read_text())
    record, begin_s = _recorded(tmp_path, ARM, motion_of())
    seen = measured({joint: servo(0.9, 1.4, joint) for joint in range(ARM.n_joints)})
    at = np.where(np.isnan(seen.positions), ARM.from_file_units(motion_of().trajectory.positions), seen.positions)
    lines = ["t_s," + ",".join(ARM.column_names)]
    lines += [
        f"{time_s + begin_s:.6f}," + ",".join(f"{cell:.4f}" for cell in row)
        for time_s, row in zip(seen.times_s, ARM.to_file_units(at), strict=True)
    ]
    positions.write_text("\n".join(lines) + "\n")
    asked = ["identify", str(mine), "--record", str(record), "--positions", str(positions), "-o", str(new)]
    assert main(asked) == 0
    assert "# My own arm." in new.read_text()
    assert load_arm(str(new)).joints[0].max_acceleration < ARM.joints[0].max_acceleration

    new.unlink()
    assert main([*asked, "--factor", "2"]) == 2
    assert "not the record of the test motion" in capsys.readouterr().err
    positions.write_text("\n".join(lines[: len(lines) // 2]) + "\n")
    assert main(asked) == 2
    assert "before the record does" in capsys.readouterr().err
    positions.write_text("\n".join(line.rpartition(",")[0] for line in lines) + "\n")
    assert main(asked) == 2
    assert "has no column q5_deg" in capsys.readouterr().err
    assert not new.exists()


def test_the_motion_is_found_in_the_record_of_a_run(tmp_path: Path) -> None:
    from planner.error_model.calibration.files import read_record

    file, begin_s = _recorded(tmp_path, ARM, motion_of())
    told_us = own_calibration(ARM).to_servos(ARM.from_file_units(motion_of().trajectory.positions))
    assert begins_at_s(read_record(file, ARM), told_us, motion_of(), "told.csv") == pytest.approx(begin_s)


@pytest.mark.parametrize(
    "arguments",
    [
        ["-o", "x.csv"],
        ["--arm", NAME, NAME, "-o", "x.csv"],
        ["--arm", NAME, "--verdicts", "q1=2", "-o", "x.csv"],
        [NAME, "-o", "x.toml"],
        [NAME, "--record", "a.csv", "-o", "x.toml"],
        [NAME, "--verdicts", "q1=2", "-o", "x.csv"],
    ],
)
def test_options_that_mean_nothing(arguments: list[str]) -> None:
    assert main(["identify", *arguments]) == 2
