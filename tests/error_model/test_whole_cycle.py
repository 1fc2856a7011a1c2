"""From a data sheet to whole lines, by commands alone, on an arm that nobody told anything of."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hardware.compensation.servo_values import pulse_calibration
from planner.arms.arm import Servo
from planner.arms.arm_file import arm_file_text, load_arm
from planner.arms.arm_text import arm_toml
from planner.cli import main
from planner.error_model.pattern.touch import Heights
from tests.error_model.photo.rendering import Camera
from tests.judge.photographing import Sheet, photograph_sheet, read_well
from tests.judge.playing import Record, play, read_record
from tests.judge.true_arm import TrueArm, random_arm
from tests.judge.verdict import judge, measured

PHOTOGRAPHED = 304
"""Seed of the arm whose sheets are photographed."""
FILES = ("pattern.csv", "marks.csv", "sheet.pdf", "pulses.csv", "photo.jpg", "measured.csv")
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 20" fill="none" stroke="black">
<path d="M0 0H60V20H0ZM0 20L20 0L40 20L60 0"/><circle cx="15" cy="10" r="7"/><path d="M45 3v.01"/></svg>"""

US_PER_RAD = 240.0


def write_marks(record: Record, marks: Path, target: Path, true: object, seed: int) -> None:
    times_s = np.genfromtxt(marks, delimiter=",", names=True)["t_s"]
    tips = measured(true, record, times_s, np.random.default_rng(seed))  # type: ignore[arg-type]
    rows = [f"{mark},{x:.3f},{y:.3f},{h:.3f},0.15" for mark, (x, y, h) in enumerate(tips)]
    target.write_text("\n".join(["mark,x_mm,y_mm,h_mm,sd_mm", *rows]) + "\n")


