"""A stroke takes no longer for a larger tolerance, nor for facets and noise within it; and keeps to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.execution.context import PlanContext
from planner.motion.line import timed_lines
from planner.motion.timed_stroke import TimedStroke
from planner.motion.tolerance import STROKE_SHARE
from planner.settings import PlanSettings

_TOLERANCES_MM = (0.02, 0.05, 0.125, 0.3)
_TIMING = 0.01
"""How near the least time a motion is made to be: nearer costs processor time."""


@cache
def context_of(tolerance_mm: float, rate_hz: float = 1000.0) -> PlanContext:
    return PlanContext.of(load_arm("drawing_arm"), PlanSettings(tolerance_mm=tolerance_mm, rate_hz=rate_hz))


def drawn(context: PlanContext, strokes: Sequence[FloatArray]) -> list[TimedStroke]:
    timed = timed_lines(context.model, context.references, context.settings, strokes)
    return [stroke for stroke in timed if isinstance(stroke, TimedStroke)]


def duration_s(context: PlanContext, stroke: FloatArray) -> float:
    (timed,) = drawn(context, [stroke])
    return (len(timed.joints) - 1) / context.settings.rate_hz


@st.composite
def strokes(draw: st.DrawFn) -> FloatArray:
    """Two to seven vertices within some millimetres or centimetres, in the middle of the paper."""
    scale = 10.0 ** draw(st.floats(0.0, 1.5))
    unit = st.integers(-500, 500).map(lambda value: value / 1000)
    line = scale * np.array(draw(st.lists(st.tuples(unit, unit), min_size=2, max_size=7))) + np.array([75.0, 0.0])
    line = line[np.concatenate(([True], np.hypot(*np.diff(line, axis=0).T) > 1e-6))]
    return line if len(line) > 1 else np.stack((line[0], line[0] + [scale, 0.0]))


@settings(deadline=None, max_examples=8)
@given(strokes())
def test_relaxing_the_tolerance_makes_no_stroke_slower(stroke: FloatArray) -> None:
    times = [duration_s(context_of(tolerance_mm), stroke) for tolerance_mm in _TOLERANCES_MM]
    for tight, loose in pairwise(times):
        assert loose <= (1 + _TIMING) * tight + 0.001


@pytest.mark.parametrize("rate_hz", [50.0, 1000.0])
@settings(deadline=None, max_examples=8)
@given(stroke=strokes())
def test_a_faster_pen_makes_no_stroke_slower(rate_hz: float, stroke: FloatArray) -> None:
    """But by the sample that rounding to whole ones takes."""
    context = context_of(0.05, rate_hz)
    at = [replace(context, settings=replace(context.settings, speed_mm_s=speed)) for speed in (20.0, 40.0, 80.0, 400.0)]
    for tight, loose in pairwise([duration_s(each, stroke) for each in at]):
        assert loose <= (1 + _TIMING) * tight + 1 / rate_hz


def spiral(count: int) -> FloatArray:
    turn = np.linspace(0.0, 6 * np.pi, count)
    size = np.linspace(4.0, 25.0, count)[:, None]
    return np.array([75.0, 0.0]) + size * np.column_stack((0.7 * np.cos(turn), np.sin(turn)))


@cache
def smoothest_spiral_s() -> float:
    return duration_s(context_of(0.05), spiral(20_000))


@pytest.mark.parametrize("noise_mm", [0.0, 1e-4, 2e-3])
@pytest.mark.parametrize("points", [300, 1200, 4800])
def test_points_and_noise_below_the_tolerance_cost_no_time(points: int, noise_mm: float) -> None:
    """A spiral through few points or many, exact or with noise, against its smoothest form."""
    noise = np.random.default_rng(1).uniform(-noise_mm, noise_mm, (points, 2))
    assert duration_s(context_of(0.05), spiral(points) + noise) <= 1.02 * smoothest_spiral_s()


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 250.0])
@pytest.mark.parametrize("seed", [1, 2])
def test_a_long_stroke_takes_no_longer_than_its_pieces_from_rest_to_rest(rate_hz: float, seed: int) -> None:
    """Of its many corners some fall badly between the samples: those are to be slow, and not all of the stroke."""
    headings = np.cumsum(np.random.default_rng(seed).uniform(-1.2, 1.2, 400))
    walk = np.cumsum(0.3 * np.column_stack((np.cos(headings), np.sin(headings))), axis=0)
    stroke = walk - walk.mean(axis=0) + [75.0, 0.0]
    whole, *pieces = drawn(context_of(0.05, rate_hz), [stroke, *(stroke[k : k + 21] for k in range(0, 399, 20))])
    assert len(pieces) == 20 and whole.held
    assert len(whole.joints) - 1 <= 1.02 * sum(len(piece.joints) - 1 for piece in pieces)


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 250.0])
def test_chords_between_samples_and_stroke_are_within_the_tolerance_and_use_it(rate_hz: float) -> None:
    """By Shapely, both ways, with the exact arm. Some of the strokes use nearly all there is."""
    random = np.random.default_rng(5)
    lines = [np.array([75.0, 0.0]) + np.cumsum(random.normal(0, 2.0, (count, 2)), axis=0) for count in range(2, 14)]
    context = context_of(0.05, rate_hz)
    worst = [max(away_mm(context, *pair)) for pair in zip(drawn(context, lines), lines, strict=True)]
    assert max(worst) <= 0.05
    assert max(worst) >= 0.9 * 0.05


@pytest.mark.parametrize("seed", [5, 7])
def test_a_stroke_that_passes_a_corner_twice_is_drawn_there_each_time(seed: int) -> None:
    """By Shapely: the other pass, nearer to the corner than the own one, hides what is cut off the line behind it."""
    context = context_of(0.05, 50.0)
    random = np.random.default_rng(seed)
    lines = [knot(random) for _ in range(150)]
    strokes = drawn(context, lines)
    assert len(strokes) == len(lines) and all(stroke.held for stroke in strokes)
    worst = [max(away_mm(context, *pair)) for pair in zip(strokes, lines, strict=True)]
    assert max(worst) <= 1.001 * STROKE_SHARE * 0.05


def knot(random: np.random.Generator) -> FloatArray:
    """From afar into a scrawl within fractions of a millimetre, over one piece of that a second time, and away."""
    scrawl = np.cumsum(random.uniform(-0.15, 0.15, (random.integers(4, 9), 2)), axis=0)
    again = random.integers(1, len(scrawl) - 2)
    turn = scrawl[-1] + np.cumsum(random.uniform(-0.2, 0.2, (3, 2)), axis=0)
    come, go = random.uniform(-3.0, 3.0, (2, 1, 2))
    return np.array([75.0, 0.0]) + np.concatenate((come, scrawl, turn, scrawl[again : again + 2][::-1], go))


def away_mm(context: PlanContext, stroke: TimedStroke, line: FloatArray) -> tuple[float, float]:
    """How far the line is from the tip at most where joints go straight between samples, and the tip from the line."""
    kinematics = context.model.kinematics
    fine = np.concatenate([a + (b - a) * np.linspace(0, 1, 13)[:, None] for a, b in pairwise(stroke.joints)])
    tips = shapely.LineString(kinematics.tip_mm(kinematics.independent_of(fine))[:, :2])
    wanted = shapely.segmentize(shapely.LineString(line), 0.005)
    return (
        float(shapely.distance(tips, shapely.points(shapely.get_coordinates(wanted))).max()),
        float(shapely.distance(wanted, shapely.points(shapely.get_coordinates(tips))).max()),
    )
