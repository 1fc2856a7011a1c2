"""`plan jog`: what is found by moving one joint at a time, on models of controllers behind a pseudo-terminal."""

from __future__ import annotations

import io
import json
import os
import pty
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.clock import InstantClock
from hardware.compensation.servo_values import own_calibration
from hardware.drivers.driver import Driver
from hardware.jog import adjustments
from hardware.jog.jogging import Jogging
from hardware.motion.tip import tip_at
from hardware.playback.claims import claim, claim_of_port
from hardware.simulation.simulated_arm import SimulatedArm
from planner.arms.arm_file import arm_file_text, load_arm
from planner.cli import main
from planner.cli.jog_keyboard import Keyboard, KeyCommands
from planner.cli.keys import TerminalKeys
from planner.errors import UsageError
from tests.drawn_shapes import lines_svg
from tests.hardware.controllers.bus import DynamixelModel, FeetechModel
from tests.hardware.controllers.lines import Model, pty_line
from tests.hardware.controllers.maestro import MaestroModel
from tests.hardware.controllers.ssc32 import Ssc32Model

ARMS = ("drawing_arm", "drawing_arm_2022", "so101")
WHERE = {joint.bus.id: 2048 for joint in load_arm("so101").joints if joint.bus}


@pytest.fixture
def script(tmp_path: Path) -> Callable[[str], str]:
    def write(text: str) -> str:
        (tmp_path / "moves.txt").write_text(text)
        return str(tmp_path / "moves.txt")

    return write


@pytest.mark.parametrize(
    ("driver", "arm", "model"),
    [
        ("maestro", "drawing_arm_2022", MaestroModel()),
        ("ssc32", "drawing_arm", Ssc32Model()),
        ("feetech", "so101", FeetechModel(WHERE)),
        ("dynamixel", "so101", DynamixelModel(WHERE)),
    ],
)
@pytest.mark.skipif(not Path("/dev/ptmx").exists(), reason="needs pseudo-terminals")
def test_a_joint_that_turned_the_wrong_way_is_found_on_every_controller(
    driver: str, arm: str, model: Model, tmp_path: Path, script: Callable[[str], str]
) -> None:
    before, out = load_arm(arm), tmp_path / "found.toml"
    moves = script("joint 1\nmove 3\nreverse\nmove 2\nzero 1\nsave\n")
    with pty_line(model) as far:
        command = ["jog", "--arm", arm, "-o", str(out), "--driver", driver, "--port", far.name, "--script", moves]
        assert main([*command, *(["--from-middle"] if driver in ("maestro", "ssc32") else [])]) == 0
    after = load_arm(str(out))
    middle = (before.minimum + before.maximum) / 2
    middle[0] += np.radians(3 - 2)  # the second move went back, as directions had changed meanwhile
    value = own_calibration(before).to_servos(middle)[0]
    assert own_calibration(after).to_joints(np.tile(value, before.n_joints))[0] == pytest.approx(
        np.radians(1), abs=1e-6
    )
    slopes = [np.diff(own_calibration(a).to_servos(np.array([middle, middle + 0.01]))[:, 0]) for a in (before, after)]
    assert slopes[0] * slopes[1] < 0


@given(st.sampled_from(ARMS), st.integers(0, 4), st.floats(0.05, 0.95), st.floats(-0.2, 0.2))
@settings(max_examples=40, deadline=None)
def test_what_is_found_holds_where_it_was_found_and_no_pulse_is_lost(name: str, k: int, at: float, off: float) -> None:
    arm = load_arm(name)
    here = arm.minimum + at * (arm.maximum - arm.minimum)
    calibration = own_calibration(arm)
    values = calibration.to_servos(here)
    zeroed = adjustments.standing_at(arm, k, float(here[k]), float(here[k] + off))
    turned = adjustments.turned_round(arm, k, float(here[k]))
    np.testing.assert_allclose(own_calibration(zeroed).to_joints(values)[k], here[k] + off, atol=1e-9)
    np.testing.assert_allclose(own_calibration(turned).to_joints(values), here, atol=1e-9)
    beside = values + 0.01
    way, back = (own_calibration(one).to_joints(beside)[k] - here[k] for one in (arm, turned))
    assert back == pytest.approx(-way, rel=1e-6)
    both = adjustments.turned_round(turned, k, float(here[k]))
    np.testing.assert_allclose(own_calibration(both).to_joints(values), here, atol=1e-9)
    for found in (zeroed, turned):
        np.testing.assert_allclose(own_calibration(found).ranges, calibration.ranges, atol=1e-6)


