"""Pen targets joined by Ruckig: the customer's plain way to draw, with every promise of a trajectory kept."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.checking.check import check_trajectory
from planner.drawing.svg import read_drawing
from planner.errors import TrajectoryFileError
from planner.inverse_kinematics.references import references_of
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath
from planner.kinematics.limits import Limits
from planner.motion.timed_stroke import TimedStroke
from planner.pipeline import plan
from planner.progress import unreported
from planner.settings import Method, PlanSettings, Timing
from planner.trajectory import Trajectory
from planner.travel.joined_targets import joined_strokes
from tests.arms.chains import load_once, model_of
from tests.drawn_shapes import bezier, ellipse, polyline, svg_of, tap
from tests.timing.rig import share_of_limits

SHAPES = [
    ellipse(50, 50, 45, 40),
    bezier((25, 65), (35, 85), (65, 85), (75, 65)),
    tap(35, 40),
    polyline((5, 5), (95, 9)),
]


def drawn(folder: Path, arm: str, timing: Timing) -> Trajectory:
    file = folder / "face.svg"
    file.write_text(svg_of(SHAPES), encoding="utf-8")
    wanted = PlanSettings(arm=arm, timing=timing, scale=0.2, rate_hz=100.0)
    made = plan(file, wanted, unreported).trajectory
    verdict = check_trajectory(made, load_once(arm), read_drawing(file))
    assert verdict.passed, str(verdict)
    return made


@pytest.mark.parametrize("arm", ["drawing_arm", "scara", "so101"])
def test_every_promise_is_kept_and_the_least_time_is_less(tmp_path: Path, arm: str) -> None:
    joined, least = (drawn(tmp_path, arm, timing) for timing in (Timing.RUCKIG, Timing.OPTIMAL))
    assert least.duration_s < joined.duration_s


def test_the_file_says_how_it_was_timed(tmp_path: Path) -> None:
    file = tmp_path / "joined.csv"
    drawn(tmp_path, "drawing_arm", Timing.RUCKIG).save(file)
    assert "# timing: ruckig\n" in file.read_text()
    assert Trajectory.load(file).timing is Timing.RUCKIG
    file.write_text(file.read_text().replace("# timing: ruckig", "# timing: quick"))
    with pytest.raises(TrajectoryFileError, match=r"timing.*'quick'; wanted optimal or ruckig"):
        Trajectory.load(file)


def stroke_by(method: Method, stroke: FloatArray, wanted: PlanSettings) -> TimedStroke | InfeasiblePath:
    model = model_of(load_once(wanted.arm))
    return joined_strokes(model, references_of(model, method), wanted, [stroke])[0]


places = st.tuples(st.floats(50.0, 110.0), st.floats(-60.0, 60.0))


@settings(deadline=None, max_examples=10)
@given(
    stroke=st.lists(places, min_size=2, max_size=5, unique=True).map(np.array),
    tolerance_mm=st.sampled_from([0.02, 0.05, 0.5]),
    rate_hz=st.sampled_from([50.0, 100.0, 1000.0]),
)
def test_joints_go_straight_from_rest_to_rest_within_limits_and_tolerance(
    stroke: FloatArray, tolerance_mm: float, rate_hz: float
) -> None:
    arm = load_once("drawing_arm")
    wanted = PlanSettings(tolerance_mm=tolerance_mm, rate_hz=rate_hz)
    made = stroke_by(Method.PATH, stroke, wanted)
    assert isinstance(made, TimedStroke)
    held = np.concatenate((made.joints[:1],) * 3 + (made.joints,) + (made.joints[-1:],) * 3)
    assert (share_of_limits(held, 1 / rate_hz, Limits.of(arm)) <= 1.001).all()
    kinematics = model_of(arm).kinematics
    between = np.concatenate([made.joints, 0.5 * (made.joints[1:] + made.joints[:-1])])
    tips = kinematics.tip_mm(kinematics.independent_of(between))
    assert np.abs(tips[:, 2]).max() <= 0.5 * tolerance_mm + 1e-6
    off = np.min([distance(tips[:, :2], *line) for line in pairwise(stroke)], axis=0)
    assert off.max() <= 0.95 * tolerance_mm
    for end, tip in ((stroke[0], made.joints[0]), (stroke[-1], made.joints[-1])):
        np.testing.assert_allclose(kinematics.tip_mm(kinematics.independent_of(tip[None]))[0, :2], end, atol=1e-6)


def distance(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    along = end - start
    share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
    found: FloatArray = np.linalg.norm(points - start - share[:, None] * along, axis=1)
    return found


@pytest.mark.parametrize("method", list(Method))
def test_targets_come_from_every_method(method: Method) -> None:
    made = stroke_by(method, np.array([[70.0, -20.0], [90.0, 20.0]]), PlanSettings())
    assert isinstance(made, TimedStroke)


def test_a_place_out_of_reach_is_told() -> None:
    made = stroke_by(Method.PATH, np.array([[70.0, 0.0], [900.0, 0.0]]), PlanSettings())
    assert isinstance(made, InfeasiblePath) and "reach" in made.reason


def test_the_pen_keeps_to_its_speed_and_more_tolerance_takes_no_longer() -> None:
    angle = np.linspace(0.0, 6.0, 200)
    stroke = np.column_stack((80.0 + 20.0 * np.cos(angle), 20.0 * np.sin(angle)))
    model = model_of(load_once("drawing_arm"))
    times = []
    for tolerance_mm in (0.01, 0.02, 0.05, 0.1, 0.3, 1.0):
        wanted = PlanSettings(tolerance_mm=tolerance_mm, speed_mm_s=10.0, rate_hz=1000.0)
        made = stroke_by(Method.PATH, stroke, wanted)
        assert isinstance(made, TimedStroke)
        tips = model.kinematics.tip_mm(model.kinematics.independent_of(made.joints))
        assert np.linalg.norm(np.diff(tips, axis=0), axis=1).max() * wanted.rate_hz <= 10.0 * 1.001
        times.append(len(made.joints))
    assert times == sorted(times, reverse=True)
    assert replace(PlanSettings(), timing="ruckig").timing is Timing.RUCKIG  # type: ignore[arg-type]  # by its name
