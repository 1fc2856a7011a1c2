"""A region is what a fill covers: the same as winding numbers that are counted point by point."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import BoolArray, FloatArray
from planner.drawing.cut.region import region
from planner.drawing.subpath import Subpath, polyline

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
KAPPA = 0.5522847498307936


def circle(x: float = 0.0, y: float = 0.0, radius: float = 1.0) -> Subpath:
    k = KAPPA
    quarter = np.array([[1.0, 0.0], [1.0, k], [k, 1.0], [0.0, 1.0]])
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    quarters = [quarter @ np.linalg.matrix_power(turn, n) for n in range(4)]
    return Subpath(radius * np.array(quarters) + (x, y), True, np.ones(4, dtype=np.bool_))


def is_covered(subpaths: list[Subpath], points: FloatArray, is_even_odd: bool) -> BoolArray:
    """By the angle that each outline turns through as seen from a point."""
    t = np.linspace(0.0, 1.0, 200)[:, np.newaxis, np.newaxis]
    turns = np.zeros(len(points))
    for path in subpaths:
        b = np.moveaxis(path.beziers, 1, 0)
        curve = (1 - t) ** 3 * b[0] + 3 * (1 - t) ** 2 * t * b[1] + 3 * (1 - t) * t**2 * b[2] + t**3 * b[3]
        outline = np.moveaxis(curve, 0, 1).reshape(-1, 2)
        ring = np.concatenate((outline, outline[:1]))
        seen = (ring - points[:, np.newaxis]) @ np.array([1.0, 1.0j])
        turns += np.angle(seen[:, 1:] / seen[:, :-1]).sum(axis=1) / (2 * np.pi)
    winding = np.rint(turns).astype(int)
    covered: BoolArray = winding % 2 != 0 if is_even_odd else winding != 0
    return covered


coordinate = st.integers(-40, 40)
point = st.tuples(coordinate, coordinate)


@st.composite
def curved_subpaths(draw: st.DrawFn) -> Subpath:
    start = first = draw(point)
    curves = []
    for _ in range(draw(st.integers(1, 4))):
        curves.append([start, draw(point), draw(point), draw(point)])
        start = curves[-1][-1]
    if draw(st.booleans()):
        curves.append([start, start, first, first])
    return Subpath(np.array(curves, dtype=np.float64), False, np.ones(len(curves), dtype=np.bool_))


straight_subpaths = st.lists(point, min_size=3, max_size=9).map(lambda points: polyline(np.array(points, dtype=float)))


@settings(max_examples=80, deadline=None)
@given(st.lists(curved_subpaths() | straight_subpaths, min_size=1, max_size=4), st.booleans())
def test_a_region_covers_what_winding_numbers_say(subpaths: list[Subpath], is_even_odd: bool) -> None:
    area = region(subpaths, is_even_odd)
    assert area.is_valid
    across, down = np.meshgrid(np.linspace(-41.3, 41.7, 15), np.linspace(-41.9, 41.1, 15))
    points = np.column_stack((across.ravel(), down.ravel()))
    if not area.is_empty:  # on the edge itself the chords of the two differ
        points = points[shapely.distance(area.boundary, shapely.points(points)) > 0.02]
    np.testing.assert_array_equal(shapely.contains_xy(area, points), is_covered(subpaths, points, is_even_odd))


@pytest.mark.parametrize("is_even_odd", [False, True])
def test_the_plain_cases_are_exact(is_even_odd: bool) -> None:
    assert region([polyline(SQUARE, is_closed=True)], is_even_odd).equals(shapely.box(0, 0, 10, 10))
    assert region([polyline(SQUARE)], is_even_odd).equals(shapely.box(0, 0, 10, 10))


def test_the_fill_rule_counts_in_a_ring() -> None:
    inner = polyline(SQUARE[::-1] / 2.0 + 2.5, is_closed=True)
    same_way = polyline(SQUARE / 2.0 + 2.5, is_closed=True)
    outer = polyline(SQUARE, is_closed=True)
    assert region([outer, inner], is_even_odd=False).area == pytest.approx(75.0)
    assert region([outer, same_way], is_even_odd=False).area == pytest.approx(100.0)
    assert region([outer, same_way], is_even_odd=True).area == pytest.approx(75.0)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_curved_edge_is_as_fine_as_its_extent_asks(scale: float) -> None:
    path = circle(3.0 * scale, -2.0 * scale, scale)
    edge = shapely.get_coordinates(region([path], is_even_odd=False))
    t = np.linspace(0.0, 1.0, 5000)[:, np.newaxis, np.newaxis]
    b = np.moveaxis(path.beziers, 1, 0)
    curve = (1 - t) ** 3 * b[0] + 3 * (1 - t) ** 2 * t * b[1] + 3 * (1 - t) * t**2 * b[2] + t**3 * b[3]
    off = shapely.distance(shapely.linestrings(edge), shapely.points(curve.reshape(-1, 2)))
    assert off.max() < 2e-6 * scale
    assert len(edge) < 3000


@pytest.mark.parametrize(
    "subpaths",
    [
        [],
        [polyline(np.array([[3.0, 4.0]]))],
        [polyline(np.array([[0.0, 0.0], [5.0, 5.0]]))],
        [polyline(np.array([[0.0, 0.0], [5.0, 5.0], [9.0, 9.0], [2.0, 2.0]]), is_closed=True)],
    ],
)
@pytest.mark.parametrize("is_even_odd", [False, True])
def test_what_has_no_area_makes_an_empty_region(subpaths: list[Subpath], is_even_odd: bool) -> None:
    assert region(subpaths, is_even_odd).is_empty


def test_edges_that_lie_upon_each_other_count_by_the_rule() -> None:
    twice = [polyline(SQUARE, is_closed=True), polyline(SQUARE, is_closed=True)]
    assert region(twice, is_even_odd=True).is_empty
    assert region(twice, is_even_odd=False).area == pytest.approx(100.0)
