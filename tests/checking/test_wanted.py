"""Two ways to cut the same scene come to the same lines."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.checking.filled import filled
from planner.checking.wanted import wanted_lines
from planner.drawing.cut.dash import dashed
from planner.drawing.cut.region import region
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import flatten_all
from planner.drawing.options import ReadingOptions
from planner.drawing.outlines import outlines
from planner.drawing.scene.shape import Paint, Scene, Shape, Stroke
from planner.drawing.subpath import polyline
from planner.placement.short_gaps import gaps_to_draw
from tests.drawing.cut.made_subpaths import subpaths_of

CHORD_MM = 0.002
INK, GLASS = Paint((0, 0, 0), True), Paint((0, 0, 0), False)
TO_PAPER = np.array([[0.6, -0.8, 30.0], [0.8, 0.6, -10.0]])

coordinate = st.integers(-20, 120).map(float)
point = st.tuples(coordinate, coordinate)


@st.composite
def shapes(draw: st.DrawFn) -> Shape:
    path = draw(subpaths_of(point))
    clips = tuple(region([draw(subpaths_of(point))], draw(st.booleans())) for _ in range(draw(st.integers(0, 2))))
    if draw(st.booleans()):
        closed = polyline(np.concatenate((path.beziers[:, 0], path.beziers[-1:, 3])), is_closed=True)
        return Shape((closed,), (closed,), draw(st.sampled_from([INK, GLASS])), draw(st.booleans()), None, clips, "")
    dashes: tuple[list[float], float] = draw(st.sampled_from([([], 0.0), ([7.0, 3.0], 2.0), ([3.0, 0.3], 0.0)]))
    return Shape((path,), tuple(dashed([path], *dashes)), None, False, Stroke(INK, 1.0), clips, "")


def drawing_of(scene: Scene, reading: ReadingOptions) -> Drawing:
    drawn, _ = outlines(scene, reading)
    return Drawing("", drawn, scene.user_to_page, scene.page_mm, {}, scene, reading)


def farthest(lines: Sequence[FloatArray], others: Sequence[FloatArray]) -> float:
    """How far a point of the lines is from the others."""
    if not lines:
        return 0.0
    there = [shapely.LineString(line) if len(line) > 1 else shapely.Point(line[0]) for line in others]
    spots = np.concatenate(
        [
            shapely.get_coordinates(shapely.segmentize(shapely.LineString(line), 0.3)) if len(line) > 1 else line
            for line in lines
        ]
    )
    return float(shapely.distance(shapely.union_all(there), shapely.points(spots)).max()) if there else np.inf


@settings(max_examples=25, deadline=None)
@given(st.lists(shapes(), min_size=1, max_size=4), st.booleans(), st.sampled_from(["page", "none"]))
def test_the_reader_draws_what_the_check_wants(shown: list[Shape], occlude: bool, crop: str) -> None:
    scene = Scene(tuple(shown), np.eye(2, 3), (100.0, 100.0), Counter())
    drawing = drawing_of(scene, ReadingOptions(crop=crop, occlude=occlude))  # type: ignore[arg-type]
    wanted = wanted_lines(drawing, TO_PAPER, CHORD_MM)
    drawn = flatten_all([*drawing.outlines, *gaps_to_draw(drawing.outlines, TO_PAPER)], TO_PAPER, CHORD_MM)
    assert farthest(drawn, wanted.allowed) < 0.03
    assert farthest(wanted.required, drawn) < 0.03


def test_what_is_missing_after_a_clip_is_wanted() -> None:
    line = polyline(np.array([[0.0, 50.0], [100.0, 50.0]]))
    shape = Shape((line,), (line,), None, False, Stroke(INK, 1.0), (shapely.box(20.0, 0.0, 60.0, 100.0),), "")
    scene = Scene((shape,), np.eye(2, 3), (100.0, 100.0), Counter())
    wanted = wanted_lines(Drawing("", (), scene.user_to_page, scene.page_mm, {}, scene), np.eye(2, 3), CHORD_MM)
    np.testing.assert_allclose(wanted.required, [[[20.0, 50.0], [60.0, 50.0]]], atol=1e-6)
    np.testing.assert_allclose(wanted.allowed, [[[20.0, 50.0], [60.0, 50.0]]], atol=3 * CHORD_MM)


def test_a_line_there_and_back_stays_two_where_it_is_cut() -> None:
    line = polyline(np.array([[0.0, 50.0], [150.0, 50.0], [0.0, 50.0]]))
    scene = Scene(
        (Shape((line,), (line,), None, False, Stroke(INK, 1.0), (), ""),), np.eye(2, 3), (100.0, 100.0), Counter()
    )
    wanted = wanted_lines(Drawing("", (), scene.user_to_page, scene.page_mm, {}, scene), np.eye(2, 3), CHORD_MM)
    assert sum(shapely.LineString(line).length for line in wanted.required) == pytest.approx(200.0, abs=1e-3)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.lists(point, min_size=3, max_size=6), min_size=1, max_size=3), st.booleans())
def test_both_ways_to_fill_agree(rings: list[list[tuple[float, float]]], is_even_odd: bool) -> None:
    lines = [np.array(ring) for ring in rings]
    theirs = region([polyline(line, is_closed=True) for line in lines], is_even_odd)
    assert shapely.symmetric_difference(filled(lines, is_even_odd), theirs).area < 1e-3
