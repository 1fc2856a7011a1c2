"""From SVG to trajectory, end to end: what every trajectory promises, found again by plain formulas."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings

from planner import pen_drawing
from planner.arms.accuracy import Accuracy
from planner.arms.arm_file import arms_folder
from planner.arms.usual_settings import usual_clearance_mm
from planner.arrays import FloatArray
from planner.checking.check import check_trajectory
from planner.drawing.metric import Metric
from planner.drawing.options import ReadingOptions
from planner.drawing.order import order_strokes, travel
from planner.drawing.svg import read_drawing
from planner.errors import DoesNotFit, DrawingError, TargetOutOfReach, UnknownArm, UsageError
from planner.execution import work_chunks
from planner.head import LeftOut
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath
from planner.motion.timed_stroke import TimedStroke
from planner.pipeline import Plan, placed_strokes, plan
from planner.placement import pieces
from planner.settings import CanvasKind, Method, PlaceKind, PlanSettings
from planner.timing.length_bound import require_bounded
from planner.trajectory import TRAVELLING, Trajectory, write_trajectory
from planner.travel.travel_time_metric import travel_time_metric
from planner.workspace.canvas import canvas_of
from tests.arms.chains import DRAWING_ARMS, load_once, model_of
from tests.checking.scribbles import random_drawing
from tests.drawing.stroke_sets import STROKE_SETS
from tests.drawn_shapes import Shape, bezier, drawings_made, ellipse, polyline, svg_of, tap

TOLERANCE_MM = 0.05
FACE = [
    ellipse(50, 50, 45, 40),
    bezier((25, 65), (35, 85), (65, 85), (75, 65)),
    tap(35, 40),
    tap(65, 40),
    polyline((50, 45), (45, 58), (54, 57.5), (45, 58)),
]


def unheard(stage: str, done: int, total: int) -> None:
    """Progress that nobody looks at."""


ALL_OF_IT = ReadingOptions(crop="none")


def planned(folder: Path, shapes: list[Shape], wanted: PlanSettings, attributes: str = 'viewBox="0 0 100 100"') -> Plan:
    file = folder / "drawing.svg"
    file.write_text(svg_of(shapes, attributes), encoding="utf-8")
    return plan(file, replace(wanted, place=PlaceKind.INK, reading=ALL_OF_IT), unheard)


@lru_cache
def arm_table(name: str) -> dict[str, Any]:
    return tomllib.loads((arms_folder() / f"{name}.toml").read_text(encoding="utf-8"))


def tips_by_formula(table: dict[str, Any], joints_deg: FloatArray) -> FloatArray:
    """(n, 3) tips of the drawing arm: a turning base, four parallel joints, the pen beside their plane."""
    base, *links = table["joints"]
    azimuth, *turns = np.radians(joints_deg).T
    pitch = np.cumsum(turns, axis=0)
    lengths = np.array([link["a_mm"] for link in links])
    beside = sum(link["d_mm"] for link in links)
    radius, height = lengths @ np.cos(pitch), base["d_mm"] + lengths @ np.sin(pitch)
    return np.column_stack(
        (
            radius * np.cos(azimuth) + beside * np.sin(azimuth),
            radius * np.sin(azimuth) - beside * np.cos(azimuth),
            height,
        )
    )


def runs(trajectory: Trajectory, tips_mm: FloatArray) -> list[FloatArray]:
    """The tips of every stroke."""
    strokes = trajectory.stroke
    return [tips_mm[strokes == index] for index in range(int(strokes.max()) + 1)]


def furthest_mm(points: FloatArray, lines: list[FloatArray]) -> float:
    """Largest distance from any of the points to the nearest of the lines."""
    pieces = [np.stack((line[:-1], line[1:]) if len(line) > 1 else (line, line), axis=1) for line in lines]
    tree = shapely.STRtree(shapely.linestrings(np.concatenate(pieces)))
    _, nearest = tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
    assert len(nearest) == len(points)
    return float(nearest.max())


def placed(trajectory: Trajectory, shapes: list[Shape]) -> list[FloatArray]:
    a, b, c, d, e, f = trajectory.svg_to_arm_mm
    return [np.column_stack((a * u + c * v + e, b * u + d * v + f)) for u, v in (shape.points.T for shape in shapes)]


def assert_keeps_its_promises(trajectory: Trajectory, shapes: list[Shape], arm_name: str = "drawing_arm") -> None:
    """Every promise by plain formulas on the samples; made for a rate ten times the usual one."""
    table = arm_table(arm_name)
    q, period = trajectory.positions, 1 / trajectory.rate_hz
    for order, key in enumerate(("velocity_deg_s", "acceleration_deg_s2", "jerk_deg_s3"), 1):
        limit = np.array([joint[f"max_{key}"] for joint in table["joints"]])
        held = np.concatenate((q[:1],) * 3 + (q,) + (q[-1:],) * 3)  # at rest before and after
        assert (np.abs(np.diff(held, order, axis=0)) / period**order <= limit * 1.0005).all(), key
    assert (q >= np.array([joint["min_deg"] for joint in table["joints"]]) - 1e-6).all()
    assert (q <= np.array([joint["max_deg"] for joint in table["joints"]]) + 1e-6).all()
    assert np.abs(q[:, 1:].sum(axis=1) + 90.0).max() <= 1e-4
    tips = tips_by_formula(table, q)
    assert np.abs(tips[trajectory.pen, 2]).max() <= 0.01
    assert tips[:, 2].min() >= -0.01 and tips[:, 2].max() <= table["pen"]["lift_mm"] + 0.01
    np.testing.assert_array_equal(trajectory.pen, trajectory.stroke != TRAVELLING)
    near = np.flatnonzero(~trajectory.pen & (tips[:, 2] < table["pen"]["clearance_mm"]))
    down = np.flatnonzero(trajectory.pen)
    after = np.clip(np.searchsorted(down, near), 1, len(down) - 1)
    sideways = np.minimum(*(np.hypot(*(tips[near] - tips[down[index]])[:, :2].T) for index in (after - 1, after)))
    assert sideways.max() <= 0.01
    drawn = [line[:, :2] for line in runs(trajectory, tips)]
    wanted = placed(trajectory, shapes)
    assert furthest_mm(np.concatenate(drawn), wanted) <= TOLERANCE_MM
    assert furthest_mm(np.concatenate(wanted), drawn) <= TOLERANCE_MM


def assert_checked(trajectory: Trajectory, folder: Path, arm_name: str = "drawing_arm") -> None:
    check_result = check_trajectory(
        trajectory, load_once(arm_name), read_drawing(folder / "drawing.svg", options=ALL_OF_IT)
    )
    assert check_result.passed, check_result.text()


@settings(deadline=None, max_examples=5, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(drawings_made)
def test_any_drawing_is_drawn_as_promised(tmp_path: Path, shapes: list[Shape]) -> None:
    assert_checked(planned(tmp_path, shapes, PlanSettings()).trajectory, tmp_path)
    assert_keeps_its_promises(planned(tmp_path, shapes, PlanSettings(rate_hz=1000.0)).trajectory, shapes)


@pytest.mark.parametrize("arm_name", DRAWING_ARMS)
@pytest.mark.parametrize("method", list(Method))
def test_every_method_draws_with_both_arms(tmp_path: Path, method: Method, arm_name: str) -> None:
    wanted = PlanSettings(arm=arm_name, method=method, rate_hz=500.0)
    trajectory = planned(tmp_path, FACE, wanted).trajectory
    assert trajectory.method == method.value and trajectory.arm == arm_name
    assert_checked(trajectory, tmp_path, arm_name)
    assert_keeps_its_promises(trajectory, FACE, arm_name)


@pytest.mark.parametrize("canvas", CanvasKind)
@pytest.mark.parametrize("rotate_deg", [0.0, 90.0, 33.0])
def test_drawings_fill_their_canvas(tmp_path: Path, canvas: CanvasKind, rotate_deg: float) -> None:
    """The documents' canvas and the largest of its kind have far corners where the arm is stretched out: a round
    drawing in the middle stays clear of them."""
    arm = load_once("drawing_arm")
    wanted = PlanSettings(canvas=canvas, rotate_deg=rotate_deg, margin_mm=8.0, place=PlaceKind.INK)
    result = planned(tmp_path, [ellipse(30, 30, 20, 20)], wanted)
    where = canvas_of(model_of(arm), canvas, arm.pen.lift_mm)
    ((x, y),) = (line.T for line in placed(result.trajectory, [ellipse(30, 30, 20, 20)]))
    np.testing.assert_allclose(
        [(x.min() + x.max()) / 2, (y.min() + y.max()) / 2],
        [(where.near_mm + where.far_mm) / 2, (where.left_mm + where.right_mm) / 2],
        atol=0.05,
    )
    room = min(where.width_mm, where.height_mm) - 16
    np.testing.assert_allclose([np.ptp(x), np.ptp(y), *result.summary.size_mm], room, atol=0.05)
    assert_checked(result.trajectory, tmp_path)


@pytest.mark.parametrize(
    "attributes",
    [
        'viewBox="-10 20 100 50" width="60mm" height="40mm"',
        'width="50mm" height="2in"',
        "",
        'viewBox="0 0 200 200" preserveAspectRatio="none" width="3cm" height="2cm"',
    ],
)
def test_svg_to_arm_mm_says_where_the_pen_is(tmp_path: Path, attributes: str) -> None:
    """Three taps at known places of the SVG; at true size, the page's millimetres are the paper's."""
    shapes = [tap(10, 30), tap(60, 30), tap(10, 50)]
    result = planned(tmp_path, shapes, PlanSettings(fit=False), attributes)
    drawn = np.array(
        [
            line[0, :2]
            for line in runs(result.trajectory, tips_by_formula(arm_table("drawing_arm"), result.trajectory.positions))
        ]
    )
    wanted = np.concatenate(placed(result.trajectory, shapes))
    gaps = np.hypot(*(wanted[:, None] - drawn).T)
    assert gaps.min(axis=0).max() < 1e-6 and gaps.min(axis=1).max() < 1e-6
    origin, across, down = wanted
    assert across[1] < origin[1] and down[0] < origin[0]  # to the right of the arm, and towards it
    per_unit = read_drawing(tmp_path / "drawing.svg").user_to_page
    np.testing.assert_allclose(
        [origin[1] - across[1], origin[0] - down[0]], [50 * per_unit[0, 0], 20 * per_unit[1, 1]], rtol=1e-9
    )
    assert result.summary.scale == 1.0


def test_what_does_not_fit_is_an_error(tmp_path: Path) -> None:
    shapes = [polyline((0, 0), (300, 10))]
    with pytest.raises(DoesNotFit):
        planned(tmp_path, shapes, PlanSettings(fit=False), 'width="300mm" height="300mm" viewBox="0 0 300 300"')
    with pytest.raises(UsageError, match="margin"):
        planned(tmp_path, shapes, PlanSettings(margin_mm=80.0))
    with pytest.raises(UsageError, match="lift"):
        planned(tmp_path, shapes, PlanSettings(lift_mm=0.2))
    with pytest.raises(UnknownArm):
        planned(tmp_path, shapes, PlanSettings(arm="no_such_arm"))
    with pytest.raises(DrawingError):
        planned(tmp_path, [], PlanSettings())


def test_what_is_out_of_reach_is_named_or_left_out(tmp_path: Path) -> None:
    """An arm that turns by 35 degrees only does not get to the sides of the largest canvas of its kind."""
    text = (arms_folder() / "drawing_arm.toml").read_text(encoding="utf-8")
    narrow = text.replace("min_deg = -90.0\nmax_deg = 90.0", "min_deg = -35.0\nmax_deg = 35.0")
    file = tmp_path / "narrow.toml"
    file.write_text(narrow, encoding="utf-8")
    frame = polyline((0, 0), (200, 0), (200, 84), (0, 84), (0, 0))
    shapes = [frame, tap(100, 40), tap(0, 80), ellipse(100, 42, 20, 30)]
    wanted = PlanSettings(arm=str(file), canvas=CanvasKind.OPTIMAL)
    with pytest.raises(TargetOutOfReach, match="q1") as caught:
        planned(tmp_path, shapes, wanted)
    assert caught.value.exit_code == 3 and caught.value.stroke >= 0 and caught.value.joint == "q1"
    result = planned(tmp_path, shapes, replace(wanted, skip_unreachable=True))
    assert any("out of reach" in warning for warning in result.summary.warnings)
    told, shown = result.trajectory.left_out, result.drawing
    check_result = check_trajectory(result.trajectory, load_once(str(file)), shown)
    assert check_result.passed, check_result.text()
    assert f"nothing missing: left out as asked: {told.length_mm:.0f}"[:-1] in check_result.text()
    assert told.taps == 1
    for other in (LeftOut(0.9 * told.length_mm, 1), LeftOut(told.length_mm, 0), LeftOut()):
        (fault,) = check_trajectory(replace(result.trajectory, left_out=other), load_once(str(file)), shown).faults
        assert fault.check == "nothing missing"
    tips = tips_by_formula(arm_table("drawing_arm"), result.trajectory.positions)
    drawn = [line[:, :2] for line in runs(result.trajectory, tips)]
    on_paper = placed(result.trajectory, shapes)
    assert furthest_mm(np.concatenate(drawn), on_paper) <= TOLERANCE_MM  # nothing that was not asked for
    everything = np.concatenate(on_paper)
    azimuth = np.degrees(np.arctan2(everything[:, 1], everything[:, 0]))
    assert furthest_mm(everything[np.abs(azimuth) <= 35.0], drawn) <= TOLERANCE_MM + 0.5  # nothing missing in between
    assert result.summary.n_taps == 1


def test_a_very_long_stroke_is_drawn_in_pieces_without_lifting(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shapes = [polyline(*((4.0 * k, 8.0 * (k % 2) + k) for k in range(9)))]
    whole = planned(tmp_path, shapes, PlanSettings(rate_hz=500.0)).trajectory
    monkeypatch.setattr(pieces, "_WORK", 50)
    trajectory = planned(tmp_path, shapes, PlanSettings(rate_hz=500.0)).trajectory
    assert not np.array_equal(trajectory.positions, whole.positions)  # it was cut
    assert_checked(trajectory, tmp_path)
    assert_keeps_its_promises(trajectory, shapes)
    assert np.count_nonzero(np.diff(trajectory.stroke)) == 2


def test_the_same_drawing_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("one.csv", "other.csv"):
        write_trajectory(planned(tmp_path, FACE, PlanSettings()).trajectory, tmp_path / name)
    assert (tmp_path / "one.csv").read_bytes() == (tmp_path / "other.csv").read_bytes()


def test_the_pen_keeps_to_its_speed(tmp_path: Path) -> None:
    trajectory = planned(tmp_path, FACE, PlanSettings(speed_mm_s=25.0)).trajectory
    tips = tips_by_formula(arm_table("drawing_arm"), trajectory.positions)
    speeds = np.concatenate([np.linalg.norm(np.diff(line, axis=0), axis=1) for line in runs(trajectory, tips)]) * 100
    assert 24.0 < speeds.max() <= 25.0 * 1.01


def test_the_clearance_of_a_calibrated_arm_is_told_with_its_reason(tmp_path: Path) -> None:
    bare = load_once("drawing_arm")
    known = replace(bare, accuracy=Accuracy(49, 0.1, 0.2, (0.0,) * bare.n_joints))
    usual = replace(known, pen=replace(known.pen, clearance_mm=usual_clearance_mm(known)))
    file = tmp_path / "drawing.svg"
    file.write_text(svg_of(FACE, 'viewBox="0 0 100 100"'), encoding="utf-8")
    told = [
        [line for line in plan(file, PlanSettings(), unheard, arm=arm).summary.remarks if "clear of the paper" in line]
        for arm in (usual, known, bare)
    ]
    assert told == [
        ["the pen is clear of the paper at 0.53 mm, by what this arm's height is expected to be off by: 0.2 mm"],
        [],
        [],
    ]


def test_taps_and_dwells_rest_on_the_paper(tmp_path: Path) -> None:
    usual = planned(tmp_path, FACE, PlanSettings()).trajectory
    resting = planned(tmp_path, FACE, PlanSettings(dwell_s=0.2)).trajectory
    counts = [np.bincount(trajectory.stroke[trajectory.pen]) for trajectory in (usual, resting)]
    assert counts[0].min() >= 5 and len(counts[0]) == len(counts[1])
    # A stroke rests for 0.2 s more, to the sample, and a tap for so long instead of the 0.05 s of a dot.
    taps = counts[0] == counts[0].min()
    assert taps.sum() == 2
    np.testing.assert_array_equal(counts[1] - counts[0], np.where(taps, 15, 20))


def test_the_summary_says_what_the_trajectory_is(tmp_path: Path) -> None:
    result = planned(tmp_path, FACE, PlanSettings())
    summary, trajectory = result.summary, result.trajectory
    assert (summary.n_strokes, summary.n_taps) == (5, 2) and int(trajectory.stroke.max()) == 4
    assert summary.n_samples == trajectory.n_samples and summary.duration_s == trajectory.duration_s
    assert abs(summary.phases.total_s - summary.duration_s) <= 2 / summary.rate_hz
    lengths = [float(np.hypot(*np.diff(line, axis=0).T).sum()) for line in placed(trajectory, FACE)]
    np.testing.assert_allclose(summary.drawn_mm, sum(lengths), rtol=2e-3)
    assert any("2 of them taps" in line for line in summary.lines())
    assert summary.warnings == []


def test_doubled_points_and_tiny_strokes_can_be_drawn(tmp_path: Path) -> None:
    shapes = [
        polyline((0, 0), (0, 0), (40, 0), (40, 0), (40, 1e-9), (0, 0)),
        polyline((10, 10), (10.0001, 10)),
        polyline((20, 20), (20, 20)),
        ellipse(50, 50, 1e-3, 2e-3),
        polyline((60, 60), (60.02, 60), (60, 60)),
    ]
    trajectory = planned(tmp_path, shapes, PlanSettings()).trajectory
    assert_checked(trajectory, tmp_path)


def test_progress_is_told_stage_by_stage(tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    file = tmp_path / "drawing.svg"
    file.write_text(svg_of(FACE), encoding="utf-8")
    plan(file, PlanSettings(), lambda *progress: told.append(progress))
    assert all(0 <= done <= total for _, done, total in told)
    assert told[0][0] == "reading"
    assert told[-1][1] == told[-1][2]


@pytest.mark.parametrize(("rate_hz", "speed_mm_s", "tolerance_mm"), [(50.0, 300.0, 0.05), (100.0, 200.0, 0.01)])
def test_between_rare_samples_of_quick_pens_joints_that_move_straight_keep_the_tip_on_the_line(
    tmp_path: Path, rate_hz: float, speed_mm_s: float, tolerance_mm: float
) -> None:
    wanted = PlanSettings(rate_hz=rate_hz, speed_mm_s=speed_mm_s, tolerance_mm=tolerance_mm)
    trajectory = planned(tmp_path, [polyline((0, 50), (100, 50)), polyline((50, 0), (50, 100))], wanted).trajectory
    check_result = check_trajectory(
        trajectory, load_once("drawing_arm"), read_drawing(tmp_path / "drawing.svg"), tolerance_mm
    )
    missed = [finding for finding in check_result.findings if not finding.passed]
    assert not [finding for finding in missed if "drawing" in finding.remark or "paper" in finding.check], missed


@pytest.mark.parametrize("method", [Method.NLP, Method.DLS])
def test_sequential_methods_draw_beside_joint_limits_what_method_path_draws(tmp_path: Path, method: Method) -> None:
    rng = np.random.default_rng(5)
    drawing = tmp_path / "scribble.svg"
    for _ in range(3):  # over all of a canvas at whose edge a joint is at its limit
        drawing.write_text(random_drawing(rng, n_things=3))
        made = plan(drawing, PlanSettings("drawing_arm_2022", method, margin_mm=0.0), lambda *_: None)
        assert check_trajectory(made.trajectory, load_once("drawing_arm_2022"), made.drawing).passed


def test_far_too_long_drawings_are_refused_before_all_of_it_is_timed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pen_drawing, "_MANY_CHUNKS", 2)
    monkeypatch.setattr(pen_drawing, "_FORETELLING", 1)
    monkeypatch.setattr(work_chunks, "_CHUNK_WORK", 1000.0)
    monkeypatch.setattr(pen_drawing, "require_bounded", partial(require_bounded, most_samples=300))
    timed: list[work_chunks.StrokeChunk] = []

    def counted(chunk: work_chunks.StrokeChunk) -> list[TimedStroke | InfeasiblePath]:
        timed.append(chunk)
        return work_chunks.timed_strokes(chunk)

    monkeypatch.setattr(pen_drawing, "timed_strokes", counted)
    walk = np.cumsum(np.random.default_rng(3).normal(size=(600, 2)), axis=0)
    drawing = tmp_path / "walk.svg"
    drawing.write_text(svg_of([polyline(*walk.tolist())]))
    told: list[tuple[str, int, int]] = []
    with pytest.raises(UsageError, match="the drawing would take"):
        plan(
            drawing,
            PlanSettings(tolerance_mm=0.01, speed_mm_s=500.0, place=PlaceKind.INK),
            lambda *progress: told.append(progress),
        )
    assert max(done for stage, done, _ in told if stage == "drawing motions") == 0
    assert len(timed) == 1  # of six


def test_strokes_are_ordered_by_the_time_of_the_arms_travel(tmp_path: Path) -> None:
    """Not by how far its joints move: one long move is sooner done than several short ones."""
    file, settings, model = (
        tmp_path / "drawing.svg",
        PlanSettings(place=PlaceKind.INK),
        model_of(load_once("drawing_arm")),
    )
    drawn = [polyline(*map(tuple, stroke.tolist())) for stroke in STROKE_SETS["clustered"]]
    file.write_text(svg_of(drawn, 'viewBox="-20 -20 240 180"'), encoding="utf-8")
    strokes, _ = placed_strokes(file, model, settings)
    origin = canvas_of(model, settings.canvas, model.arm.pen.lift_mm).to_arm_mm(np.zeros(2))
    time, way = (Metric(travel_time_metric(model), exponent=exponent) for exponent in (1 / 3, 1.0))
    assert travel(strokes, origin, time) < 0.998 * travel(order_strokes(strokes, origin, way), origin, time)
