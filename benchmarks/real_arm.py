"""How well arms draw that are not as their files say, before and after a calibration: the whole cycle by commands.

    python benchmarks/real_arm.py [--arms 20] [--marks 49] [--sd 0.15] [--line] [--gravity] [--methods path,dls]
                                  [DRAWING.svg ...]

Random true arms of the kind of `drawing_arm_2022` (tests/judge) draw a pattern, its marks are measured with noise, the
arm is calibrated, plans the drawings by each method and draws them. One row an arm and method, then for each method the
means and the worst arm. Off at rest: of a second sheet's dots, with the share of 95 % intervals that hold them.
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
from planner.error_model.calibration.calibrate import calibrate  # noqa: E402
from planner.error_model.calibration.files import Measured, Touches  # noqa: E402
from planner.error_model.calibration.files import read_record as told_in  # noqa: E402
from planner.error_model.calibration.sheets import Sheet, marks_of  # noqa: E402
from planner.error_model.model import tips_at  # noqa: E402
from planner.trajectory import read_trajectory  # noqa: E402
from tests.judge.playing import read_record  # noqa: E402
from tests.judge.true_arm import TrueArm, random_arm  # noqa: E402
from tests.judge.verdict import judge, measured  # noqa: E402

FIGURES = (
    "off by rms", "95 %", "missing", "crushed", "rms at its time", "height sd", "time s", "predicted / judged",
    "off at rest", "inside 95 %",
)  # fmt: skip
FRESH, FRESH_MARKS, FRESH_SEED = "fresh", 25, 5
NO_TOUCHES = Touches(np.empty(0), np.empty((0, 2)), np.empty((0, 2)), np.empty(0, dtype=np.int64))


def data_sheet(arm: Arm) -> Arm:
    """The arm of somebody who has measured nothing: a straight line in the place of each curve."""
    joints = []
    for joint in arm.joints:
        assert joint.servo is not None
        table = np.array(joint.servo.curve)
        line = np.poly1d(np.polyfit(table[:, 0], table[:, 1], 1))
        curve = tuple((float(at), float(np.round(line(at)))) for at in (table[0, 0], table[-1, 0]))
        joints.append(replace(joint, servo=replace(joint.servo, curve=curve, pulse_range_us=(200.0, 2600.0))))
    return replace(arm, joints=tuple(joints))


def command(*arguments: object) -> None:
    if main([str(argument) for argument in arguments]):
        raise SystemExit(f"failed: {arguments}")


def draw_pattern(name: str, arm: str, *options: object) -> None:
    command("pattern", "--arm", arm, "-o", f"{name}.csv", "--marks", f"{name}_marks.csv", "--quiet", *options)
    command("run", f"{name}.csv", "--arm", arm, "--fast", "--record", f"{name}_pulses.csv", "--quiet")


def sheet_of(name: str, arm: Arm, true: TrueArm, seed: int, sd_mm: float) -> Sheet:
    """What is measured on the sheet of that name."""
    pulses = Path(f"{name}_pulses.csv")
    times_s = np.genfromtxt(f"{name}_marks.csv", delimiter=",", names=True)["t_s"]
    tips_mm = measured(true, read_record(pulses), times_s, np.random.default_rng(seed), sd_mm)
    marks = Measured(np.arange(len(tips_mm)), tips_mm, np.full(len(tips_mm), max(sd_mm, 1e-3)), NO_TOUCHES)
    return Sheet(name, told_in(pulses, arm), marks)


def calibrated(true: TrueArm, seed: int, sd_mm: float, before: str) -> tuple[str, float, float]:
    """The file of the arm that its marks tell of; how far it is off at dots that it has not seen, in mm rms, and the
    share of their 95 % intervals that hold them."""
    arm = load_arm(before)
    found = calibrate(arm, [sheet_of("pattern", arm, true, seed, sd_mm)])
    Path("arm2.toml").write_text(arm_toml(found.arm))
    fit, (fresh, _) = found.fit, marks_of(arm, sheet_of(FRESH, arm, true, seed, 0.0), found.fit.model)
    change, stands = tips_at(fit.model, fresh.told)
    errors = fresh.tips_mm - change.tip_mm
    inside = np.abs(errors) < 1.96 * fit.tip_sd_mm(fit.parameters.jacobian(fit.model, change, stands))
    return "arm2.toml", float(np.sqrt((errors[:, :2] ** 2).sum(axis=1).mean())), float(inside.mean())


def drawn(true: TrueArm, arm: str, drawing: Path, method: str) -> list[float]:
    command(drawing, "--arm", arm, "-o", "t.csv", "--method", method, "--quiet")
    command("run", "t.csv", "--arm", arm, "--fast", "--record", "p.csv", "--quiet")
    record = read_record(Path("p.csv"))
    verdict = judge(true, record)
    expected = prediction_of(load_arm(arm), read_trajectory(Path("t.csv")), Path("t.csv"), 0)
    return [
        verdict.path_rms,
        verdict.path_p95,
        verdict.missing,
        verdict.crushed,
        verdict.rms,
        verdict.height_sd,
        float(record.times_s[-1]),
        expected.rms_mm / verdict.path_rms,
    ]


def line_of(*cells: object) -> str:
    return "| " + " | ".join(f"{cell:.3f}" if isinstance(cell, float) else str(cell) for cell in cells) + " |"


def table(options: argparse.Namespace, drawings: list[Path]) -> None:
    nominal = load_arm("drawing_arm_2022")
    before = "drawing_arm_2022"
    if options.line:
        before = "line.toml"
        Path(before).write_text(arm_toml(data_sheet(nominal)))
    draw_pattern("pattern", before, "--count", options.marks)
    draw_pattern(FRESH, before, "--count", FRESH_MARKS, "--seed", FRESH_SEED)
    print(line_of("arm", "method", *FIGURES) + "\n|---" + "|---" * (len(FIGURES) + 1) + "|")
    rows: dict[str, list[list[float]]] = {method: [] for method in options.methods}
    for seed in range(options.arms):
        true = random_arm(nominal, np.random.default_rng(seed), gravity=("q2", "q3") if options.gravity else ())
        nothing = (before, float("nan"), float("nan"))
        arm, *at_rest = nothing if options.as_it_is else calibrated(true, seed + 50, options.sd, before)
        for method, of_method in rows.items():
            mean = np.mean([drawn(true, arm, drawing, method) for drawing in drawings], axis=0)
            of_method.append([*mean.tolist(), *at_rest])
            print(line_of(seed, method, *of_method[-1]), flush=True)
    for method, of_method in rows.items():
        print(line_of("mean", method, *np.mean(of_method, axis=0).tolist()))
        print(line_of("worst", method, *np.max(of_method, axis=0).tolist()))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arms", type=int, default=20)
    parser.add_argument("--marks", type=int, default=49)
    parser.add_argument("--sd", type=float, default=0.15)
    parser.add_argument("--line", action="store_true", help="from a datasheet line, not from the shipped tables")
    parser.add_argument("--gravity", action="store_true", help="two joints are kept on one side of their play")
    parser.add_argument("--as-it-is", action="store_true", help="without a calibration")
    parser.add_argument("--methods", type=lambda text: text.split(","), default=["path"], metavar="NAME,...")
    parser.add_argument("drawings", type=Path, nargs="*")
    given = parser.parse_args()
    svgs = [drawing.resolve() for drawing in given.drawings] or sorted((ROOT / "examples").glob("*.svg"))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        table(given, svgs)
