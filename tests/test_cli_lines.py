"""`plan lines`: what would be drawn, as plain lines on the page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import shapely

from planner.cli import main
from planner.drawing.svg import read_drawing

SVG = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
 width="50mm" height="40mm" viewBox="0 0 100 80" fill="none" stroke="#0a0b0c">
<rect width="100" height="80" fill="#fff" stroke="none"/>
<g inkscape:groupmode="layer" inkscape:label="Red &amp; &lt;thin&gt;"><path d="M10 10H190" stroke="red"/></g>
<circle cx="50" cy="40" r="20"/>
<path d="M20 20h0" stroke-linecap="round"/>
<g inkscape:groupmode="layer" inkscape:label="Red &amp; &lt;thin&gt;"><path d="M10 12h5" stroke="red"/></g>
<rect x="40" y="5" width="20" height="15" fill="blue" stroke="none"/></svg>"""


@pytest.fixture
def drawing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    file = Path("drawing.svg")
    file.write_text(SVG, encoding="utf-8")
    return file


def told(capfd: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    assert main(["lines", *arguments, "--json", "-"]) == 0
    found: dict[str, Any] = json.loads(capfd.readouterr().out)
    return found


def test_lines_are_in_millimetres_on_the_page(drawing: Path, capfd: pytest.CaptureFixture[str]) -> None:
    found = told(capfd, str(drawing))
    assert found["page_mm"] == [50.0, 40.0]
    red, circle, tap, other_red, blue = found["lines"]
    assert red == {"points": [[5.0, 5.0], [50.0, 5.0]], "layer": "Red & <thin>", "colour": "#ff0000"}
    assert tap == {"points": [[10.0, 10.0]], "layer": "", "colour": "#0a0b0c"}
    assert other_red["layer"] == "Red & <thin>"
    assert (blue["colour"], len(blue["points"])) == ("#0000ff", 5)
    off = np.abs(np.hypot(*(np.array(circle["points"]) - (25.0, 20.0)).T) - 10.0)
    assert off.max() < 0.005
    assert found["skipped"] == {"background": 1, "ink beyond the page": 1}


def test_the_tolerance_is_that_of_curves(drawing: Path, capfd: pytest.CaptureFixture[str]) -> None:
    coarse, fine = (told(capfd, str(drawing), "--tolerance", size)["lines"][1]["points"] for size in ("0.5", "0.0005"))
    assert len(coarse) < 20 < 100 < len(fine)


def test_how_it_is_read_is_asked_for(drawing: Path, capfd: pytest.CaptureFixture[str]) -> None:
    whole = told(capfd, str(drawing), "--crop", "none")
    assert whole["lines"][0]["points"][-1] == [95.0, 5.0]
    assert "ink beyond the page" not in whole["skipped"]
    seen = told(capfd, str(drawing), "--occlude")
    assert [line["points"] for line in seen["lines"][:2]] == [[[5.0, 5.0], [20.0, 5.0]], [[30.0, 5.0], [50.0, 5.0]]]


def test_the_svg_is_the_same_drawing(drawing: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["lines", str(drawing), "-o", "lines.svg"]) == 0
    captured = capfd.readouterr()
    assert "4 lines and 1 tap on a page of 50 x 40 mm" in captured.out
    assert "1 background, 1 ink beyond the page" in captured.err
    again = told(capfd, "lines.svg")
    first = told(capfd, str(drawing))
    layers = {line["layer"] for line in again["lines"]}
    assert layers == {"", "Red & <thin>"}
    for layer in layers:  # a group for each
        mine, theirs = ([line for line in one["lines"] if line["layer"] == layer] for one in (first, again))
        assert [line["colour"] for line in mine] == [line["colour"] for line in theirs]
        for one, other in zip(mine, theirs, strict=True):
            np.testing.assert_allclose(one["points"], other["points"], atol=2e-6)
    root = ElementTree.parse("lines.svg").getroot()
    assert len([element for element in root if element.tag.endswith("}g")]) == 2
    assert read_drawing(Path("lines.svg")).page_mm == pytest.approx((50.0, 40.0))


def test_the_same_drawing_makes_the_same_bytes(drawing: Path) -> None:
    for name in ("a", "b"):
        assert main(["lines", str(drawing), "-o", f"{name}.svg", "--json", f"{name}.json", "--quiet"]) == 0
    assert Path("a.svg").read_bytes() == Path("b.svg").read_bytes()
    assert Path("a.json").read_bytes() == Path("b.json").read_bytes()


def test_dashes_are_lines_and_gaps_are_none(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "dashed.svg"
    file.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="10mm" viewBox="0 0 100 10">'
        '<path d="M0 5H100" stroke="#000" stroke-dasharray="1 .2" stroke-dashoffset=".5"/></svg>'
    )
    lines = shapely.MultiLineString([line["points"] for line in told(capfd, str(file))["lines"]])
    assert lines.length == pytest.approx(100 / 1.2, abs=0.5)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["drawing.svg"], "-o FILE.svg or --json FILE says where the lines go"),
        (["drawing.svg", "-o", "a", "--json", "a"], "-o and --json name the same file, a"),
        (["drawing.svg", "-o", "drawing.svg"], "it is what is being read"),
        (["nothing.svg", "-o", "a"], "nothing.svg"),
        (["drawing.svg", "-o", "a", "--font", "b"], "a font file goes with text"),
        (["drawing.svg", "-o", "a", "--tolerance", "0"], "'0' has to be positive"),
    ],
)
def test_errors_are_one_line(
    arguments: list[str], message: str, drawing: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(["lines", *arguments]) == 2
    captured = capfd.readouterr()
    assert message in captured.err
    assert len(captured.err.splitlines()) == 1
    assert captured.out == ""
    assert not Path("a").exists()


@pytest.mark.parametrize(
    ("content", "arguments", "advice"),
    [
        ('<path stroke="red" d="M60 60h20"/>', [], "all of it is beyond the page: draw it with --crop none"),
        ('<text y="20">a</text>', ["--text", "skip"], "draw text with --text single or outline"),
    ],
)
def test_where_nothing_is_left_the_option_is_named(
    content: str, arguments: list[str], advice: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "empty.svg"
    file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 50 50">{content}</svg>')
    assert main(["lines", str(file), "--json", "-", *arguments]) == 2
    assert advice in capfd.readouterr().err


def test_a_plan_is_checked_and_shown_by_what_was_read(drawing: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main([str(drawing), "-o", "traj.csv", "--crop", "none", "--place", "ink", "--occlude", "--quiet"]) == 0
    assert "# crop: none\n# occlude: yes\n" in Path("traj.csv").read_text(encoding="utf-8")
    assert main(["check", "traj.csv", "--drawing", str(drawing), "--quiet"]) == 0
    other = Path("traj.csv").read_text(encoding="utf-8").replace("# crop: none\n", "")
    Path("other.csv").write_text(other, encoding="utf-8")
    capfd.readouterr()
    assert main(["check", "other.csv", "--drawing", str(drawing), "--quiet"]) == 1
    assert "nothing extra" in capfd.readouterr().out


def test_short_gaps_are_told_and_drawn(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "dashed.svg"
    file.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="10mm" viewBox="0 0 40 10" stroke="#000">'
        '<path d="M0 2H39" stroke-dasharray="3 .3"/><path d="M0 8H39" stroke-dasharray="5 2"/></svg>'
    )
    target = tmp_path / "traj.csv"
    assert main([str(file), "-o", str(target), "--no-fit"]) == 0
    captured = capfd.readouterr()
    assert "gaps of dashes under 0.5 mm on paper, drawn solid: 11" in captured.err
    assert "7 strokes" in captured.out
    assert main(["check", str(target), "--drawing", str(file), "--quiet"]) == 0
