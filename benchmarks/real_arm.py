"""How well arms draw that are not as their files say, before and after a calibration: the whole cycle by commands.

    python benchmarks/real_arm.py [--arms 20] [--marks 49] [--sd 0.15] [--line] [--gravity] [DRAWING.svg ...]

Random true arms of the kind of `drawing_arm_2022` (tests/judge) draw a pattern, its marks are measured with noise, the
arm is calibrated, plans the drawings and draws them. One row an arm, then the means and the worst arm.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from planner.arms.arm import Arm  # noqa: E402
from planner.arms.arm_file import load_arm  # noqa: E402
from planner.arms.arm_text import arm_toml  # noqa: E402
from planner.cli import main  # noqa: E402
from planner.cli.predict import prediction_of  # noqa: E402
from planner.trajectory import read_trajectory  # noqa: E402
from tests.judge.playing import read_record  # noqa: E402
from tests.judge.true_arm import TrueArm, random_arm  # noqa: E402
from tests.judge.verdict import judge, measured  # noqa: E402

FIGURES = ("off by rms", "95 %", "missing", "crushed", "rms at its time", "height sd", "predicted / judged")


def data_sheet(arm: Arm) -> Arm:
    """The arm of somebody who has measured nothing: a straight line in the place of each curve."""
    joints = []
    for joint in arm.joints:
        assert joint.servo is not None
        table = np.array(joint.servo.curve)
        line = np.poly1d(np.polyfit(*table.T, 1))
        curve = tuple((float(at), float(np.round(line(at)))) for at in (table[0, 0], table[-1, 0]))
        joints.append(replace(joint, servo=replace(joint.servo, curve=curve, pulse_range_us=(200.0, 2600.0))))
    return replace(arm, joints=tuple(joints))


def command(*arguments: object) -> None:
    if main([str(argument) for argument in arguments]):
        raise SystemExit(f"failed: {arguments}")


def calibrated(true: TrueArm, seed: int, sd_mm: float, before: str) -> str:
    """The file of the arm that its marks tell of."""
    record = read_record(Path("pulses.csv"))
    times_s = np.genfromtxt("marks.csv", delimiter=",", names=True)["t_s"]
    rows = [
        f"{mark},{x:.3f},{y:.3f},{h:.3f},{sd_mm}"
        for mark, (x, y, h) in enumerate(measured(true, record, times_s, np.random.default_rng(seed), sd_mm))
    ]
    Path("measured.csv").write_text("\n".join(["mark,x_mm,y_mm,h_mm,sd_mm", *rows]) + "\n")
    command("calibrate", before, "--record", "pulses.csv", "--marks", "measured.csv", "-o", "arm2.toml", "--quiet")
    return "arm2.toml"


def drawn(true: TrueArm, arm: str, drawing: Path) -> list[float]:
    command(drawing, "--arm", arm, "-o", "t.csv", "--quiet")
    command("run", "t.csv", "--arm", arm, "--fast", "--record", "p.csv", "--quiet")
    verdict = judge(true, read_record(Path("p.csv")))
    expected = prediction_of(load_arm(arm), read_trajectory(Path("t.csv")), Path("t.csv"), 0)
    return [
        verdict.path_rms,
        verdict.path_p95,
        verdict.missing,
        verdict.crushed,
        verdict.rms,
        verdict.height_sd,
        expected.rms_mm / verdict.path_rms,
    ]


def table(options: argparse.Namespace, drawings: list[Path]) -> None:
    nominal = load_arm("drawing_arm_2022")
    before = "drawing_arm_2022"
    if options.line:
        before = "line.toml"
        Path(before).write_text(arm_toml(data_sheet(nominal)))
    command(
        "pattern", "--arm", before, "-o", "pattern.csv", "--marks", "marks.csv", "--count", options.marks, "--quiet"
    )
    command("run", "pattern.csv", "--arm", before, "--fast", "--record", "pulses.csv", "--quiet")
    print("| arm | " + " | ".join(FIGURES) + " |\n|---" + "|---" * len(FIGURES) + "|")
    rows = []
    for seed in range(options.arms):
        true = random_arm(nominal, np.random.default_rng(seed), gravity=("q2", "q3") if options.gravity else ())
        arm = before if options.as_it_is else calibrated(true, seed + 50, options.sd, before)
        rows.append(np.mean([drawn(true, arm, drawing) for drawing in drawings], axis=0))
        print(f"| {seed} | " + " | ".join(f"{value:.3f}" for value in rows[-1]) + " |", flush=True)
    for name, row in (("mean", np.mean(rows, axis=0)), ("worst", np.max(rows, axis=0))):
        print(f"| {name} | " + " | ".join(f"{value:.3f}" for value in row) + " |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arms", type=int, default=20)
    parser.add_argument("--marks", type=int, default=49)
    parser.add_argument("--sd", type=float, default=0.15)
    parser.add_argument("--line", action="store_true", help="from a datasheet line, not from the shipped tables")
    parser.add_argument("--gravity", action="store_true", help="two joints are kept on one side of their play")
    parser.add_argument("--as-it-is", action="store_true", help="without a calibration")
    parser.add_argument("drawings", type=Path, nargs="*")
    given = parser.parse_args()
    svgs = [drawing.resolve() for drawing in given.drawings] or sorted((ROOT / "examples").glob("*.svg"))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        table(given, svgs)
