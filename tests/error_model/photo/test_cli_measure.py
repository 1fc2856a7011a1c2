"""`plan measure` from the command line: its files, what it says, and one sentence for each thing that may be wrong."""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from planner.cli import main
from planner.error_model.sheet.marks import Mark, write_marks
from tests.error_model.photo.drawn import Drawn, draw, pattern
from tests.error_model.photo.rendering import Camera, Pixels, drawn_sheet, photograph

LOST = 7


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    return draw(tmp_path_factory.mktemp("sheet"), pattern(8, 4), 3, without=[LOST])


@pytest.fixture(scope="module")
def photo(drawn: Drawn) -> Pixels:
    return photograph(drawn.sheet(), Camera(azimuth_deg=15, shadows=1), 3)


@pytest.fixture
def folder(tmp_path: Path, drawn: Drawn, photo: Pixels, monkeypatch: pytest.MonkeyPatch) -> Path:
    """With photo.png and marks.csv."""
    monkeypatch.chdir(tmp_path)
    cv2.imwrite("photo.png", photo)
    write_marks(tmp_path / "marks.csv", drawn.marks)
    return tmp_path


def refused(capfd: pytest.CaptureFixture[str], *arguments: str) -> str:
    """What is said, which is one line, and of a command that leaves nothing behind."""
    before = sorted(path.name for path in Path().iterdir())
    assert main(["measure", *arguments, "--marks", "marks.csv", "-o", "measured.csv"]) == 2
    assert sorted(path.name for path in Path().iterdir()) == before
    captured = capfd.readouterr()
    assert captured.out == "" and captured.err.count("\n") == 1
    return captured.err


def test_marks_are_written_and_what_is_missing_is_named(
    folder: Path, drawn: Drawn, capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(["measure", "photo.png", "--marks", "marks.csv", "-o", "measured.csv", "--picture", "reading.png"]) == 0
    said = capfd.readouterr()
    assert said.out == ""
    assert f"31 of 32 marks found on sheet {drawn.layout.name}" in said.err
    assert f"1 mark not found: {LOST}" in said.err
    assert said.err.count("they must be 150 mm") == 1 and "--bar MM" in said.err
    rows = list(csv.DictReader((folder / "measured.csv").read_text().splitlines()))
    assert list(rows[0]) == ["mark", "x_mm", "y_mm", "h_mm", "sd_mm"]
    assert [int(row["mark"]) for row in rows] == [mark.number for mark in drawn.marks if mark.number != LOST]
    for row in rows:
        place = np.array([float(row["x_mm"]), float(row["y_mm"])])
        assert np.linalg.norm(place - drawn.places_mm[int(row["mark"])]) < 0.2
        assert row["h_mm"] == "" or abs(float(row["h_mm"]) - drawn.heights_mm[int(row["mark"])]) < 0.4
    picture = cv2.imread("reading.png")
    assert picture is not None and picture.shape[1] == 1920


def test_bars_scale_the_places_and_are_not_asked_for_again(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    for name, options in (("one", []), ("two", ["--bar", "145.5mm"]), ("three", ["--bar", "150,145.5"])):
        assert main(["measure", "photo.png", "--marks", "marks.csv", "-o", f"{name}.csv", *options]) == 0
        assert ("ruler" in capfd.readouterr().err) == (not options)
    one, two, three = (
        np.genfromtxt(f"{name}.csv", delimiter=",", skip_header=1)[:, 1:3] for name in ("one", "two", "three")
    )
    np.testing.assert_allclose(two, 0.97 * one, atol=1e-3)
    np.testing.assert_allclose(three, one * [0.97, 1.0], atol=1e-3)


def test_a_dash_is_standard_output(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["measure", "photo.png", "--marks", "marks.csv", "-o", "-", "--quiet"]) == 0
    assert capfd.readouterr().out.startswith("mark,x_mm,y_mm,h_mm,sd_mm\n0,")


def spoiled(change: Callable[[Pixels], Pixels]) -> Callable[[Pixels], bytes]:
    return lambda photo: cv2.imencode(".png", change(photo))[1].tobytes()


SPOILED = {
    "mirrored": (spoiled(lambda photo: photo[:, ::-1].copy()), "mirrored"),
    "blurred": (spoiled(lambda photo: cv2.GaussianBlur(photo, (0, 0), 9)), "no tags"),
    "of a table": (spoiled(lambda photo: np.full_like(photo, 120)), "no tags"),
    "of a corner": (spoiled(lambda photo: photo[:, :760].copy()), "of the sheet's 14 tags"),
    "from too far": (spoiled(lambda photo: cv2.resize(photo, (640, 480), interpolation=cv2.INTER_AREA)), "too small"),
    "a thumbnail": (spoiled(lambda photo: cv2.resize(photo, (160, 120))), "160 x 120 pixels"),
    "cut short": (lambda photo: cv2.imencode(".png", photo)[1].tobytes()[:200_000], "no whole picture"),
    "cut short, as JPEG": (lambda photo: cv2.imencode(".jpg", photo)[1].tobytes()[:100_000], "no whole picture"),
    "empty": (lambda photo: b"", "no whole picture"),
    "a text": (lambda photo: b"mark,x_mm\n", "no whole picture"),
    "a PNG in name": (lambda photo: b"\x89PNG\r\n\x1a\n" + bytes(100), "no whole picture"),
}


@pytest.mark.parametrize("name", SPOILED)
def test_a_photo_that_will_not_do_is_refused(
    name: str, folder: Path, photo: Pixels, capfd: pytest.CaptureFixture[str]
) -> None:
    spoil, said = SPOILED[name]
    (folder / "spoiled.png").write_bytes(spoil(photo))
    assert said in refused(capfd, "spoiled.png")


def test_a_photo_of_another_sheet_is_refused(folder: Path, drawn: Drawn, capfd: pytest.CaptureFixture[str]) -> None:
    write_marks(folder / "marks.csv", [Mark(0, 0.0, (79.0, 0.0)), *drawn.marks[1:]])
    assert "another sheet" in refused(capfd, "photo.png")


def test_a_sheet_before_it_is_drawn_on_is_refused(
    folder: Path, drawn: Drawn, capfd: pytest.CaptureFixture[str]
) -> None:
    sheet = drawn_sheet(drawn.pdf, drawn.layout.origin_page_mm, [])
    cv2.imwrite("photo.png", photograph(sheet, Camera(noise=0.005), 1))
    assert "no marks" in refused(capfd, "photo.png")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--bar", "97"], "not near 150 mm"),
        (["--bar", "150,150,150"], "one length, or two"),
        (["--picture", "reading.txt"], ".png, .svg, .pdf"),
        (["--picture", "measured.csv"], "the same file"),
        (["--picture", "nowhere/reading.png"], "no folder"),
        (["--picture", "photo.png"], "is being read"),
    ],
)
def test_options_that_mean_nothing_are_refused(
    options: list[str], said: str, folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert said in refused(capfd, "photo.png", *options)


def test_files_that_are_not_there_or_are_no_marks(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert "cannot be read" in refused(capfd, "nothing.png")
    (folder / "marks.csv").write_text("x,y\n1,2\n")
    assert "no column mark" in refused(capfd, "photo.png")


def test_without_opencv_the_extra_is_named(
    folder: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in sys.modules if name.startswith(("planner.error_model", "planner.plots.reading"))]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "cv2", None)
    assert "[vision]" in refused(capfd, "photo.png")
