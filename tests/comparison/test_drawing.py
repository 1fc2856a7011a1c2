"""A drawing from its file to table, JSON and picture."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from planner.cli import main
from planner.comparison.drawing_time import stroke_times
from planner.pipeline import placed_strokes, plan
from planner.settings import Method, PlanSettings
from tests.arms.chains import load_once, model_of

SVG = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 20">
<g fill="none" stroke="black" stroke-linecap="round"><path d="M4 4 12 16 20 4M24 4q6 14 12 0"/>
<circle cx="12" cy="5" r="3"/><path d="M30 16h0"/></g></svg>"""


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    path = tmp_path / "small.svg"
    path.write_text(SVG)
    return path


def test_a_drawing_end_to_end(drawing: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target, picture = drawing.with_name("small.json"), drawing.with_name("small.png")
    options = ["--arm", "scara", "--margin", "25mm", "--speed", "40"]
    assert main(["compare", str(drawing), *options, "--json", str(target), "--plot", str(picture), "--quiet"]) == 0
    shown = capsys.readouterr()
    assert shown.err == "" and shown.out.startswith("scara: ")
    assert picture.read_bytes().startswith(b"\x89PNG")
    found = json.loads(target.read_text())
    assert found["targets"]["kind"] == "drawing" and found["convergence"] is None
    by_name = {method["method"]: method for method in found["methods"]}
    assert all(method["solved_share"] == 1.0 and method["postures"] is None for method in found["methods"])
    assert by_name["dls"]["drawing_s"] is None and by_name["dls"]["strokes_refused"] is None
    assert by_name["dls-drawing"]["repeat_deg"] > 1e-3 > by_name["path"]["repeat_deg"]
    for name, method in (("path", Method.PATH), ("dls-drawing", Method.DLS)):
        settings = PlanSettings(arm="scara", method=method, margin_mm=25.0, speed_mm_s=40.0)
        drawn = plan(drawing, settings, lambda *_: None).summary
        assert by_name[name]["drawing_s"] == pytest.approx(drawn.phases.drawing_s)
        assert by_name[name]["strokes_refused"] == 0
        assert by_name[name]["drawing_common_s"] == by_name[name]["drawing_s"]
        assert f"along {drawn.n_strokes} strokes" in shown.out


def test_strokes_that_a_method_is_refused_are_counted_with_the_reason() -> None:
    arm = load_once("scara")
    inside, outside = np.array([[120.0, 0.0], [130.0, 10.0]]), np.array([[190.0, 0.0], [280.0, 0.0]])
    times = stroke_times(model_of(arm), [inside, outside, inside], PlanSettings(arm="scara"))
    assert np.isnan(times.seconds).tolist() == [False, True, False]
    assert times.seconds[0] == times.seconds[2] > 0
    assert len(times.infeasible_paths) == 1


def test_a_drawing_is_placed_as_plan_places_it(drawing: Path) -> None:
    settings = PlanSettings(arm="scara", rotate_deg=90.0, margin_mm=20.0)
    strokes, warnings = placed_strokes(drawing, model_of(load_once("scara")), settings)
    trajectory = plan(drawing, settings, lambda *_: None).trajectory
    assert warnings == [] and len(strokes) == int(trajectory.stroke.max()) + 1
    a, b, c, d, e, f = trajectory.svg_to_arm_mm
    corner = np.array([a * 12 + c * 16 + e, b * 12 + d * 16 + f])
    assert min(float(np.hypot(*(stroke - corner).T).min()) for stroke in strokes) < 1e-6
