"""`plan plot` from the command line: each kind makes its file, and what means nothing ends in one line."""

from __future__ import annotations

import struct
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from planner.arms.arm_file import load_arm
from planner.cli import main
from planner.trajectory import Trajectory, write_trajectory
from tests.drawn_shapes import lines_svg

DRAWING = lines_svg('<path d="M0 0 H60 V40"/>', 'viewBox="0 0 60 40"')


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """With bend.svg, and traj.csv, in which scara's pen makes an arc, taps, and makes another."""
    monkeypatch.chdir(tmp_path)
    arm = load_arm("scara")
    s = (1 - np.cos(np.linspace(0, np.pi, 121))) / 2
    pen = np.zeros(121, dtype=bool)
    pen[10:50] = pen[60] = pen[70:110] = True
    positions = np.column_stack((20 + 40 * s, np.full(121, -80.0), np.where(pen, -120.0, -117.0), np.zeros(121)))
    stroke = np.full(121, -1)
    stroke[10:50], stroke[60], stroke[70:110] = 0, 1, 2
    write_trajectory(
        Trajectory(
            "scara",
            "bend.svg",
            "path",
            100.0,
            arm.column_names,
            positions,
            pen,
            stroke,
            (0.0, -1.0, -1.0, 0.0, 150.0, 60.0),
        ),
        tmp_path / "traj.csv",
    )
    (tmp_path / "bend.svg").write_text(DRAWING)
    return tmp_path


def one_line(capsys: pytest.CaptureFixture[str]) -> str:
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    return captured.err


def png_size(file: Path) -> tuple[int, int]:
    header = file.read_bytes()[:24]
    assert header[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", header[16:])
    return width, height


@pytest.mark.parametrize(
    ("kind", "more", "target"),
    [
        ("profiles", ["--from", "0.2", "--to", "0.7"], "p.png"),
        ("drawing", ["--drawing", "bend.svg"], "p.svg"),
        ("speed", [], "p.png"),
        ("error", ["--drawing", "bend.svg", "--tolerance", "0.1mm"], "p.png"),
        ("phase", ["--stroke", "2"], "p.svg"),
        ("timeline", ["--size", "paper"], "p.pdf"),
    ],
)
def test_every_kind_makes_its_file(
    kind: str, more: list[str], target: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plot", "traj.csv", "--kind", kind, *more, "-o", target, "--theme", "dark", "--dpi", "50"]) == 0
    assert capsys.readouterr() == ("", "")
    if target == "p.png":
        assert png_size(folder / target)[0] == 640
    elif target == "p.svg":
        assert ET.parse(folder / target).getroot().tag == "{http://www.w3.org/2000/svg}svg"
        assert "#15181b" in (folder / target).read_text().lower()
    else:
        assert (folder / target).read_bytes().startswith(b"%PDF-")


def test_a_paper_is_as_wide_as_a_page_and_sharp(folder: Path) -> None:
    assert main(["plot", "traj.csv", "--kind", "phase", "--size", "paper", "-o", "p.png"]) == 0
    assert png_size(folder / "p.png")[0] == pytest.approx(180 / 25.4 * 300, abs=1)


def test_the_name_of_a_film_is_enough(folder: Path) -> None:
    for name, begins in (("film.html", b"<!DOCTYPE html>"), ("film.gif", b"GIF89a")):
        assert main(["plot", "traj.csv", "-o", name, "--fps", "5", "--dpi", "30", "--speed-factor", "2"]) == 0
        assert (folder / name).read_bytes().startswith(begins)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["traj.csv", "-o", "e.png", "--kind", "error"], "--kind error needs --drawing"),
        (
            ["traj.csv", "-o", "e.png", "--drawing", "bend.svg"],
            "--drawing goes with --kind drawing or error, not profiles",
        ),
        (["traj.csv", "-o", "e.png", "--kind", "speed", "--tolerance", "1"], "--tolerance goes with --kind error"),
        (
            ["traj.csv", "-o", "e.png", "--kind", "drawing", "--from", "1"],
            "--from goes with --kind profiles or timeline",
        ),
        (["traj.csv", "-o", "e.png", "--speed-factor", "2"], "--speed-factor goes with --kind film"),
        (["traj.csv", "-o", "e.bmp"], ".png, .svg, .pdf"),
        (["traj.csv", "-o", "e.gif", "--kind", "speed"], ".png, .svg, .pdf"),
        (["traj.csv", "-o", "e.png", "--kind", "film"], ".html, .gif, .mp4"),
        (["traj.csv", "-o", "e.png", "--kind", "phase", "--stroke", "3"], "no stroke 3: the trajectory has 3, 0 to 2"),
        (["traj.csv", "-o", "e.png", "--kind", "phase", "--stroke", "1"], "stroke 1 is a tap"),
        (["traj.csv", "-o", "e.png", "--kind", "phase", "--stroke", "-1"], "'-1' is not the index of a stroke"),
        (["traj.csv", "-o", "e.png", "--kind", "phase", "--stroke", "last"], "'last' is not the index of a stroke"),
        (["traj.csv", "-o", "e.png", "--from", "2"], "the trajectory lasts 1.2 s"),
        (["traj.csv", "-o", "e.png", "--from", "0.8", "--to", "0.3"], "nothing to show from 0.8 to 0.3 s"),
        (["traj.csv", "-o", "e.html", "--fps", "80"], "'80' is more than 50"),
        (["traj.csv", "-o", "e.png", "--kind", "timeline", "--arm", "drawing_arm"], "was planned for arm 'scara'"),
        (["-o", "e.html"], "--kind film needs a trajectory"),
    ],
)
def test_what_means_nothing_is_refused_in_one_line(
    arguments: list[str], message: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(folder.iterdir())
    assert main(["plot", *arguments]) == 2
    assert message in one_line(capsys)
    assert sorted(folder.iterdir()) == before


def test_help_has_an_example_of_every_kind(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", "--help"]) == 0
    text = capsys.readouterr().out
    examples = text[text.index("examples:") :]
    for kind in ("drawing", "speed", "error", "phase", "timeline", "workspace"):
        assert f"--kind {kind}" in examples
    assert "film.html" in examples
    assert "profiles.png" in examples