@given(st.sampled_from(ARMS), st.floats(0.0, 3.0))
@settings(max_examples=20, deadline=None)
def test_the_paper_is_as_far_under_the_pen_as_the_card_is_thick(name: str, card_mm: float) -> None:
    arm = load_arm(name)
    at = (arm.minimum + arm.maximum) / 2
    found = adjustments.paper_under(arm, tip_at(arm, at).position_mm, card_mm)
    assert tip_at(found, at).position_mm[2] == pytest.approx(card_mm, abs=1e-9)


def jogging(name: str) -> tuple[Jogging, Driver]:
    arm, clock = load_arm(name), InstantClock()
    driver = SimulatedArm(arm, clock)
    made = Jogging(arm, driver, own_calibration(arm), clock)
    made.start()
    return made, driver


@pytest.mark.parametrize("name", ARMS)
def test_the_pen_goes_straight_up_and_comes_back(name: str) -> None:
    made, _ = jogging(name)
    before = made.tip_mm
    made.pen_up()
    np.testing.assert_allclose(made.tip_mm - before, [0, 0, made.arm.pen.lift_mm], atol=0.5)
    made.pen_down()
    np.testing.assert_allclose(made.tip_mm, before, atol=1e-6)


def test_it_begins_where_the_arm_is_parked() -> None:
    arm = load_arm("drawing_arm_2022")
    parked = replace(arm, park=tuple((0.3 * arm.minimum + 0.7 * arm.maximum).tolist()))
    made = Jogging(parked, SimulatedArm(parked, InstantClock()), own_calibration(arm), InstantClock())
    np.testing.assert_allclose(made.positions, np.array(parked.park))
    made.start()
    made.choose("q3")
    made.move(-5)
    with pytest.raises(UsageError, match="park"):
        made.limit(upper=True)


def test_one_joint_moves_slowly_and_others_stand() -> None:
    made, driver = jogging("drawing_arm_2022")
    assert isinstance(driver, SimulatedArm)
    made.choose("q2")
    made.move(20.0)
    points = driver.recording.set_points
    assert (np.ptp(np.delete(points, 1, axis=1), axis=0) == 0).all()
    assert np.abs(np.diff(points[:, 1])).max() * 50 <= 0.11 * made.arm.max_velocity[1]


