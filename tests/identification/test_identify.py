"""Laws of test motions, and what is found by them of servos that hide their limits."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from itertools import pairwise, product
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.compensation.servo_values import own_calibration
from hardware.playback.program import make_program
from hardware.playback.recording import write_record
from planner.arms.accuracy import Accuracy
from planner.arms.arm import Arm, PenHold
from planner.arms.arm_file import arms_folder, load_arm
from planner.arms.arm_text import arm_toml
from planner.arrays import FloatArray
from planner.checking.check import check_trajectory
from planner.cli import main
from planner.errors import CalibrationError, TrajectoryFileError, UsageError
from planner.identification.found import (
    MARGIN,
    Found,
    Outcome,
    found_by_positions,
    found_by_verdicts,
    may_tell_more,
    with_limits,
)
from planner.identification.measured import Measured, begins_at_s, read_verdicts
from planner.identification.motion import COARSE, LadderMotion, limits_of, make_motion, scales
from planner.identification.profile import Limits, Quantity, way_at
from planner.identification.room import Room, room_of
from planner.kinematics.chain import Kinematics
from planner.trajectory import read_trajectory, write_trajectory
from tests.identification.hidden_servo import HiddenServo
from tests.identification.limited_servo import COUNT_DEG, LimitedServo, any_servo, moved, reports

NAME, RATE_HZ, FACTOR = "drawing_arm_2022", 100.0, 1.6
ARM = load_arm(NAME)


def planned(arm: Arm) -> LadderMotion:
    return make_motion(arm, arm.name, own_calibration(arm).reach, RATE_HZ, FACTOR)


@cache
def motion_of(name: str = NAME) -> LadderMotion:
    return planned(load_arm(name))


def scaled(arm: Arm, by: float) -> Arm:
    """With so many times the limits."""
    joints = [
        replace(
            one,
            max_velocity=by * one.max_velocity,
            max_acceleration=by * one.max_acceleration,
            max_jerk=by * one.max_jerk,
        )
        for one in arm.joints
    ]
    return replace(arm, joints=tuple(joints))


def told_in_steps(motion: LadderMotion, joint: int) -> FloatArray:
    """(n, n_steps) deg that a joint is told in each of its steps, held at the end of shorter ones."""
    steps = [step for step in motion.steps if step.joint == joint]
    n_most = max(step.last - step.first for step in steps) + 1
    told = [motion.trajectory.positions[step.first : step.last + 1, joint] for step in steps]
    return np.stack([np.pad(one, (0, n_most - len(one)), "edge") for one in told], axis=1)


def reported(motion: LadderMotion, joint: int, servo: LimitedServo, random: np.random.Generator) -> Measured:
    """What the servo of one joint reports of its steps, each of which it begins at rest."""
    steps = [step for step in motion.steps if step.joint == joint]
    was = moved([servo] * len(steps), told_in_steps(motion, joint), RATE_HZ)
    times_s, positions = [], []
    for k, step in enumerate(steps):
        times, seen = reports(servo, was[: round(1000 * (step.last - step.first) / RATE_HZ) + 1, k], random)
        times_s.append(step.first / RATE_HZ + times)
        positions.append(seen)
    table = np.full((sum(map(len, times_s)), len(motion.trajectory.columns)), np.nan)
    table[:, joint] = np.concatenate(positions)
    return Measured(np.concatenate(times_s), np.radians(table))


def found_of(arm: Arm, joint: int, servo: LimitedServo, random: np.random.Generator) -> list[Found]:
    motion = planned(arm)
    return found_by_positions(arm, motion, reported(motion, joint, servo, random), "measured.csv", [joint])


def truth_of(servo: LimitedServo) -> Limits:
    return Limits(servo.velocity, servo.acceleration, servo.jerk).times(np.pi / 180)


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
    arm, has_servos = load_arm(name), name in (NAME, "so101")
    motion = motion_of(name) if has_servos else make_motion(arm, name, None, 200.0, FACTOR)
    trajectory = motion.trajectory
    result = check_trajectory(trajectory, arm)
    assert result.passed, result.faults
    assert not trajectory.pen.any()
    assert 1.0 < trajectory.beyond_limits <= FACTOR
    moving = np.diff(trajectory.positions, axis=0) != 0
    assert moving.sum(axis=1).max() == 1, "one joint at a time"
    if has_servos:
        own_calibration(arm).to_servos(arm.from_file_units(trajectory.positions))


def clear_of(room: Room) -> tuple[FloatArray, FloatArray]:
    """(n_joints,) least and most to which joints may overshoot."""
    beyond = (room.high - room.low) / 4
    return room.low - beyond, room.high + beyond


@pytest.mark.parametrize("name", [NAME, "so101", "drawing_arm"])
def test_an_overshoot_by_a_quarter_of_the_room_touches_nothing(name: str) -> None:
    arm = load_arm(name)
    room = room_of(arm, own_calibration(arm).reach)
    kinematics = Kinematics(replace(arm, couplings=(), pen=replace(arm.pen, hold=PenHold.FREE)))
    for joint, (low, high) in enumerate(zip(*clear_of(room), strict=True)):
        poses = np.repeat(room.pose[None], 50, axis=0)
        poses[:, joint] = np.linspace(low, high, 50)
        assert np.all((poses >= arm.minimum) & (poses <= arm.maximum))
        assert kinematics.nodes_mm(poses)[:, :, 2].min() >= 0.0


@pytest.mark.parametrize("name", [NAME, "so101", "drawing_arm"])
def test_a_joint_that_has_three_quarters_of_its_limits_overshoots_into_what_is_clear(name: str) -> None:
    """Each limit may be that low or by a third higher than the file says, and the others as they come; what reports
    are off by is allowed for."""
    arm, motion, random = load_arm(name), motion_of(name), np.random.default_rng(2)
    low, high = np.degrees(clear_of(room_of(arm, own_calibration(arm).reach)))
    spreads = [np.array(one) for one in product((0.75, 1.35), repeat=3)]
    spreads += list(np.exp(random.uniform(np.log(0.75), np.log(1.35), (4, 3))))
    for joint in range(arm.n_joints):
        told = told_in_steps(motion, joint)
        of_file = [limit / np.radians(1.0) for _, limit in limits_of(arm.joints[joint]).pairs()]
        servos = [
            any_servo(random, *(spread * of_file), lags_before=bool(number % 2))
            for number, spread in enumerate(spreads)
        ]
        every = [servo for servo in servos for _ in range(told.shape[1])]
        was = moved(every, np.tile(told, len(servos)), RATE_HZ)
        assert was.min() >= low[joint] - 2 * COUNT_DEG
        assert was.max() <= high[joint] + 2 * COUNT_DEG


@given(factor=st.floats(0.2, 10.0))
def test_no_step_is_a_leap(factor: float) -> None:
    steps = scales(factor)
    assert steps[0] == 0.1
    assert steps[-1] == factor
    assert all(1.0 < after / before <= COARSE + 1e-9 for before, after in pairwise(steps))


@given(
    quantity=st.sampled_from(Quantity),
    velocity=st.floats(0.5, 10.0),
    acceleration=st.floats(1.0, 100.0),
    jerk=st.floats(10.0, 3000.0),
    length=st.floats(0.2, 4.0),
)
def test_a_way_keeps_to_its_room_and_to_what_it_does_not_try(
    quantity: Quantity, velocity: float, acceleration: float, jerk: float, length: float
) -> None:
    limits = Limits(velocity, acceleration, jerk)
    way = way_at(quantity, limits, length)
    if way is None:
        return
    slack = 1 + 1e-9
    assert way.length <= length * slack
    assert way.velocity <= velocity * slack
    assert way.acceleration <= acceleration * slack
    if quantity is not Quantity.ACCELERATION:  # which needs jerk where there is little room
        assert way.jerk <= jerk * slack
    late = way.limited(quantity, 1.15)
    assert late.length == pytest.approx(way.length)
    assert late.duration_s > way.duration_s
    at = way.positions(np.linspace(0.0, way.duration_s, 200))
    assert np.all(np.diff(at) >= -1e-12)
    assert at[-1] == pytest.approx(way.length)


def test_steps_grow_and_are_what_the_samples_say() -> None:
    motion = motion_of()
    for joint in range(ARM.n_joints):
        for quantity, ladder in motion.ladders(joint).items():
            assert [step.number for step in ladder] == list(range(1, len(ladder) + 1))
            assert all(1.0 < after.level / before.level < 1.02 * COARSE for before, after in pairwise(ladder))
            for step in ladder[:: len(ladder) - 1]:
                differences = np.diff(told(joint)[step.first : step.last + 1], quantity.order)
                assert np.abs(differences).max() * RATE_HZ**quantity.order == pytest.approx(step.level)


@settings(max_examples=4, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    by=st.sampled_from([0.25, 1.0, 4.0]),
    lags_before=st.booleans(),
)
def test_nothing_is_claimed_that_is_not_so(seed: int, by: float, lags_before: bool) -> None:
    """Of a file that is right, or far too low or too high: what was followed the servo has, and where a limit is said
    to be there it is."""
    random = np.random.default_rng(seed)
    arm, joint = load_arm("so101"), int(random.integers(5))
    spread = np.exp(random.uniform(np.log(0.75), np.log(1.35), 3))
    true = [spread[k] * one / np.radians(1.0) for k, (_, one) in enumerate(limits_of(arm.joints[joint]).pairs())]
    servo = replace(any_servo(random, *true, lags_before=lags_before), lag_s=random.uniform(0.015, 0.025))
    tried = scaled(arm, by)
    for one in found_of(tried, joint, servo, random):
        limit = truth_of(servo).of(one.quantity)
        assert one.followed <= 1.2 * limit
        if one.outcome in (Outcome.FOUND, Outcome.ROUGHLY):
            assert one.beyond >= 0.95 * limit
            assert one.proposed <= 1.1 * limit


@pytest.mark.parametrize("by", [0.25, 1.0, 4.0])
def test_limits_are_found_within_fifteen_per_cent_whatever_the_file_says(by: float) -> None:
    """A few test motions, each with the file that the one before wrote."""
    arm, joint, random = scaled(load_arm("so101"), by), 0, np.random.default_rng(1)
    servo = replace(any_servo(random, 190.0, 900.0, 21000.0), lag_s=0.02)
    for _ in range(8):
        found = found_of(arm, joint, servo, random)
        again = may_tell_more(arm, found)
        arm = with_limits(arm, found)
        if not again:
            break
    assert [one.outcome for one in found] == [Outcome.FOUND] * 3
    for one in found:
        middle = np.sqrt(one.followed * one.beyond)
        assert middle == pytest.approx(truth_of(servo).of(one.quantity), rel=0.15)
        assert one.proposed <= truth_of(servo).of(one.quantity)


@pytest.mark.parametrize(("acceleration", "jerk"), [(0.9, 1.1), (0.9, 1.4)])
@pytest.mark.parametrize("seed", [0, 1])
def test_a_loop_that_saturates_is_never_asked_for_more(acceleration: float, jerk: float, seed: int) -> None:
    hidden = servo(acceleration, jerk)
    for one in found_by_positions(ARM, motion_of(), measured({0: hidden}, seed), "measured.csv", [0]):
        if one.quantity is not Quantity.VELOCITY:
            limit = hidden.jerk if one.quantity is Quantity.JERK else hidden.acceleration
            assert one.followed <= 1.1 * limit
            assert one.outcome is Outcome.HIDDEN or one.proposed <= limit


def test_what_was_followed_to_the_end_is_a_lower_bound_and_not_lowered() -> None:
    for one in found_by_positions(ARM, motion_of(), measured({0: servo(9.0, 9.0)}), "m", [0]):
        assert one.outcome is Outcome.NOT_REACHED
        assert np.isinf(one.beyond)
        assert one.proposed >= limits_of(ARM.joints[0]).of(one.quantity)


def test_a_joint_that_was_hardly_measured_is_named() -> None:
    with pytest.raises(CalibrationError, match=r"joint q2 was measured 0 times in step 1 of velocity"):
        found_by_positions(ARM, motion_of(), measured({0: servo(2.0, 2.0)}), "m.csv")
    with pytest.raises(CalibrationError, match=r"joint q1 was measured \d+ times"):
        found_by_positions(ARM, motion_of(), measured({0: servo(2.0, 2.0)}, every=40), "m.csv")


def test_verdicts_become_limits_and_nothing_else() -> None:
    found = found_by_verdicts(ARM, motion_of(), read_verdicts("q1=12,q3=17/20/18", ARM))
    after = with_limits(ARM, found)
    assert [one.name for one, other in zip(ARM.joints, after.joints, strict=True) if one != other] == ["q1", "q3"]
    step = motion_of().ladders(2)[Quantity.JERK][17]
    assert after.joints[2].max_jerk == pytest.approx(MARGIN[Quantity.JERK] * step.level, rel=0.01)
    assert after.joints[2].max_jerk <= MARGIN[Quantity.JERK] * step.level
    unchanged = [replace(one, max_velocity=0.0, max_acceleration=0.0, max_jerk=0.0) for one in after.joints]
    assert unchanged == [replace(one, max_velocity=0.0, max_acceleration=0.0, max_jerk=0.0) for one in ARM.joints]


@settings(max_examples=20, deadline=None)
@given(by=st.tuples(*[st.floats(0.5, 1.4)] * 3))
def test_right_verdicts_bracket_a_limit(by: tuple[float, float, float]) -> None:
    """Whoever sees rightly which steps ask for too much gets brackets with the limit in them, and close ones."""
    arm, motion, joint = load_arm("so101"), motion_of("so101"), 0
    true = Limits(*by).products(limits_of(arm.joints[joint]))
    verdicts = {
        quantity: sum(all(step.levels.of(one) <= limit for one, limit in true.pairs()) for step in ladder)
        for quantity, ladder in motion.ladders(joint).items()
    }
    for one in found_by_verdicts(arm, motion, {arm.joints[joint].name: verdicts}):
        limit = true.of(one.quantity)
        assert one.followed <= limit
        if one.outcome is Outcome.FOUND:
            assert limit <= one.beyond
            assert np.sqrt(one.followed * one.beyond) == pytest.approx(limit, rel=0.15)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "q1",
        "q1=",
        "q1=x",
        "q1=3/",
        "q1=3/4",
        "q1=1/2/3/4",
        "q1=-1",
        "q9=1",
        "q1=1,q1=2",
        "q1=1,,q2=1",
        "q1=" + "9" * 30,
    ],
)
def test_verdicts_that_are_none(text: str) -> None:
    with pytest.raises(UsageError, match="--verdicts"):
        read_verdicts(text, ARM)


@pytest.mark.parametrize("text", ["q1=99", "q1=3/3/99"])
def test_verdicts_on_steps_that_are_not_there(text: str) -> None:
    with pytest.raises(CalibrationError, match="joint q1 has"):
        found_by_verdicts(ARM, motion_of(), read_verdicts(text, ARM))


def test_a_joint_that_followed_nothing_to_be_seen_keeps_its_limits() -> None:
    found = found_by_verdicts(ARM, motion_of(), read_verdicts("q1=0", ARM))
    assert {one.outcome for one in found} == {Outcome.UNKNOWN}
    assert with_limits(ARM, found) == ARM


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
    assert load_arm(str(new)).joints != ARM.joints

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


def test_a_calibrated_arm_is_told_a_test_motion_as_it_is_planned(tmp_path: Path) -> None:
    """What is known of its slack and its lag leads no set point: both have to show, and the record is known again."""
    joints = [
        replace(one, servo=replace(one.servo, lag_s=0.04, backlash=np.radians(1.0), dead_band_us=3.0))
        for one in ARM.joints
        if one.servo is not None
    ]
    arm = replace(ARM, joints=tuple(joints), accuracy=Accuracy(49, 0.3, 0.2, (1e-3,) * ARM.n_joints))
    mine, test, told, seen, new = (
        tmp_path / f"{name}" for name in ("my.toml", "t.csv", "told.csv", "at.csv", "2.toml")
    )
    mine.write_text(arm_toml(arm))
    assert main(["identify", "--arm", str(mine), "--factor", "0.2", "--rate", "50", "-o", str(test), "--quiet"]) == 0
    playing = ["run", str(test), "--fast", "--servos", "real", "--beyond-limits", "--quiet"]
    assert main([*playing, "--record", str(told), "--record-positions", str(seen)]) == 0
    read = ["identify", str(mine), "--factor", "0.2", "--rate", "50", "-o", str(new), "--quiet"]
    assert main([*read, "--record", str(told), "--positions", str(seen)]) == 0
    assert [one.max_jerk for one in load_arm(str(new)).joints] == [one.max_jerk for one in arm.joints]


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
