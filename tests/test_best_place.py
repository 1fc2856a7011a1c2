"""`--place best` keeps a drawing's size and its room, is never worse than the page by its own measure, and says what it
wins."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

import planner.best_place
from planner.arms.arm_file import load_arm
from planner.best_place import BestPlace, best_place
from planner.cli import main
from planner.drawing.source import SvgInMemory
from planner.drawing.svg import read_drawing
from planner.execution.context import PlanContext
from planner.execution.workers import ALONE, executor_of
from planner.pipeline import canvas_for, taken
from planner.placement.board import Board
from planner.placement.motions import motions
from planner.placement.place import placed
from planner.progress import unreported
from planner.settings import CanvasKind, PlaceKind, PlanSettings
from planner.trajectory import read_trajectory
from planner.workspace.canvas import Canvas
from tests.drawn_shapes import bezier, ellipse, lines_svg, tap
from tests.placement.test_place import drawing_of

CANVAS = Canvas(CanvasKind.USABLE, 40.0, 120.0, -75.0, 75.0)
PAGE = 'width="100mm" height="60mm" viewBox="0 0 100 60"'
CORNER = lines_svg(
    "".join(
        shape.element for shape in (ellipse(84, 12, 12, 8), tap(70, 5), bezier((75, 3), (90, 30), (99, 0), (76, 22)))
    ),
    PAGE,
)
"""At the top right of the page alone."""
point = st.tuples(st.floats(0.0, 100.0), st.floats(0.0, 60.0))


@hypothesis_settings(max_examples=30)
@given(st.lists(point, min_size=2, max_size=5), st.floats(0.1, 1.5), st.floats(0.0, 20.0))
def test_every_other_place_is_a_turn_and_a_shift_within_the_room(
    points: list[tuple[float, float]], scale: float, margin_mm: float
) -> None:
    drawing = drawing_of(*points)
    settings = PlanSettings(scale=scale, skip_unreachable=True)
    place = placed(drawing, CANVAS, settings)
    for motion in motions(drawing.outlines, place.svg_to_arm, Board(CANVAS, margin_mm, None, None))[::7]:
        turn = motion.matrix[:, :2]
        np.testing.assert_allclose(turn @ turn.T, np.eye(2), atol=1e-12)
        assert np.linalg.det(turn) > 0
        there = placed(drawing, CANVAS, settings, motion)
        assert there.scale == place.scale and there.told.rotate_deg == pytest.approx(
            (motion.turn_deg + 180) % 360 - 180
        )
        ends = np.array(points) @ there.svg_to_arm[:, :2].T + there.svg_to_arm[:, 2]
        assert (ends >= np.array([40.0, -75.0]) + margin_mm - 1e-5).all()
        assert (ends <= np.array([120.0, 75.0]) - margin_mm + 1e-5).all()


def best_of(svg: str, settings: PlanSettings) -> BestPlace:
    context = PlanContext.of(load_arm(settings.arm), settings)
    drawing = read_drawing(SvgInMemory("d.svg", svg.encode()))
    place, pens = taken(placed(drawing, canvas_for(context), settings), context, unreported)
    with executor_of(ALONE) as executor:
        return best_place(executor, context, drawing.outlines, place, pens, unreported)


@pytest.mark.parametrize(("svg", "arm", "scale"), [(CORNER, "so101", 0.6), (CORNER, "scara", 0.6)])
def test_the_best_place_is_never_worse_than_the_page_and_always_the_same(svg: str, arm: str, scale: float) -> None:
    settings = PlanSettings(arm=arm, scale=scale, place=PlaceKind.BEST)
    found = best_of(svg, settings)
    assert found.page is not None and found.best is not None
    assert found.best.against(found.page) <= 1.0
    assert found.motion is not None or found.best == found.page
    assert (found.best.off_mm is None) == (arm == "scara")  # whose file does not say how joints are moved
    again = best_of(svg, settings)
    assert again.told == found.told and again.best == found.best


def test_a_coarse_estimate_that_misleads_does_no_harm(monkeypatch: pytest.MonkeyPatch) -> None:
    """The worst places, taken for the best, are measured and left."""
    estimated = planner.best_place._coarse
    monkeypatch.setattr(planner.best_place, "_coarse", lambda *asked: -estimated(*asked))
    found = best_of(CORNER, PlanSettings(arm="scara", scale=0.6, place=PlaceKind.BEST))
    assert found.motion is None and found.best == found.page


def test_ink_that_the_page_puts_out_of_reach_is_moved_into_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(CORNER, encoding="utf-8")
    how = ["d.svg", "--scale", "2", "-o", "d.csv"]
    assert main([*how, "--place", "page"]) == 3
    capsys.readouterr()
    assert main([*how, "--place", "best"]) == 0
    told = capsys.readouterr().out
    assert "best place: moved by" in told and "where the page puts it, it is out of reach" in told
    assert read_trajectory(Path("d.csv")).placement.scale == 2.0
    assert main(["check", "d.csv", "--drawing", "d.svg", "--quiet"]) == 0


def test_what_is_won_is_told_and_true(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of a drawing so small that all of it is measured, the times are those of the plans."""
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(CORNER, encoding="utf-8")
    found = best_of(CORNER, PlanSettings(arm="so101", place=PlaceKind.BEST, scale=0.6))
    durations = []
    for kind in ("page", "best"):
        assert main(["d.svg", "--arm", "so101", "--scale", "0.6", "--place", kind, "-o", f"{kind}.csv"]) == 0
        durations.append(read_trajectory(Path(f"{kind}.csv")).duration_s)
        assert main(["check", f"{kind}.csv", "--drawing", "d.svg", "--quiet"]) == 0
    assert found.told in capsys.readouterr().out
    assert found.page is not None and found.best is not None
    np.testing.assert_allclose(durations, [found.page.duration_s, found.best.duration_s], atol=0.05)


@pytest.mark.parametrize("options", [["--at", "1", "2"], ["--align", "top"], ["--copies", "2x1"], ["--tile"]])
def test_what_says_where_a_drawing_goes_contradicts_the_best_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(CORNER, encoding="utf-8")
    assert main(["d.svg", "--place", "best", *options]) == 2
    told = capsys.readouterr().err
    assert "place best" in told and options[0].removeprefix("--") in told and told.count("\n") == 1
