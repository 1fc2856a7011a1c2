"""Ink of the simulated arm against the file: pens, files of one page and sheets of one drawing are in register."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from planner.arrays import FloatArray
from planner.cli import main
from tests.drawn_ink import apart_mm, ink_of, map_of, moved
from tests.drawn_shapes import Shape, bezier, ellipse, lines_svg, polyline

_OFF_MM, _REGISTER_MM = 0.05, 0.01
PAGE = 'width="120mm" height="70mm" viewBox="0 0 240 140"'
LAYER = '<g inkscape:groupmode="layer" inkscape:label="{}" stroke="{}">{}</g>'
RING = ellipse(120, 70, 25, 25)
RED = [RING, polyline((10, 10), (60, 20), (30, 60))]
BLUE = [RING, bezier((20, 120), (80, 20), (160, 200), (230, 60)), polyline((200, 10), (230, 30))]


def layered(*layers: tuple[str, str, list[Shape]]) -> str:
    body = "".join(
        LAYER.format(name, colour, "".join(shape.element for shape in shapes)) for name, colour, shapes in layers
    )
    return lines_svg(body, f'{PAGE} xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"')


def points_of(shapes: list[Shape]) -> list[FloatArray]:
    return [shape.points for shape in shapes]


def ring_middle(ink: list[FloatArray]) -> FloatArray:
    """(2,) the middle of the circle that fits a ring of ink best: the longest closed line."""
    ring = max((line for line in ink if np.hypot(*(line[0] - line[-1])) < 1.0), key=len)
    linear = np.column_stack((2 * ring, np.ones(len(ring))))
    middle: FloatArray = np.linalg.lstsq(linear, (ring**2).sum(axis=1), rcond=None)[0][:2]
    return middle


HOW = [["--no-fit"], ["--paper", "a6", "--align", "top", "--mirror", "--rotate", "10"]]


@pytest.mark.parametrize("how", HOW)
def test_two_pens_land_on_each_other_and_on_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(layered(("1 a", "red", RED), ("2 b", "blue", BLUE)), encoding="utf-8")
    Path("pens.toml").write_text('[[pen]]\nname = "blue"\ncolour = "#00f"\n[[pen]]\nname = "red"\ncolour = "#f00"\n')
    assert main(["d.svg", "-o", "d.csv", "--pens", "pens.toml", "--split", "--quiet", *how]) == 0
    assert main(["d.svg", "-o", "all.csv", "--pens", "pens.toml", "--quiet", *how]) == 0
    affine = map_of(Path("all.csv"))
    inks = {"d_1_blue.csv": BLUE, "d_2_red.csv": RED, "all.csv": [*BLUE, *RED]}
    middles = []
    for name, shapes in inks.items():
        ink = ink_of(Path(name))
        assert apart_mm(ink, [moved(points, affine) for points in points_of(shapes)]) < _OFF_MM, name
        middles.append(ring_middle(ink))
    assert max(np.hypot(*(one - other)) for one, other in pairwise(middles)) < _REGISTER_MM


@pytest.mark.parametrize("how", HOW)
def test_files_of_one_page_land_in_register_with_any_layers_in_any_session(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: list[str]
) -> None:
    """The same ring is in all of them, with other ink beside it; it comes to the same place."""
    monkeypatch.chdir(tmp_path)
    Path("one.svg").write_text(layered(("1 a", "red", RED)), encoding="utf-8")
    Path("two.svg").write_text(layered(("1 a", "red", [RING]), ("2 b", "blue", BLUE[1:])), encoding="utf-8")
    sessions = [
        ("one.svg", ()),
        ("two.svg", ()),
        ("two.svg", ("--layers", "1", "--speed", "20")),
        ("two.svg", ("--by", "layer")),
    ]
    page = np.array([(0.0, 0.0), (240.0, 0.0), (0.0, 140.0), (240.0, 140.0)])
    corners, middles = [], []
    for index, (drawing, options) in enumerate(sessions):
        trajectory = Path(f"{index}.csv")
        assert main([drawing, "-o", str(trajectory), "--quiet", *how, *options]) == 0
        corners.append(moved(page, map_of(trajectory)))
        middles.append(ring_middle(ink_of(trajectory)))
    for one, other in pairwise(corners):
        assert np.abs(one - other).max() < _REGISTER_MM
    for one, other in pairwise(middles):
        assert np.hypot(*(one - other)) < _REGISTER_MM


@pytest.mark.parametrize("how", [[], ["--scale", "80%", "--rotate", "90", "--by", "colour", "--split"]])
def test_sheets_put_together_are_the_drawing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    """Ink of all sheets, each moved back to its place on the page."""
    monkeypatch.chdir(tmp_path)
    shapes = [
        ellipse(130, 60, 50, 50),
        polyline((130, 0), (130, 120)),
        bezier((5, 5), (20, 110), (200, 10), (150, 110)),
    ]
    body = "".join(
        f'<g stroke="{colour}">{shape.element}</g>'
        for colour, shape in zip(("red", "#00f", "#000"), shapes, strict=True)
    )
    Path("d.svg").write_text(lines_svg(body, 'width="260mm" height="120mm" viewBox="0 0 260 120"'), encoding="utf-8")
    assert main(["d.svg", "--tile", "-o", "d.csv", *how]) == 0
    told = capsys.readouterr().out
    together: list[FloatArray] = []
    crosses: list[FloatArray] = []
    for trajectory in sorted(Path().glob("d-*.csv")):
        assert f"wrote {trajectory}" in told
        assert main(["check", str(trajectory), "--drawing", "d.svg", "--quiet"]) == 0
        affine = map_of(trajectory)
        back = np.linalg.inv(affine[:, :2])
        scale = np.sqrt(abs(np.linalg.det(affine[:, :2])))
        on_page = [(line - affine[:, 2]) @ back.T for line in ink_of(trajectory)]
        for line in on_page:
            is_cross = np.hypot(*np.ptp(line, axis=0)) * scale == pytest.approx(6.0, abs=0.1)
            (crosses if is_cross else together).append(line)
    largest = 1.0 if "--scale" not in how else 0.8
    assert largest * apart_mm(together, points_of(shapes)) < _OFF_MM
    # Nothing is there twice: but for what both sides of a seam share, as much is drawn as the file has.
    lengths = [sum(np.hypot(*np.diff(line, axis=0).T).sum() for line in some) for some in (together, points_of(shapes))]
    assert lengths[0] == pytest.approx(lengths[1], abs=0.02 * len(together))
    middles = np.array([(line.min(axis=0) + line.max(axis=0)) / 2 for line in crosses])
    apart = np.hypot(*(middles[:, None] - middles[None]).transpose(2, 0, 1)) * largest
    n_together = (apart < 0.05).sum(axis=1)
    assert set(n_together) <= ({4, 8} if not how else {2, 4, 6, 8})  # both strokes, on each sheet that has any ink
    assert ((apart < 0.05) | (apart > 10.0)).all()
