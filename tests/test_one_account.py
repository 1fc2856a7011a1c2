"""A figure has one value wherever it is told: on the screen, in the estimate, on the report's page and on pictures."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from planner.cli import main
from planner.pictures import PlotKind, figure_of
from planner.plots.look import USUAL
from planner.trajectory import read_trajectory
from tests.arms.chains import load_once
from tests.drawn_shapes import lines_svg
from tests.report.test_markup import Reader

BODY = (
    '<path d="M2 2 5 4 40 9M7 7l1 0"/><path stroke="#0000ff" d="M60 10v30M70 20h0M20 30c9 9 20-20 30 3"/>'
    '<path stroke="#cc0000" d="M10 40h30"/>'
)


KINDS = (PlotKind.DRAWING, PlotKind.SPEED, PlotKind.TIMELINE, PlotKind.SHEET)


def test_lengths_speeds_and_times_are_the_same_everywhere(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("planner.report.pictures.write_figure", lambda *_: None)  # pixels tell no figures
    drawing, target, report = tmp_path / "d.svg", tmp_path / "t.csv", tmp_path / "report"
    drawing.write_text(lines_svg(BODY, 'viewBox="0 0 80 50"'))
    planning = [str(drawing), "--by", "colour", "--dwell", "0.3"]
    assert main([*planning, "-o", str(target), "--report", str(report)]) == 0
    screen = capsys.readouterr().out
    amount = re.search(r"^\d+ strokes.*travelled pen up$", screen, re.MULTILINE)
    speed = re.search(r"\d+ mm/s on paper in the mean", screen)
    takes = re.search(r"takes (.*?) \(", screen)
    phases = dict(re.findall(r"(\w+) ([\d.]+ s \(\d+ %\))", screen))
    assert amount and speed and takes and len(phases) == 5
    drawn, travelled = re.findall(r"[\d.]+ m\b", amount[0])

    assert main(["estimate", *planning]) == 0
    row = capsys.readouterr().out.splitlines()[1]
    assert drawn in row and takes[1] in row

    trajectory, arm = read_trajectory(target), load_once("drawing_arm")
    told = {kind: _texts(figure_of(trajectory, arm, kind, USUAL)) for kind in KINDS}
    assert any(text.startswith(amount[0]) and takes[1] in text for text in told[PlotKind.DRAWING])
    assert any(text.startswith(speed[0]) for text in told[PlotKind.SPEED])
    assert {f"{words.split(' (')[0]}, {words.split('(')[1].rstrip(')')}" for words in phases.values()} <= set(
        told[PlotKind.TIMELINE]
    )
    inks = [float(text.split(", ")[-1].removesuffix(" m")) for text in told[PlotKind.SHEET] if text.startswith("#")]
    assert len(inks) == 3 and sum(inks) == pytest.approx(float(drawn.removesuffix(" m")), abs=0.016)

    page = Reader((report / "index.html").read_text(encoding="utf-8")).text
    facts = {term: page[place + 1] for place, term in reversed([*enumerate(page[:-1])])}  # where it comes first
    assert (facts["takes"], facts["drawn"], facts["travelled, pen up"]) == (takes[1], drawn, travelled)
    assert facts["mean speed on paper"] == speed[0].removesuffix(" on paper in the mean")
    assert facts["strokes"] == amount[0].split()[0]
    for name, words in phases.items():
        assert f"{facts[name]} ({page[page.index(name) + 2]})" == words


def _texts(figure: Figure) -> list[str]:
    legends = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    return [
        text.get_text() for texts in (figure.texts, *(axes.texts for axes in figure.axes)) for text in texts
    ] + legends
