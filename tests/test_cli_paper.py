"""Where the paper lies: said, printed at true size, and gone round with the pen in the air."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pypdfium2
import pytest

from hardware.motion.tip import link_nodes_mm
from planner.arms.arm_file import load_arm
from planner.arms.arm_text import arm_toml
from planner.arms.paper_pose import PaperPose
from planner.cli import main
from planner.cli.run_frame import framing
from planner.cli.run_job import examine
from planner.cli.run_options import parser
from planner.trajectory import read_trajectory

SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 20"><path d="M5 5H30" stroke="#000"/></svg>'
MM_PER_POINT = 25.4 / 72.0


@pytest.mark.parametrize("arm", ["drawing_arm", "scara", "six_joint"])
def test_the_sheet_is_printed_at_true_size(arm: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sheet = tmp_path / "sheet.pdf"
    assert main(["paper", "--arm", arm, "--paper", "a6", "-o", str(sheet)]) == 0
    said = capsys.readouterr().out
    assert said.startswith("lay the A6 (148 x 105 mm) sheet")
    page = pypdfium2.PdfDocument(sheet)[0]
    size_mm = np.sort(np.array(page.get_size()) * MM_PER_POINT)
    known = {"A4": (210, 297), "A3": (297, 420), "A2": (420, 594), "A1": (594, 841)}
    np.testing.assert_allclose(size_mm, next(size for name, size in known.items() if f"on {name} at" in said), atol=0.1)
    # The bar that is to be checked with a ruler, and the sheet itself, are where a ruler finds them.
    dark = np.asarray(page.render(scale=2).to_numpy())[..., 0] < 128
    across_mm = [np.ptp(np.flatnonzero(row)) * MM_PER_POINT / 2 for row in dark if row.any()]
    assert any(abs(length - 100.0) < 0.7 for length in across_mm)
    assert any(abs(length - 148.0) < 14.0 for length in across_mm)


def test_the_frame_is_gone_round_in_the_air(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(SVG)
    assert main(["d.svg", "-o", "t.csv", "--paper", "90x60", "--quiet"]) == 0
    job = examine(parser().parse_args(["t.csv"]))
    program = framing(job)
    tips = link_nodes_mm(job.arm, program.positions)[:, -1]
    assert tips[:, 2].min() >= job.arm.pen.clearance_mm - 0.01
    told = read_trajectory(Path("t.csv")).placement.canvas_mm
    assert told is not None
    near, far, right, left = told
    for x in (near, far):
        for y in (right, left):
            assert np.hypot(tips[:, 0] - x, tips[:, 1] - y).min() < 0.1
    assert main(["run", "t.csv", "--frame", "--fast", "--quiet"]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["d.svg", "t.csv"]


def test_a_board_is_told_of_drawn_on_and_gone_round(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(SVG)
    board = PaperPose(190.0, 0.0, 80.0, tilt_y_rad=-np.pi / 2)
    six = load_arm("six_joint")
    six = replace(six, paper=board, closed_form=None, workspace=replace(six.workspace, inner_radius_mm=0.0))
    Path("board.toml").write_text(arm_toml(six))
    assert main(["paper", "--arm", "board.toml", "--paper", "a6", "-o", "sheet.pdf"]) == 0
    told = capsys.readouterr().out
    assert told.startswith("put up the A6 (148 x 105 mm) sheet of 148 x 105 mm; corners at (190, ")
    (top_left, top_right, _, bottom_left) = (
        np.array([float(value) for value in corner.split(",")]) for corner in re.findall(r"\(([-\d, ]+)\)", told)[:4]
    )
    np.testing.assert_allclose(top_left - top_right, [0.0, 148.0, 0.0], atol=1.0)  # left of who looks from the arm
    np.testing.assert_allclose(top_left - bottom_left, [0.0, 0.0, 105.0], atol=1.0)
    assert main(["d.svg", "-o", "t.csv", "--arm", "board.toml", "--paper", "a6", "--quiet"]) == 0
    job = examine(parser().parse_args(["t.csv", "--arm", "board.toml"]))
    nodes = link_nodes_mm(job.arm, framing(job).positions)
    assert nodes[:, -1, 2].min() >= job.arm.pen.clearance_mm - 0.01
    assert nodes[..., 2].min() >= -1e-3
    assert main(["run", "t.csv", "--arm", "board.toml", "--fast", "--quiet"]) == 0
    assert main(["plot", "t.csv", "--arm", "board.toml", "-o", "t.png"]) == 0


@pytest.mark.parametrize("arguments", [["--paper", "a0"], ["--paper", "wide"], ["-o", "sheet.doc"]])
def test_what_cannot_be_is_refused(
    arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["paper", "-o", "sheet.pdf", *arguments]) in (2, 3)
    assert capsys.readouterr().err.count("\n") == 1 and not list(tmp_path.iterdir())
