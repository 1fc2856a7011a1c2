"""Flattening keeps to the chord error both ways; extents are true."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.drawing.drawing import Outline
from planner.drawing.flatten import extent, flatten_all

IDENTITY = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
coordinate = st.floats(-100, 100).map(lambda value: round(value, 3))
point = st.tuples(coordinate, coordinate)
affines = st.tuples(*[st.floats(-3, 3).map(lambda value: round(value, 12))] * 6).map(
    lambda values: np.array(values).reshape(2, 3)
)  # rounded, as shapely divides by lengths


@st.composite
def outlines(draw: st.DrawFn) -> Outline:
    start = draw(point)
    curves = []
    for _ in range(draw(st.integers(1, 4))):
        curve = [start, *draw(st.tuples(point, point, point))]
        curves.append(curve)
        start = curve[-1]
    return Outline(np.array(curves))


def on_curve(outline: Outline, affine: FloatArray, count: int = 400) -> FloatArray:
    t = np.linspace(0.0, 1.0, count)[:, np.newaxis, np.newaxis]
    b = np.moveaxis(outline.beziers, 1, 0)
    points = (1 - t) ** 3 * b[0] + 3 * (1 - t) ** 2 * t * b[1] + 3 * (1 - t) * t**2 * b[2] + t**3 * b[3]
    moved: FloatArray = np.moveaxis(points, 0, 1).reshape(-1, 2) @ affine[:, :2].T + affine[:, 2]
    return moved


@settings(deadline=None, max_examples=40)
@given(outlines(), affines, st.sampled_from([0.01, 0.05, 1.0]))
def test_polyline_and_curve_are_within_the_tolerance_both_ways(
    outline: Outline, affine: FloatArray, tolerance_mm: float
) -> None:
    polyline = flatten_all((outline,), affine, tolerance_mm)[0]
    curve = on_curve(outline, affine)
    if len(polyline) == 1:
        assert np.abs(curve - polyline[0]).max() <= tolerance_mm
        return
    line = shapely.LineString(polyline)
    assert shapely.distance(shapely.points(curve), line).max() <= tolerance_mm + 1e-9
    # Back: between samples, the curve departs from its own chords by far less than the tolerance. Where it doubles back
    # two samples may be one, which shapely cannot measure to.
    sampled = on_curve(outline, affine, 2000)
    samples = shapely.LineString(sampled[np.append(np.any(np.diff(sampled, axis=0) != 0.0, axis=1), True)])
    dense = shapely.points(shapely.get_coordinates(shapely.segmentize(line, max(line.length / 200, 1e-6))))
    assert shapely.distance(dense, samples).max() <= tolerance_mm * 1.01 + 1e-3


@given(outlines(), affines)
def test_polyline_starts_ends_and_never_repeats(outline: Outline, affine: FloatArray) -> None:
    polyline = flatten_all((outline,), affine, 0.05)[0]
    ends = on_curve(outline, affine)[[0, -1]]
    assert np.allclose(polyline[[0, -1]], ends, atol=1e-9)
    assert np.all(np.any(np.diff(polyline, axis=0) != 0.0, axis=1))


@given(st.lists(outlines(), max_size=5), affines)
def test_all_at_once_is_one_by_one(many: list[Outline], affine: FloatArray) -> None:
    together = flatten_all(many, affine, 0.05)
    assert len(together) == len(many)
    for outline, polyline in zip(many, together, strict=True):
        assert np.array_equal(polyline, flatten_all((outline,), affine, 0.05)[0])


def test_lines_stay_two_points_and_taps_one() -> None:
    line = Outline(np.array([[[0.1, 0.1], [1.1, 2.1], [2.1, 4.1], [3.1, 6.1]]]))
    tap = Outline(np.full((1, 4, 2), 7.3))
    turned = np.array([[0.6, -0.8, 1e5], [0.8, 0.6, -3e4]])
    assert [len(polyline) for polyline in flatten_all([line, tap, line], turned, 1e-4)] == [2, 1, 2]


def test_a_circle_takes_about_the_fewest_chords() -> None:
    k = 4 / 3 * np.tan(np.pi / 8)
    quarter = np.array([[1, 0], [1, k], [k, 1], [0, 1]]) * 20.0
    turn = np.array([[0, 1], [-1, 0]])
    circle = Outline(np.array([quarter, quarter @ turn, quarter @ turn @ turn, quarter @ turn @ turn @ turn]))
    assert 45 <= len(flatten_all((circle,), IDENTITY, 0.05)[0]) - 1 <= 56


@given(outlines(), affines)
def test_extent_is_reached_and_never_passed(outline: Outline, affine: FloatArray) -> None:
    low, high = extent([outline], affine)
    curve = on_curve(outline, affine, 2000)
    size = 1.0 + float(np.abs(curve).max())
    assert np.all(curve >= low - 1e-9 * size)
    assert np.all(curve <= high + 1e-9 * size)
    assert np.allclose(curve.min(axis=0), low, atol=1e-4 * size)
    assert np.allclose(curve.max(axis=0), high, atol=1e-4 * size)


def test_extent_of_a_known_arch() -> None:
    arch = Outline(np.array([[[0.0, 0.0], [0.0, 4.0], [4.0, 4.0], [4.0, 0.0]]]))
    low, high = extent([arch], IDENTITY)
    assert low.tolist() == pytest.approx([0, 0])
    assert high.tolist() == pytest.approx([4, 3])


@given(outlines(), st.sampled_from([0.01, 0.05, 1.0]))
def test_chords_are_about_as_many_as_the_bend_asks_for(outline: Outline, tolerance_mm: float) -> None:
    """A cubic whose second derivative is nowhere above b takes sqrt(b / (8 tolerance)) equal chords, and one fewer
    would be too few for a curve that bends like that all the way."""
    for bezier in outline.beziers:
        bend = 6 * float(np.hypot(*np.diff(bezier, n=2, axis=0).T).max())
        wanted = max(1, int(np.ceil(np.sqrt(bend / (8 * tolerance_mm)))))
        assert len(flatten_all((Outline(bezier[None]),), IDENTITY, tolerance_mm)[0]) - 1 <= wanted


def test_a_parabola_takes_the_fewest_chords() -> None:
    """Its second derivative is 120 mm all along, so n equal chords all miss it by 120 / (8 n^2) mm."""
    arch = Outline(np.array([[[0.0, 0.0], [10.0, 20.0], [20.0, 20.0], [30.0, 0.0]]]))
    for tolerance_mm in (0.01, 0.05, 0.3):
        count = len(flatten_all((arch,), IDENTITY, tolerance_mm)[0]) - 1
        assert 15.0 / count**2 <= tolerance_mm < 15.0 / (count - 1) ** 2
