"""What does not reach its tolerance, or its end, after its rounds is told with the plan, or refused."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from planner.drawing.options import ReadingOptions
from planner.errors import PlanError
from planner.kinematics.limits import Limits
from planner.motion.timed_stroke import Contact
from planner.pipeline import plan
from planner.placement.tube import Tube
from planner.settings import CanvasKind, PlaceKind, PlanSettings
from planner.travel import travel_moves
from planner.travel.branch_change import plan_branch_change
from planner.travel.travel_moves import TravelRules
from planner.workspace.canvas import canvas_of
from tests.arms.chains import kinematics_of, load_once, model_of
from tests.drawn_shapes import lines_svg

OFF_THE_DRAWING = "off the drawing by more than the tolerance, however slow; try a larger --tolerance: "
STRAYING = "the lifted pen strays by more than the tolerance, however slow; try a larger --tolerance: "
WAVE = '<path d="M20 40 q3 3 6 0 t6 0"/>'
WAVE_AND_HOOK = '<path d="M20 40 q3 3 6 0 t6 0 t6 0 t6 0"/><path d="M10 10 L60 12 L80 50 L80 10"/>'


def dashes(count: int) -> str:
    random = np.random.default_rng(3)
    rows = np.column_stack(
        (random.uniform(0, 90, (count, 1)), random.uniform(0, 50, (count, 1)), random.uniform(-8, 8, (count, 2)))
    )
    return "".join(f'<path d="M{x:.1f} {y:.1f} l{dx:.1f} {dy:.1f}"/>' for x, y, dx, dy in rows.tolist())


def warnings_of(folder: Path, paths: str, rate_hz: float = 100.0, tolerance_mm: float = 0.05) -> list[str]:
    drawing = folder / "drawing.svg"
    drawing.write_text(lines_svg(f"{paths}", 'width="100mm" height="60mm" viewBox="0 0 100 60"'))
    return plan(
        drawing,
        PlanSettings(
            rate_hz=rate_hz, tolerance_mm=tolerance_mm, place=PlaceKind.INK, reading=ReadingOptions(crop="none")
        ),
        lambda *_: None,
    ).summary.warnings


def test_a_pen_path_that_is_not_refined_to_the_end_is_off_the_drawing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("planner.pen_drawing._HALVINGS", 1)  # what does not help is tried once
    assert warnings_of(tmp_path, WAVE, tolerance_mm=0.1) == []
    monkeypatch.setattr("planner.placement.pen_path._ROUNDS", 1)
    monkeypatch.setattr("planner.placement.pen_path._approach", lambda *_: None)
    around = Tube.around
    monkeypatch.setattr(Tube, "around", lambda line, paths, radius_mm: around(line, paths, 4.0 * radius_mm))
    (told,) = warnings_of(tmp_path, WAVE, tolerance_mm=0.1)
    assert told.startswith(OFF_THE_DRAWING)


def test_a_stroke_that_is_not_slowed_to_the_end_is_off_the_drawing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert warnings_of(tmp_path, WAVE_AND_HOOK, rate_hz=50.0, tolerance_mm=0.01) == []
    monkeypatch.setattr("planner.motion.held_motion._ROUNDS", 1)
    assert warnings_of(tmp_path, WAVE_AND_HOOK, rate_hz=50.0, tolerance_mm=0.01) == [OFF_THE_DRAWING + "2 strokes"]


def test_pen_up_moves_that_slowing_does_not_help_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert warnings_of(tmp_path, WAVE_AND_HOOK, rate_hz=50.0, tolerance_mm=0.01) == []
    monkeypatch.setattr(travel_moves, "_HELPED", 1e-9)
    (told,) = warnings_of(tmp_path, WAVE_AND_HOOK, rate_hz=50.0, tolerance_mm=0.01)
    assert re.fullmatch(re.escape(STRAYING) + "[1-3] pen-up moves?", told)


def test_a_change_of_branch_strays_where_its_way_up_or_down_does(monkeypatch: pytest.MonkeyPatch) -> None:
    arm = load_once("drawing_arm")
    tips = np.array([[60.0, -50.0], [110.0, 40.0]])
    configurations, _ = model_of(arm).configuration_map().configurations_at(np.column_stack((tips, np.zeros(2))))
    start, end = map(Contact, tips, configurations)
    rules = TravelRules(1.0, 5.0, 30.0, 20.0, 0.05)
    assert plan_branch_change(kinematics_of(arm), Limits.of(arm), rules, start, end).held
    monkeypatch.setattr(travel_moves, "_HELPED", 1e-9)
    assert not plan_branch_change(kinematics_of(arm), Limits.of(arm), rules, start, end).held


@pytest.mark.parametrize(("limit", "value"), [("_ROUNDS", 1), ("_WORK_LIMIT", 0)])
def test_an_order_that_is_not_searched_to_the_end_is_told(
    limit: str, value: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert warnings_of(tmp_path, dashes(40)) == []
    monkeypatch.setattr(f"planner.drawing.tour.{limit}", value)
    (told,) = warnings_of(tmp_path, dashes(40))
    assert re.fullmatch("a shorter way between the strokes may be left: 40 are too many to search to the end", told)


def test_a_canvas_by_a_reach_that_is_not_found_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    arm = replace(load_once("drawing_arm"), name="another")
    monkeypatch.setattr("planner.workspace.canvas._MOST_ITERATIONS", 0)
    with pytest.raises(PlanError, match=r"arm another: .* try --canvas usable"):
        canvas_of(model_of(arm), CanvasKind.OPTIMAL, 5.0)