@pytest.mark.parametrize("seed", [3])
def test_an_arm_that_nobody_has_measured_draws_whole_lines(
    seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    arm, true = "drawing_arm_2022", random_arm(load_arm("drawing_arm_2022"), np.random.default_rng(seed))
    Path("drawing.svg").write_text(DRAWING)
    assert main(["pattern", "--arm", arm, "-o", "pattern.csv", "--marks", "marks.csv"]) == 0
    assert main(["check", "pattern.csv"]) == 0
    assert main(["run", "pattern.csv", "--fast", "--record", "pulses.csv", "--quiet"]) == 0
    assert main(["run", "pattern.csv", "--driver", "maestro", "--dry-run", "--record", "dry.csv"]) == 0
    assert Path("dry.csv").read_text() == Path("pulses.csv").read_text()
    write_marks(read_record(Path("pulses.csv")), Path("marks.csv"), Path("measured.csv"), true, seed)
    assert (
        main(
            [
                "calibrate",
                arm,
                "--record",
                "pulses.csv",
                "--marks",
                "measured.csv",
                "-o",
                "arm2.toml",
                "--json",
                "fit.json",
            ]
        )
        == 0
    )
    said = capsys.readouterr().out
    assert "joint q5: " in said and "wrote arm2.toml" in said
    written, remarks = Path("arm2.toml").read_text(), [line for line in arm_file_text(arm).splitlines() if "#" in line]
    assert len(remarks) > 3 and all(line in written for line in remarks)
    assert main(["drawing.svg", "--arm", "arm2.toml", "-o", "t.csv", "--quiet"]) == 0
    assert "# paper: " in Path("t.csv").read_text()
    assert main(["check", "t.csv", "--drawing", "drawing.svg"]) == 0
    assert main(["run", "t.csv", "--arm", "arm2.toml", "--fast", "--record", "p.csv", "--quiet"]) == 0
    capsys.readouterr()
    assert main(["predict", "t.csv", "--json"]) == 0
    predicted = json.loads(capsys.readouterr().out)

    record = read_record(Path("p.csv"))
    verdict = judge(true, record)
    assert verdict.path_rms < 0.45
    assert verdict.rms < 0.7
    assert verdict.missing <= 0.02
    assert verdict.crushed <= 0.05
    assert verdict.path_rms / 1.5 < predicted["rms_mm"] < 1.5 * verdict.path_rms
    low, high = predicted["rms_interval_mm"]
    assert low <= predicted["rms_mm"] <= high
    assert json.loads(Path("fit.json").read_text())["predicted_rms_mm"] < 0.6

    told = load_arm("arm2.toml")
    joints = pulse_calibration(told).to_joints(record.pulses_us)
    period_s = record.times_s[1] - record.times_s[0]
    for order, limit in ((1, told.max_velocity), (2, told.max_acceleration)):
        assert (np.abs(np.diff(joints, order, axis=0)).max(axis=0) / period_s**order <= 1.001 * limit).all()
    ranges = np.array([joint.servo.pulse_range_us for joint in told.joints if joint.servo is not None])
    assert (record.pulses_us >= ranges[:, 0]).all() and (record.pulses_us <= ranges[:, 1]).all()


def test_an_arm_without_redundancy_is_calibrated_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Six joints point the pen down. The wrist has two ways to do so, between which no leg of a pattern leads."""
    monkeypatch.chdir(tmp_path)
    whole = load_arm("six_joint")
    line = tuple((at, 1500.0 + US_PER_RAD * at) for at in (-5.0, 5.0))
    servos = [Servo(channel, line, 1, 0.0, (200.0, 2800.0), 0.5, 3.0, 0.02) for channel in range(whole.n_joints)]
    joints = tuple(replace(joint, servo=servo) for joint, servo in zip(whole.joints, servos, strict=True))
    arm = replace(whole, joints=joints)
    true = random_arm(arm, np.random.default_rng(2))
    Path("arm.toml").write_text(arm_toml(arm))
    Path("drawing.svg").write_text(DRAWING)
    assert main(["pattern", "--arm", "arm.toml", "-o", "pattern.csv", "--marks", "marks.csv", "--count", "16"]) == 0
    assert main(["run", "pattern.csv", "--fast", "--record", "pulses.csv", "--quiet"]) == 0
    write_marks(read_record(Path("pulses.csv")), Path("marks.csv"), Path("measured.csv"), true, 2)
    assert main(["calibrate", "arm.toml", "--record", "pulses.csv", "--marks", "measured.csv", "-o", "arm2.toml"]) == 0

    def off_mm(arm: str) -> float:
        assert main(["drawing.svg", "--arm", arm, "-o", "t.csv", "--quiet"]) == 0
        assert main(["run", "t.csv", "--fast", "--record", "p.csv", "--quiet"]) == 0
        return judge(true, read_record(Path("p.csv"))).path_rms

    assert off_mm("arm2.toml") < 0.5 < off_mm("arm.toml")


def test_photos_of_two_sheets_make_an_arm_draw_whole_lines(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Printed, drawn on with all that a pen leaves which is too high here and too low there, photographed and read."""
    monkeypatch.chdir(tmp_path)
    true = random_arm(load_arm("drawing_arm_2022"), np.random.default_rng(PHOTOGRAPHED))
    known: list[object] = []
    for k, arm in enumerate(("drawing_arm_2022", "arm1.toml")):
        sheet = Sheet(f"sheet{k}")
        pattern, marks, pdf, pulses, photo, measured_marks = map(sheet.file, FILES)
        made = ("-o", pattern, "--marks", marks, "--sheet", pdf, "--seed", k, "--count", 22, "--quiet")
        command("pattern", "--arm", arm, *made)
        command("run", pattern, "--arm", arm, "--fast", "--record", pulses, "--quiet")
        if not k:
            true = on_usual_height(true, read_record(pulses), marks)
        photograph_sheet(true, sheet, Camera(), k)
        command("measure", photo, "--marks", marks, "-o", measured_marks, "--quiet")
        known += ["--record", pulses, "--marks", measured_marks]
        command("calibrate", "drawing_arm_2022", *known, "-o", f"arm{k + 1}.toml", "--quiet")
    second = read_well(true, Sheet("sheet1"))
    assert second.found >= 0.8 * second.inked and second.astray <= 0.1 * second.found
    Path("drawing.svg").write_text(DRAWING)
    command("drawing.svg", "--arm", "arm2.toml", "-o", "t.csv", "--quiet")
    command("run", "t.csv", "--arm", "arm2.toml", "--fast", "--record", "p.csv", "--quiet")
    verdict = judge(true, read_record(Path("p.csv")))
    assert verdict.path_rms < 0.5
    assert verdict.missing <= 0.02

    # One mark that was read five millimetres off is named, and has no say.
    head, *rows = measured_marks.read_text().splitlines()
    cells = rows[7].split(",")
    shift = 5.0
    x, y = head.split(",").index("x_mm"), head.split(",").index("touch_x_mm")
    for column in (x, y):
        cells[column] = f"{float(cells[column]) + shift:.3f}" if cells[column] else ""
    Path("spoiled.csv").write_text("\n".join([head, *rows[:7], ",".join(cells), *rows[8:]]) + "\n")
    capsys.readouterr()
    spoiled = [*known[:-1], "spoiled.csv"]
    command("calibrate", "drawing_arm_2022", *spoiled, "-o", "arm3.toml", "--quiet")
    assert f"spoiled.csv: mark {cells[0]} is " in capsys.readouterr().err


def on_usual_height(true: TrueArm, record: Record, marks: Path) -> TrueArm:
    """The arm on a paper that is as high as its pen was set to on average, not higher or lower by several
    millimetres."""
    times_s = np.genfromtxt(marks, delimiter=",", names=True)["t_s"]
    heights = true.tip_mm(play(true, record, times_s))[:, 2]
    pose = true.T_sheet_base.copy()
    pose[2, 3] -= np.median(heights) + Heights.for_arm(load_arm("drawing_arm_2022")).reach_mm
    return replace(true, T_sheet_base=pose)


def command(*arguments: object) -> None:
    assert main([str(argument) for argument in arguments]) == 0


def test_what_contradicts_itself_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("r.csv").write_text("t_s\n0\n")
    Path("m.csv").write_text("mark\n0\n")
    for arguments, message in (
        (["pattern", "--arm", "drawing_arm", "-o", "a.csv", "--marks", "a.csv"], "name the same file"),
        (["pattern", "--arm", "drawing_arm", "-o", "a.csv", "--marks", "b.csv", "--count", "3"], "no number of marks"),
        (["pattern", "--arm", "scara", "-o", "a.csv", "--marks", "b.csv"], "does not say how joint"),
        (
            ["calibrate", "drawing_arm", "--record", "r.csv", "--record", "r.csv", "--marks", "m.csv", "-o", "o.toml"],
            "give each record its marks",
        ),
        (["calibrate", "drawing_arm", "--record", "r.csv", "--marks", "m.csv", "-o", "o.txt"], "ends in .toml"),
        (["calibrate", "drawing_arm", "--record", "none.csv", "--marks", "m.csv", "-o", "o.toml"], "cannot be read"),
        (["calibrate", "drawing_arm", "--record", "r.csv", "--marks", "m.csv", "-o", "o.toml"], "has the columns t_s"),
        (["run", "r.csv", "--seed", "1"], "--seed goes with --servos real"),
        (["run", "r.csv", "--true-arm", "drawing_arm"], "--true-arm goes with --servos real"),
    ):
        assert main(arguments) == 2
        assert message in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m.csv", "r.csv"]


def test_a_rehearsal_is_held_on_an_arm_that_is_not_as_its_file_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("drawing.svg").write_text(DRAWING)

    def off_mm(arm: str, *options: str) -> float:
        assert main(["drawing.svg", "--arm", arm, "-o", f"{arm}.csv", "--quiet"]) == 0
        assert main(["run", f"{arm}.csv", "--fast", "--servos", "real", "--picture", "d.svg", *options]) == 0
        return float(capsys.readouterr().out.split("what was drawn is off by ")[1].split()[0])

    assert off_mm("drawing_arm_2022", "--true-arm", "drawing_arm_2022") < 2.5
    assert off_mm("drawing_arm_2022") != off_mm("drawing_arm_2022", "--seed", "1") > 2.5
    assert off_mm("so101") > 0.5
