"""`plan run` on controllers that stream: what arrives is the program; what is not fit to be played sends nothing."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hardware.compensation.servo_values import count_calibration
from hardware.drivers.table import calibration_of
from hardware.playback.preflight import set_points
from hardware.playback.program import make_program
from planner.arms.accuracy import Accuracy
from planner.arms.arm_file import load_arm
from planner.arms.arm_text import arm_toml
from planner.cli import main
from planner.trajectory import read_trajectory
from tests.drawn_shapes import lines_svg
from tests.hardware.controllers.bench import Bench
from tests.hardware.controllers.lines import Model
from tests.hardware.controllers.maestro import MaestroModel
from tests.hardware.drivers.streaming.on_bench import plan_run
from tests.hardware.drivers.streaming.test_set_points import MAKERS, STEPS, told

Planned = Callable[[str], Path]


@pytest.fixture
def planned(tmp_path: Path) -> Planned:
    """Plans two taps and a short line for an arm."""

    def plan(arm: str) -> Path:
        drawing, csv = tmp_path / "drawing.svg", tmp_path / "traj.csv"
        drawing.write_text(lines_svg('<path d="M0 0h0M20 8h0M40 0 l12 5"/>', 'viewBox="0 0 60 60"'))
        assert main([str(drawing), "-o", str(csv), "--arm", arm, "--no-fit", "--quiet"]) == 0
        return csv

    return plan


@pytest.mark.parametrize("name", MAKERS)
def test_what_arrives_is_the_program_to_half_a_step(name: str, planned: Planned) -> None:
    arm = load_arm("so101" if name in ("feetech", "dynamixel") else "drawing_arm")
    csv, model = planned(arm.name), MAKERS[name]()
    assert plan_run(Bench(model), str(csv), "--driver", name, "--quiet") == 0
    trajectory, calibration = read_trajectory(csv), calibration_of(name, arm)
    assert calibration is not None
    program = make_program(arm, set_points(trajectory, arm, csv), trajectory.stroke, trajectory.rate_hz, park=arm.park)
    wanted = calibration.to_servos(program.positions)
    assert np.abs(told(model, len(wanted)) - wanted).max() <= STEPS[name] / 2 + 1e-9


@pytest.mark.parametrize("calibrated", [False, True], ids=["as it comes", "slack taken up"])
@pytest.mark.parametrize("name", ["feetech", "dynamixel"])
def test_what_is_recorded_is_what_a_bus_hears(name: str, calibrated: bool, planned: Planned, tmp_path: Path) -> None:
    arm, file = load_arm("so101"), tmp_path / "arm.toml"
    if calibrated:
        known = Accuracy(49, 0.1, 0.1, tuple((0.1 * arm.per_file_unit).tolist()))
        lag = [replace(joint, bus=replace(joint.bus, lag_s=0.02)) for joint in arm.joints if joint.bus is not None]
        arm = replace(arm, accuracy=known, joints=tuple(lag))
    file.write_text(arm_toml(arm))
    csv, model, record = planned(str(file)), MAKERS[name](), tmp_path / "record.csv"
    assert plan_run(Bench(model), str(csv), "--driver", name, "--record", str(record), "--quiet") == 0
    assert main(["run", str(csv), "--driver", name, "--dry-run", "--record", str(tmp_path / "dry.csv"), "--quiet"]) == 0
    assert (tmp_path / "dry.csv").read_text() == record.read_text()
    header, *rows = record.read_text().splitlines()
    assert header.split(",") == ["t_s", "stroke", "x_mm", "y_mm", *(f"{joint.name}_counts" for joint in arm.joints)]
    counts = np.array([row.split(",")[4:] for row in rows], dtype=float)
    assert np.abs(told(model, len(counts)) - counts).max() <= 0.5 + 1e-3
    trajectory = read_trajectory(csv)
    program = make_program(arm, set_points(trajectory, arm, csv), trajectory.stroke, trajectory.rate_hz, park=arm.park)
    as_meant = count_calibration(arm).to_servos(program.positions)
    assert (len(counts) > len(as_meant)) == calibrated
    assert calibrated or np.abs(counts - as_meant).max() < 1e-3


def _over_a_limit(lines: list[str]) -> list[str]:
    row = lines[len(lines) // 2].split(",")
    row[1] = "91.0"
    lines[len(lines) // 2] = ",".join(row)
    return lines


@pytest.mark.parametrize(
    ("spoil", "options", "message"),
    [
        (_over_a_limit, (), r"line \d+: .*: position of q1: 91 of 90 deg"),
        (lambda lines: lines[:-40], (), r"line \d+: "),
        (lambda lines: [*lines[:-1], lines[-1][:20]], (), r"line \d+: "),
        (list, ("--arm", "drawing_arm_2022"), "for arm 'drawing_arm_2022'|outside its"),
        (list, ("--arm", "six_joint"), "moves the joints|does not say how joint"),
        (list, ("--from-stroke", "3"), "there is no stroke 3; the drawing has 0 to 2"),
        (list, ("--resume",), "there is nothing to resume"),
    ],
    ids=["over a limit", "truncated", "torn", "a foreign arm", "other joints", "no such stroke", "no journal"],
)
def test_what_is_refused_sends_not_one_byte(
    spoil: Callable[[list[str]], list[str]],
    options: tuple[str, ...],
    message: str,
    planned: Planned,
    capsys: pytest.CaptureFixture[str],
) -> None:
    csv = planned("drawing_arm")
    csv.write_text("\n".join(spoil(csv.read_text().splitlines())) + "\n")
    for driver in ("native", "maestro"):
        bench = Bench(MaestroModel())
        assert plan_run(bench, str(csv), "--driver", driver, *options) == 2
        assert bench.received == b""
        assert re.match(f"plan: error: .*({message})", capsys.readouterr().err)
    assert not csv.with_name("traj.csv.journal").exists()


@pytest.mark.parametrize(
    ("arm", "driver", "key"),
    [("so101", "native", "servo"), ("so101", "maestro", "servo"), ("drawing_arm", "feetech", "bus")],
)
def test_an_arm_that_does_not_say_how_it_is_moved_is_told_what_is_missing(
    arm: str, driver: str, key: str, planned: Planned, capsys: pytest.CaptureFixture[str]
) -> None:
    csv = planned(arm)
    bench = Bench(MaestroModel())
    assert plan_run(bench, str(csv), "--driver", driver) == 2
    assert bench.received == b""
    assert f"add to that joint in the arm file: {key} = {{" in capsys.readouterr().err


@pytest.mark.parametrize("damage", [b"", b"\x00\xff\n", b"[1]\n", b'{"journal": 1, "next_stroke": "2"}\n'])
def test_a_damaged_journal_is_no_journal(damage: bytes, planned: Planned, capsys: pytest.CaptureFixture[str]) -> None:
    csv = planned("drawing_arm")
    csv.with_name("traj.csv.journal").write_bytes(damage)
    bench = Bench(MaestroModel())
    assert plan_run(bench, str(csv), "--driver", "maestro", "--resume") == 2
    assert bench.received == b""
    assert "is not a journal of this program" in capsys.readouterr().err


class _Babbling:
    """No controller at all: noise for an answer to whatever comes."""

    def receive(self, message: bytes) -> bytes:
        return np.random.default_rng(len(message)).integers(0, 256, 64, dtype=np.uint8).tobytes()


class _Silent:
    def receive(self, message: bytes) -> bytes:
        return b""


@pytest.mark.parametrize("stranger", [_Babbling, _Silent])
@pytest.mark.parametrize("name", ["native", *MAKERS])
def test_what_is_no_controller_is_exit_4_in_one_sentence(
    name: str, stranger: Callable[[], Model], planned: Planned, capsys: pytest.CaptureFixture[str]
) -> None:
    csv = planned("so101" if name in ("feetech", "dynamixel") else "drawing_arm")
    assert plan_run(Bench(stranger()), str(csv), "--driver", name) == 4
    told_so = capsys.readouterr().err
    assert "plan: error: " in told_so
    assert "defect" not in told_so
