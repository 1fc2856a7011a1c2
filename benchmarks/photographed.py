"""How well arms draw that were calibrated from photos of their sheets: the whole cycle by commands.

    python benchmarks/photographed.py [--arms 6] [--first 200] [--photos 2] [--marks 49] [DRAWING.svg ...]

The marks are read by `plan measure` off rendered photos of the printed sheet, with all the ink that a true arm
(tests/judge) leaves on it: one sheet after the other, each drawn by the arm as calibrated from those before. The
paper's height is known to 0.3 mm at one place before the first. One row a sheet: how it was read, and what is drawn
after.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import sys
import tempfile
from dataclasses import astuple
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from planner.arms.arm_file import load_arm  # noqa: E402
from planner.arms.arm_text import arm_toml  # noqa: E402
from planner.cli import main  # noqa: E402
from planner.error_model.pattern.touch import Heights  # noqa: E402
from tests.error_model.photo.rendering import Camera  # noqa: E402
from tests.judge.photographing import Sheet, on_a_card, photograph_sheet, read_well  # noqa: E402
from tests.judge.playing import read_record  # noqa: E402
from tests.judge.true_arm import TrueArm, random_arm  # noqa: E402
from tests.judge.verdict import judge  # noqa: E402

ARM = "drawing_arm_2022"
CARD_SD_MM = 0.3
COLUMNS = (
    "arm", "sheet", "ink of marks", "found", "astray", "places off by rms", "beginnings", "off by rms",
    "drawn off by rms", "95 %", "missing", "crushed", "height sd",
)  # fmt: skip


def command(*arguments: object) -> None:
    if main([str(argument) for argument in arguments]):
        raise SystemExit(f"failed: {arguments}")


def draw_sheet(sheet: Sheet, arm: str, count: int, seed: int) -> None:
    pattern, marks, pdf, pulses = (sheet.file(kind) for kind in ("pattern.csv", "marks.csv", "sheet.pdf", "pulses.csv"))
    made = ("-o", pattern, "--marks", marks, "--sheet", pdf, "--count", count, "--seed", seed, "--quiet")
    command("pattern", "--arm", arm, *made)
    command("run", pattern, "--arm", arm, "--fast", "--record", pulses, "--quiet")


def drawn(true: TrueArm, arm: str, drawing: Path) -> list[float]:
    command(drawing, "--arm", arm, "-o", "t.csv", "--quiet")
    command("run", "t.csv", "--arm", arm, "--fast", "--record", "p.csv", "--quiet")
    verdict = judge(true, read_record(Path("p.csv")))
    return [verdict.path_rms, verdict.path_p95, verdict.missing, verdict.crushed, verdict.height_sd]


def sheets_of(seed: int, options: argparse.Namespace, drawings: list[Path]) -> list[list[float]]:
    """One row for each photographed sheet of an arm."""
    nominal = load_arm(ARM)
    true = random_arm(nominal, np.random.default_rng(seed))
    card = Sheet("card")
    draw_sheet(card, ARM, options.marks, 0)
    record, depth_mm = read_record(card.file("pulses.csv")), Heights.for_arm(nominal).reach_mm
    before = on_a_card(nominal, true, record, card.file("marks.csv"), depth_mm, CARD_SD_MM, seed)
    Path("arm0.toml").write_text(arm_toml(before))
    rows: list[list[float]] = []
    known: list[object] = []
    for k in range(options.photos):
        sheet = Sheet(f"sheet{k}")
        draw_sheet(sheet, f"arm{k}.toml", options.marks, k)
        photograph_sheet(true, sheet, Camera(), 10 * seed + k)
        photo, marks, measured = (sheet.file(kind) for kind in ("photo.jpg", "marks.csv", "measured.csv"))
        known += ["--record", sheet.file("pulses.csv"), "--marks", measured]
        with contextlib.redirect_stderr(io.StringIO()):  # what was not found or believed is in the row
            command("measure", photo, "--marks", marks, "-o", measured, "--quiet")
            command("calibrate", "arm0.toml", *known, "-o", f"arm{k + 1}.toml", "--quiet")
        figures = np.mean([drawn(true, f"arm{k + 1}.toml", drawing) for drawing in drawings], axis=0)
        rows.append([*astuple(read_well(true, sheet)), *figures.tolist()])
        print(line_of(seed, k + 1, *rows[-1]), flush=True)
    return rows


def line_of(*cells: object) -> str:
    return "| " + " | ".join(f"{cell:.3g}" if isinstance(cell, float) else str(cell) for cell in cells) + " |"


def table(options: argparse.Namespace, drawings: list[Path]) -> None:
    print(line_of(*COLUMNS) + "\n|" + "---|" * len(COLUMNS))
    arms = [sheets_of(seed, options, drawings) for seed in range(options.first, options.first + options.arms)]
    for k, rows in enumerate(np.array(arms, dtype=float).transpose(1, 0, 2)):
        print(line_of("mean", k + 1, *rows.mean(axis=0).tolist()))
        print(line_of("worst", k + 1, *rows.max(axis=0).tolist()))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arms", type=int, default=6)
    parser.add_argument("--first", type=int, default=200, help="seed of the first arm")
    parser.add_argument("--photos", type=int, default=2, help="so many photographed sheets, one after the other")
    parser.add_argument("--marks", type=int, default=49)
    parser.add_argument("drawings", type=Path, nargs="*")
    given = parser.parse_args()
    svgs = [drawing.resolve() for drawing in given.drawings] or sorted((ROOT / "examples").glob("*.svg"))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        table(given, svgs)
