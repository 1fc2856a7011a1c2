"""Parts inside and parts outside make the whole; ends of parts lie on the edge of the region."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray
from planner.drawing.cut.cut import Cutter, cut
from planner.drawing.cut.region import region
from planner.drawing.subpath import Subpath, polyline
from tests.drawing.cut.made_subpaths import subpaths_of

BOX = shapely.box(0.0, 0.0, 10.0, 10.0)
coordinate = st.floats(-15.0, 25.0).map(lambda value: round(value, 2))
point = st.tuples(coordinate, coordinate)


@st.composite
def regions(draw: st.DrawFn) -> BaseGeometry:
    rings = draw(st.lists(st.lists(point, min_size=3, max_size=6), min_size=1, max_size=3))
    return region([polyline(np.array(ring)) for ring in rings], draw(st.booleans()))


def points_of(subpath: Subpath, n: int = 400) -> FloatArray:
    t = np.linspace(0.0, 1.0, n)[:, np.newaxis, np.newaxis]
    b = np.moveaxis(subpath.beziers, 1, 0)
    points = (1 - t) ** 3 * b[0] + 3 * (1 - t) ** 2 * t * b[1] + 3 * (1 - t) * t**2 * b[2] + t**3 * b[3]
    return np.moveaxis(points, 0, 1).reshape(-1, 2)


def length(parts: list[Subpath]) -> float:
    return float(sum(np.hypot(*np.diff(points_of(part), axis=0).T).sum() for part in parts))


def is_covered(area: BaseGeometry, points: FloatArray) -> FloatArray:
    """By the parity of the edges to the right of each point."""
    odd = np.zeros(len(points), dtype=np.bool_)
    for polygon in shapely.get_parts(area):
        for ring in (polygon.exterior, *polygon.interiors):
            corners = np.array(ring.coords)
            for (x0, y0), (x1, y1) in pairwise(corners):
                x, y = points.T
                if y0 != y1:
                    odd ^= ((y0 <= y) != (y1 <= y)) & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return odd


@settings(max_examples=120, deadline=None)
@given(st.lists(subpaths_of(point), min_size=1, max_size=3), regions())
def test_the_parts_inside_and_outside_make_the_whole(paths: list[Subpath], area: BaseGeometry) -> None:
    cutter = Cutter(area)
    for path, inside, outside in zip(paths, cutter.inside(paths), cutter.outside(paths), strict=True):
        assert length(inside) + length(outside) == pytest.approx(length([path]), rel=1e-3, abs=1e-6)
        for parts, is_in in ((inside, True), (outside, False)):
            for part in parts:
                points = points_of(part, 11)
                points = points[shapely.distance(area.boundary, shapely.points(points)) > 1e-3]
                assert np.all(is_covered(area, points) == is_in)


@settings(max_examples=120, deadline=None)
@given(subpaths_of(point), regions())
def test_ends_lie_on_the_edge_and_on_the_path(path: Subpath, area: BaseGeometry) -> None:
    for part in cut(path, area):
        assert np.array_equal(part.beziers[1:, 0], part.beziers[:-1, 3])
        if part is path:
            continue
        for end in (part.beziers[0, 0], part.beziers[-1, 3]):
            is_own = not path.is_closed and (
                np.array_equal(end, path.beziers[0, 0]) or np.array_equal(end, path.beziers[-1, 3])
            )
            assert is_own or area.boundary.distance(shapely.Point(end)) < 4e-8
        dense = shapely.linestrings(points_of(path, 3000))
        assert shapely.distance(dense, shapely.points(points_of(part, 20))).max() < 1e-4


def test_what_lies_inside_stays_the_same_object() -> None:
    path = polyline(np.array([[1.0, 1.0], [9.0, 2.0], [4.0, 9.5]]), is_closed=True)
    assert cut(path, BOX)[0] is path
    assert Cutter(BOX).outside([path]) == [[]]
    away = polyline(np.array([[11.0, 0.0], [11.0, 11.0]]))
    assert cut(away, BOX) == []
    assert Cutter(BOX).outside([away])[0][0] is away


def test_a_closed_path_stays_joined_over_its_start() -> None:
    path = polyline(np.array([[5.0, 5.0], [20.0, 5.0], [20.0, 8.0], [5.0, 8.0]]), is_closed=True)
    (part,) = cut(path, BOX)
    np.testing.assert_allclose(
        [*part.beziers[:, 0], part.beziers[-1, 3]], [[10, 8], [5, 8], [5, 5], [10, 5]], atol=1e-12
    )
    assert not part.is_closed


@pytest.mark.parametrize("nudge", [0.0, 1e-12, -1e-12])
def test_what_runs_along_the_edge_is_inside(nudge: float) -> None:
    square = polyline(np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]) + nudge, is_closed=True)
    assert cut(square, BOX)[0] is square
    longer = polyline(np.array([[-5.0, nudge], [15.0, nudge]]))
    (part,) = cut(longer, BOX)
    np.testing.assert_allclose([part.beziers[0, 0], part.beziers[-1, 3]], [[0, 0], [10, 0]], atol=1e-8)


def test_a_curve_that_makes_the_edge_runs_along_it() -> None:
    k = 0.5522847498307936
    quarter = np.array([[1.0, 0.0], [1.0, k], [k, 1.0], [0.0, 1.0]])
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    circle = Subpath(
        np.array([quarter @ np.linalg.matrix_power(turn, n) for n in range(4)]), True, np.ones(4, dtype=np.bool_)
    )
    area = region([circle], is_even_odd=False)
    assert cut(circle, area)[0] is circle
    turned = circle.moved(np.array([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]))
    assert cut(turned, area)[0] is turned


def test_curves_are_cut_where_they_cross_twice_within_little() -> None:
    arch = Subpath(np.array([[[2.0, 12.0], [4.0, 9.32], [6.0, 9.32], [8.0, 12.0]]]), False, np.ones(1, dtype=np.bool_))
    (part,) = cut(arch, BOX)
    ends = np.array([part.beziers[0, 0], part.beziers[-1, 3]])
    np.testing.assert_allclose(ends[:, 1], 10.0, atol=1e-12)
    assert 4.0 < ends[0, 0] < 5.0 < ends[1, 0] < 6.0


@pytest.mark.parametrize(("x", "n_parts"), [(5.0, 1), (10.0, 1), (10.1, 0)])
def test_dots_are_in_or_out(x: float, n_parts: int) -> None:
    dot = polyline(np.array([[x, 5.0]]))
    assert len(cut(dot, BOX)) == n_parts
    assert len(Cutter(BOX).outside([dot])[0]) == 1 - n_parts


def test_an_empty_region_keeps_nothing() -> None:
    path = polyline(np.array([[1.0, 1.0], [2.0, 2.0]]))
    empty = Cutter(shapely.Polygon())
    assert empty.inside([path, path]) == [[], []]
    assert empty.outside([path])[0][0] is path
    assert empty.inside([]) == []


def test_a_part_that_leaves_twice_is_two_parts() -> None:
    zigzag = polyline(np.array([[2.0, 5.0], [2.0, 15.0], [8.0, 15.0], [8.0, -5.0], [9.0, -5.0], [9.0, 4.0]]))
    inside, outside = Cutter(BOX).inside([zigzag])[0], Cutter(BOX).outside([zigzag])[0]
    assert [len(part.beziers) for part in inside] == [1, 1, 1]
    assert [len(part.beziers) for part in outside] == [3, 3]
