"""Pictures through the commands: planned, checked, and refused in a sentence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from planner.cli import main
from tests.drawing.image.pictures import file_of

QUICK = ["--paper", "30x20", "--quiet"]


@pytest.fixture(autouse=True)
def at_the_desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    picture = np.full((60, 90), 255, dtype=np.uint8)
    y, x = np.mgrid[0:60, 0:90]
    picture[np.hypot(x - 44.5, y - 29.5) < 25] = 60
    Path("disc.png").write_bytes(file_of(picture))
    Path("both.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 60">'
        '<g id="photo"><image href="disc.png" width="90"/></g>'
        '<path d="M1 1h88v58h-88z" fill="none" stroke="red"/></svg>'
    )


@pytest.mark.parametrize("style", ["trace", "centreline", "hatch", "scribble", "stipple"])
def test_every_style_is_planned_and_passes_the_check(style: str, capsys: pytest.CaptureFixture[str]) -> None:
    ink = ["--image-ink", "20%"] if style == "stipple" else []
    assert main(["disc.png", "--image", style, "-o", "traj.csv", *QUICK, *ink]) == 0
    assert f"# image: {style},0.5" in Path("traj.csv").read_text()
    assert main(["check", "traj.csv", "--drawing", "disc.png", "--verbose"]) == 0
    assert ("tone of pictures" in capsys.readouterr().out) == (style in ("hatch", "scribble", "stipple"))


def test_the_check_knows_another_picture(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["disc.png", "-o", "traj.csv", *QUICK]) == 0
    light = np.full((60, 90), 200, dtype=np.uint8)
    Path("disc.png").write_bytes(file_of(light))
    capsys.readouterr()
    assert main(["check", "traj.csv", "--drawing", "disc.png"]) == 1
    told = capsys.readouterr().out
    assert "FAULT nothing extra" in told and "FAULT nothing missing" in told


def test_a_picture_that_nobody_speaks_of_is_hatched_and_that_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["disc.png", "-o", "traj.csv", "--paper", "30x20"]) == 0
    assert "drawn as with --image hatch; there are trace, centreline, scribble, stipple too" in capsys.readouterr().out


def test_pictures_and_lines_are_drawn_layer_by_layer(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["both.svg", "--image", "trace", "--layers", "photo", "-o", "traj.csv", *QUICK]) == 0
    assert main(["check", "traj.csv", "--drawing", "both.svg"]) == 0
    assert main(["both.svg", "--image", "trace", "--list-layers"]) == 0
    assert "photo: 1 line" in capsys.readouterr().out
    assert main(["both.svg", "--image", "trace", "--copies", "2x1", "-o", "two.csv", *QUICK]) == 0
    assert main(["check", "two.csv", "--drawing", "both.svg"]) == 0
    assert main(["plot", "two.csv", "--kind", "drawing", "--drawing", "both.svg", "-o", "two.png"]) == 0


def test_a_picture_with_a_resolution_keeps_its_size(capsys: pytest.CaptureFixture[str]) -> None:
    with Image.open("disc.png") as picture:
        picture.save("sized.png", dpi=(76.2, 76.2))  # three pixels to a mm
    assert main(["lines", "sized.png", "-o", "lines.svg"]) == 0
    assert "on a page of 30 x 20 mm" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "arguments", "why"),
    [
        (file_of(np.full((9, 9), 255, dtype=np.uint8)), [], "nothing to draw: the picture is all white"),
        (
            file_of(np.random.default_rng(1).integers(0, 256, (40, 40)).astype(np.uint8))[:900],
            [],
            "it is no whole picture",
        ),
        (file_of(np.zeros((1, 1), dtype=np.uint8)), ["--image-line", "100mm"], "nothing to draw: --image hatch finds"),
        (b"\x89PNG\r\n\x1a\nno more", [], "it is no whole picture"),
        (file_of(np.zeros((9, 9), dtype=np.uint8)), ["--image", "halftone"], "invalid choice: 'halftone'"),
        (file_of(np.zeros((9, 9), dtype=np.uint8)), ["--image-levels", "0"], "image levels is a whole number from 1"),
        (file_of(np.zeros((9, 9), dtype=np.uint8)), ["--image-ink", "150%"], "image ink 1.5 has to be"),
    ],
)
def test_what_cannot_be_drawn_is_said_in_a_sentence(
    content: bytes, arguments: list[str], why: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("bad.png").write_bytes(content)
    assert main(["bad.png", "-o", "traj.csv", *QUICK, *arguments]) == 2
    error = capsys.readouterr().err
    assert why in error and error.count("\n") == 1
    assert not Path("traj.csv").exists()


def test_a_picture_of_one_pixel_is_a_black_page() -> None:
    Path("one.png").write_bytes(file_of(np.zeros((1, 1), dtype=np.uint8)))
    assert main(["one.png", "-o", "traj.csv", "--paper", "15x15", "--quiet"]) == 0
    assert main(["check", "traj.csv", "--drawing", "one.png"]) == 0