def test_what_is_refused_changes_nothing() -> None:
    made, _ = jogging("drawing_arm_2022")
    before, values = made.arm, made.values
    refused: list[Callable[[], None]] = [
        lambda: made.move(500),
        lambda: made.choose("q9"),
        lambda: made.stands_at(4000),
        made.pen_down,
    ]
    for wrong in refused:
        with pytest.raises(UsageError):
            wrong()
    assert made.arm is before
    np.testing.assert_array_equal(made.values, values)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("joint q9", "line 1 of the script: there is no joint 'q9'; there are q1, q2, q3, q4, q5"),
        ("# well\nmove far", "line 2 of the script: 'far' is not a finite number"),
        ("move nan", "not a finite number"),
        ("dance", "'dance' is no command"),
        ("move 400", "outside its limits"),
        ("zero 900", "reaches no position within its limits"),
    ],
)
def test_a_wrong_line_of_a_script_ends_it_and_writes_nothing(
    text: str, wanted: str, tmp_path: Path, script: Callable[[str], str], capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "found.toml"
    assert main(["jog", "--arm", "drawing_arm_2022", "-o", str(out), "--script", script(text + "\nsave\n")]) == 2
    assert wanted in capsys.readouterr().err
    assert not out.exists()


def test_commands_come_by_standard_input(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("joint q1\nto 10\nlow\nsave\nquit\nnever read\n"))
    assert main(["jog", "--arm", "drawing_arm", "-o", str(tmp_path / "found.toml")]) == 0
    assert load_arm(str(tmp_path / "found.toml")).minimum[0] == pytest.approx(np.radians(10))


@pytest.mark.skipif(not Path("/dev/ptmx").exists(), reason="needs pseudo-terminals")
@pytest.mark.filterwarnings("ignore:.*forkpty.*:DeprecationWarning")
def test_keys_of_a_terminal(tmp_path: Path) -> None:
    out = tmp_path / "found.toml"
    pid, master = pty.fork()
    if pid == 0:
        os.execv(sys.executable, [sys.executable, "-m", "planner.cli", "jog", "--arm", "drawing_arm", "-o", str(out)])
    shown = b""
    while b"over the paper" not in shown:
        shown += os.read(master, 4096)
    os.write(master, b"\x1b[A")  # an arrow, which says nothing
    for key in (b"1", b"]", b"+", b"h", b"s", b"q"):
        os.write(master, key)
    while True:
        try:
            if not os.read(master, 4096):
                break
        except OSError:
            break
    assert os.waitpid(pid, 0)[1] == 0
    os.close(master)
    assert load_arm(str(out)).maximum[0] == pytest.approx(np.radians(2))


def test_save_keeps_what_somebody_wrote_and_writes_the_arms_own_file(
    tmp_path: Path, script: Callable[[str], str], capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "mine.toml"
    mine.write_text(f"# glued on a Sunday\n{arm_file_text('drawing_arm')}")
    told = "joint q1\nto 10\nhigh\nreverse\nsave\nreverse\nzero 10\npark\nsave\n"
    assert main(["jog", "--arm", str(mine), "--script", script(told)]) == 0
    text, found = mine.read_text(), load_arm(str(mine))
    assert text.startswith("# drawing_arm as found by plan jog.\n# glued on a Sunday\n")
    assert text.count("as found by plan jog") == 1
    kept = [line for line in arm_file_text("drawing_arm").splitlines() if line in text.splitlines()]
    assert len(kept) >= len(arm_file_text("drawing_arm").splitlines()) - 2  # a limit, and a servo
    before = load_arm("drawing_arm")
    assert found.maximum[0] == pytest.approx(np.radians(10))
    assert found.joints[0].servo is not None and before.joints[0].servo is not None
    assert found.joints[0].servo.direction == before.joints[0].servo.direction  # what the second save says counts
    assert found.park is not None
    np.testing.assert_allclose(found.complete(np.array(found.park)[list(found.independent_joints)]), found.park)
    assert capsys.readouterr().err == ""


def test_what_cannot_be_written_leaves_the_file_alone(
    tmp_path: Path, script: Callable[[str], str], capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "mine.toml"
    mine.write_text(arm_file_text("drawing_arm"))
    assert main(["jog", "--arm", str(mine), "--script", script("zero 1\nsave\n"), "-o", str(tmp_path)]) == 2
    assert main(["jog", "--arm", "drawing_arm", "--script", script("zero 1\nsave\n")]) == 2
    told = capsys.readouterr().err
    assert "give -o ARM.toml" in told
    assert "what was found since it was saved last is in no file" in told
    assert mine.read_text() == arm_file_text("drawing_arm")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.toml", "moves.txt"]


@pytest.mark.skipif(not Path("/dev/ptmx").exists(), reason="needs pseudo-terminals")
def test_an_arm_without_a_park_pose_leaps_only_where_somebody_wants_it(
    tmp_path: Path, script: Callable[[str], str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pty_line(Ssc32Model()) as far:
        jog = ["jog", "--driver", "ssc32", "--port", far.name, "--script", script("show\n"), "--arm"]
        assert main([*jog, "drawing_arm"]) == 2
        told = capsys.readouterr().err
        assert "no [park] pose: its servos leap to the middle of their ranges (q1 0.0 deg, q2 90.0 deg," in told
        assert "--from-middle" in told
        far.finish()
        assert far.received == b""
    parked = tmp_path / "parked.toml"
    parked.write_text(arm_file_text("drawing_arm") + "\n[park]\nq1 = 5\nq2 = 90\nq3 = -60\nq4 = -60\n")
    with pty_line(Ssc32Model()) as far:
        jog[4] = far.name
        assert main([*jog, str(parked)]) == 0
    assert "its servos are attached at the park pose (q1 5.0 deg" in capsys.readouterr().err


@pytest.mark.skipif(not Path("/dev/ptmx").exists(), reason="needs pseudo-terminals")
def test_a_port_is_jogged_or_played_by_one_process_at_a_time(
    tmp_path: Path, script: Callable[[str], str], capsys: pytest.CaptureFixture[str]
) -> None:
    csv = tmp_path / "traj.csv"
    (tmp_path / "drawing.svg").write_text(lines_svg('<path d="M2 2h5"/>', 'viewBox="0 0 9 9"'))
    assert main([str(tmp_path / "drawing.svg"), "-o", str(csv), "--quiet"]) == 0
    with pty_line(Ssc32Model()) as far:
        here = ["--driver", "ssc32", "--port", far.name]
        jog = ["jog", "--arm", "drawing_arm", "--from-middle", *here]
        with claim(claim_of_port(far.name), "drawing other.csv"):
            assert main([*jog, "--script", script("show\n")]) == 4
            assert "another run has it: process" in capsys.readouterr().err
        process = subprocess.Popen(
            [sys.executable, "-m", "planner.cli", *jog], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        assert process.stdin is not None and process.stdout is not None
        while b"over the paper" not in process.stdout.readline():
            pass
        assert main(["run", str(csv), *here]) == 4
        assert f"another run has it: process {process.pid}, jogging drawing_arm, since" in capsys.readouterr().err
        assert main([*jog, "--script", script("show\n")]) == 4
        process.communicate(b"quit\n", timeout=20)
        assert process.returncode == 0
        assert main([*jog, "--script", script("show\n")]) == 0


def test_keys_that_stop_are_seen_while_a_joint_moves_and_commands_can_be_typed() -> None:
    near, far = os.pipe()
    keyboard = Keyboard(TerminalKeys(near))
    keyboard.watch()
    os.write(far, b"+\x1b[A:joint q")
    keyboard.watch()
    os.write(far, b"x\x7f3\r-")
    os.close(far)
    assert list(keyboard.commands()) == ["move 1", "joint q3", "move -1"]
    for stop in (b"x", b"+X", b"\x1b"):
        near, far = os.pipe()
        os.write(far, stop)
        with pytest.raises(KeyboardInterrupt):
            Keyboard(TerminalKeys(near)).watch()
    os.write(far, b"q")
    assert not Keyboard(TerminalKeys(near)).agrees()


def test_every_key_is_a_command_or_nothing() -> None:
    keys = KeyCommands()
    assert keys.command("+") == "move 1"
    assert keys.command("[") is None
    assert keys.command("-") == "move -0.5"
    assert keys.command("?") is None
    assert keys.command("\u0663") is None


def lerobot(**changes: dict[str, int]) -> str:
    names = [joint.name for joint in load_arm("so101").joints] + ["gripper"]
    motors: dict[str, dict[str, int]] = {
        name: {"id": k, "drive_mode": 0, "homing_offset": -120, "range_min": 800 + k, "range_max": 3200 - k}
        for k, name in enumerate(names, start=1)
    }
    for name, change in changes.items():
        motors[name] |= change
    return json.dumps(motors)


def imported(text: str, folder: Path, arm: str = "so101") -> int:
    (folder / "calibration.json").write_text(text)
    command = ["jog", "--arm", arm, "-o", str(folder / "mine.toml"), "--import", "lerobot"]
    return main([*command, str(folder / "calibration.json")])


def test_ids_zeros_and_ranges_come_from_lerobots_calibration(tmp_path: Path) -> None:
    assert imported(lerobot(elbow_flex={"id": 13, "range_min": 900, "range_max": 3000}), tmp_path) == 0
    elbow = load_arm(str(tmp_path / "mine.toml")).joints[2]
    assert elbow.bus is not None
    assert (elbow.bus.id, elbow.bus.count_at_zero, elbow.bus.count_range) == (13, 1950.0, (900, 3000))
    assert elbow.maximum == pytest.approx(np.radians(1050 * 360 / 4096), abs=1e-6)


@pytest.mark.parametrize(
    ("text", "arm", "wanted"),
    [
        ("{", "so101", "is no calibration of LeRobot"),
        ("[1]", "so101", "is no calibration of LeRobot"),
        ('{"shoulder_pan": {"id": 1, "range_min": 800, "range_max": 3000}}', "so101", "says nothing of joint"),
        (lerobot(wrist_flex={"range_min": 3300}), "so101", "wrist_flex: range_min is not below range_max"),
        (lerobot(wrist_flex={"range_max": 9000}), "so101", "wrist_flex.range_max"),
        (lerobot(wrist_flex={"drive_mode": 1}), "so101", "wrist_flex: drive_mode 1"),
        (lerobot(), "drawing_arm", "says nothing of joint q1"),
    ],
)
def test_what_is_no_calibration_for_this_arm_is_refused(
    text: str, arm: str, wanted: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert imported(text, tmp_path, arm) == 2
    assert wanted in capsys.readouterr().err
    assert not (tmp_path / "mine.toml").exists()
