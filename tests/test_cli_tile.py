"""`plan --tile`: which files come of it, what is said of them, and what contradicts it."""

from __future__ import annotations

from pathlib import Path

import pytest

from planner.cli import main
from planner.trajectory import read_trajectory
from tests.drawn_shapes import lines_svg

PAGE = 'width="300mm" height="120mm" viewBox="0 0 300 120"'
HALF = lines_svg('<path d="M10 10H90M10 70L90 110"/><path d="M12 80h.4" stroke="red"/>', PAGE)
"""On the left half of the page alone."""


@pytest.fixture
def drawing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    Path("half.svg").write_text(HALF, encoding="utf-8")
    return "half.svg"


def test_empty_sheets_are_left_out_and_all_is_told(drawing: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([drawing, "--tile", "--min-length", "1"]) == 0
    told = capsys.readouterr()
    assert sorted(path.name for path in Path().glob("*.csv")) == ["half-1-1.csv", "half-1-2.csv"]
    assert "300.0 x 120.0 mm in 2 columns and 2 rows, of 150.0 x 60.0 mm each: 2 sheets" in told.out
    assert "nothing is on 2-1, 2-2, which are left out" in told.out
    assert "sheet 1-2: 0.0 to 150.0 mm from the left, 60.0 to 120.0 mm from the top" in told.out
    assert "for each sheet, lay paper" in told.out
    assert told.err.count("shorter than 1 mm and left out: 1 stroke") == 1
    for path in Path().glob("*.csv"):  # which knows on which of them the short stroke was left out
        assert main(["check", str(path), "--drawing", drawing, "--quiet"]) == 0
        whole = read_trajectory(path)
        whole.save("again.csv")
        assert read_trajectory(Path("again.csv")).placement == whole.placement


def test_a_sheet_is_checked_for_what_is_on_it_alone(drawing: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([drawing, "--tile", "-o", "t.csv", "--quiet"]) == 0
    text = Path("t-1-1.csv").read_text(encoding="utf-8")
    Path("other.csv").write_text(text.replace("# tile_marks_mm: ", "# tile_marks_mm: 70 -70 "), encoding="utf-8")
    assert main(["check", "other.csv", "--drawing", drawing]) == 1
    assert "nothing missing" in capsys.readouterr().out
    tile = [line for line in text.splitlines() if line.startswith("# tile")]
    for line in tile:
        Path("none.csv").write_text(text.replace(line + "\n", line.partition(":")[0] + ": x\n"), encoding="utf-8")
        assert main(["check", "none.csv"]) == 2
        assert line.partition(":")[0] in capsys.readouterr().err
    Path("plain.csv").write_text("".join(f"{x}\n" for x in text.splitlines() if x not in tile), encoding="utf-8")
    assert main(["check", "plain.csv", "--drawing", drawing]) == 1


def test_a_drawing_for_which_one_sheet_is_enough_says_so(drawing: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([drawing, "--tile", "--scale", "0.3", "-o", "t.csv", "--report", "r"]) == 0
    told = capsys.readouterr().out
    assert "hint: one sheet is enough" in told and "crosses" not in told and Path("t-1-1.csv").exists()
    assert Path("r/1-1/index.html").is_file()


@pytest.mark.parametrize(
    ("options", "fault"),
    [
        (["-o", "-"], "--tile writes a file for each sheet: name one with -o"),
        (["--fit"], "leaves nothing for --fit: leave that out, or name the --paper"),
        (["--align", "top"], "leaves nothing for --align"),
        (["--at", "1", "2"], "leaves nothing for --at"),
        (["--copies", "2x1"], "leaves nothing for --copies"),
        (["--place", "best"], "--tile and --place best contradict each other"),
        (["--margin", "50"], "a margin of 50 mm, and 3 mm for register marks, leave nothing"),
        (["--scale", "200"], "sides are 1 mm to 10 m"),
        (["--scale", "30"], "sheets, and 1000 are the most: choose a smaller --scale"),
    ],
)
def test_what_contradicts_sheets_is_refused(
    drawing: str, options: list[str], fault: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([drawing, "--tile", *options]) == 2
    told = capsys.readouterr()
    assert fault in told.err and told.err.count("\n") == 1 and not told.out
    assert not list(Path().glob("*.csv"))


def test_a_paper_that_is_cut_may_be_filled_aligned_and_hold_copies(
    drawing: str, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ["--paper", "300x240", "--copies", "1x2", "--align", "top", "--split", "--by", "colour"]
    assert main([drawing, "--tile", "-o", "t.csv", *options]) == 0
    names = {path.name for path in Path().glob("t-*.csv")}
    assert {"t-1-1_1_000000.csv", "t-1-2_2_ff0000.csv"} <= names
    for name in names:
        assert main(["check", name, "--drawing", drawing, "--quiet"]) == 0
        marks = read_trajectory(Path(name)).placement.tile
        assert marks is not None and bool(marks.marks_mm) == ("_1_" in name)
