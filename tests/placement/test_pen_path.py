"""Pen paths stay within the tolerance of their polylines, are smooth, and start and end fit for rest."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from planner.arrays import FloatArray
from planner.placement.pen_path import PenPaths, smooth_paths
from planner.spline_paths import DEGREE

TOLERANCE_MM = 0.02


def curve_of(paths: PenPaths, index: int) -> BSpline[np.float64]:
    """One path as SciPy's spline over sigma, apart from the planner's own evaluation."""
    first = int((paths.n_cells[:index] + DEGREE).sum())
    n_cells = int(paths.n_cells[index])
    knots = np.arange(-DEGREE, n_cells + DEGREE + 1, dtype=np.float64)
    return BSpline(knots, paths.controls[first : first + n_cells + DEGREE], DEGREE, extrapolate=False)


def traced(paths: PenPaths, index: int, per_cell: int = 24) -> FloatArray:
    n_cells = int(paths.n_cells[index])
    points: FloatArray = curve_of(paths, index)(np.linspace(0.0, n_cells, per_cell * n_cells + 1))
    return points


def dense(line: FloatArray, step_mm: float) -> FloatArray:
    """Points of a polyline, its vertices among them, at most a step apart."""
    pieces = [np.linspace(a, b, max(int(np.ceil(np.hypot(*(b - a)) / step_mm)), 2)) for a, b in pairwise(line)]
    return np.concatenate(pieces)


def are_within(points: FloatArray, line: FloatArray, distance_mm: float) -> bool:
    """Whether all points are so near to the polyline: sooner told than how near they are."""
    shape = shapely.LineString(line)
    shapely.prepare(shape)
    return bool(shapely.dwithin(shape, shapely.points(points), distance_mm).all())


def assert_follows(line: FloatArray, tolerance_mm: float = TOLERANCE_MM) -> PenPaths:
    paths = smooth_paths([line], tolerance_mm)
    trace = traced(paths, 0)
    extent = float(np.abs(line).max())
    step_mm = max(tolerance_mm, float(np.hypot(*np.diff(line, axis=0).T).sum()) / 4000)
    np.testing.assert_allclose(trace[[0, -1]], line[[0, -1]], rtol=0, atol=1e-12 * max(extent, 1.0))
    assert are_within(trace, line, 1.002 * tolerance_mm)
    assert are_within(dense(line, step_mm), trace, 1.002 * tolerance_mm)
    return paths


@st.composite
def polylines(draw: st.DrawFn) -> FloatArray:
    """Two to eight vertices, sharp and flat turns alike, from a hundredth of a millimetre to the whole paper."""
    scale = 10.0 ** draw(st.floats(-2.0, 2.477))
    unit = st.floats(-0.5, 0.5).map(lambda value: round(value, 4))
    vertices = draw(st.lists(st.tuples(unit, unit), min_size=2, max_size=8))
    line = scale * np.array(vertices) + np.array([100.0, 0.0])
    line = line[np.concatenate(([True], np.hypot(*np.diff(line, axis=0).T) > 1e-6))]
    return line if len(line) > 1 else np.stack((line[0], line[0] + [scale, 0.0]))


def circle(radius_mm: float, chord_error_mm: float, turns: float = 1.0) -> FloatArray:
    count = int(np.ceil(turns * np.pi / np.arccos(1 - min(chord_error_mm / radius_mm, 0.5))))
    angle = np.linspace(0.0, 2 * np.pi * turns, max(count, 3) + 1)
    return radius_mm * np.column_stack((np.cos(angle), np.sin(angle)))


def hilbert(order: int, step_mm: float) -> FloatArray:
    turns = "A"
    for _ in range(order):
        turns = "".join({"A": "-BF+AFA+FB-", "B": "+AF-BFB-FA+"}.get(letter, letter) for letter in turns)
    place, heading, line = 0j, 1 + 0j, [0j]
    for letter in turns:
        heading *= {"+": 1j, "-": -1j}.get(letter, 1)
        if letter == "F":
            place += step_mm * heading
            line.append(place)
    return np.column_stack((np.real(line), np.imag(line)))


SHAPES = {
    "straight": np.array([[0.0, 0.0], [300.0, 0.0]]),
    "reversal": np.array([[0.0, 0.0], [40.0, 0.0], [10.0, 0.0]]),
    "reversals": np.array([[0.0, 0.0], [5.0, 0.0], [0.0, 0.0], [5.0, 0.0], [0.0, 0.0]]),
    "hair": np.array([[0.0, 0.0], [0.01, 0.0]]),
    "hair bent back": np.array([[0.0, 0.0], [0.01, 0.0], [0.0, 0.001]]),
    "needle": np.array([[0.0, 0.0], [100.0, 0.01], [0.0, 0.02]]),
    "corner at the very start": np.array([[0.0, 0.0], [0.001, 0.0], [0.001, 50.0]]),
    "corner at the very end": np.array([[0.0, 0.0], [50.0, 0.0], [50.0, 0.03]]),
    "square": np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 30.0], [0.0, 30.0], [0.0, 0.0]]),
    "dense circle": circle(15.0, 2e-5),
    "coarse circle": circle(15.0, 0.005),
    "small circle": circle(0.05, 1e-4),
    "dot of a circle": circle(0.005, 1e-4),
    "many turns": circle(2.0, 0.005, 5.0),
    "comb": np.array([[0.1 * k, 5.0 * ((k // 2 + k) % 2)] for k in range(60)]),
    "Hilbert's curve": hilbert(3, 0.7),
    "far away": np.array([[1e4, 1e4], [1e4 + 20.0, 1e4], [1e4 + 20.0, 1e4 + 1.0]]),
}


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("tolerance_mm", [0.005, 0.0225, 0.2])
def test_pen_path_and_polyline_are_within_the_tolerance_of_each_other(name: str, tolerance_mm: float) -> None:
    assert_follows(SHAPES[name], tolerance_mm)


@settings(deadline=None, max_examples=100)
@given(polylines())
def test_any_polyline_is_followed(line: FloatArray) -> None:
    assert_follows(line)


@settings(deadline=None, max_examples=40)
@given(polylines())
@example(SHAPES["hair"])
@example(SHAPES["reversal"])
def test_paths_begin_and_end_fit_for_rest(line: FloatArray) -> None:
    """The first and second derivatives by sigma are zero at both ends, the third is not, and points the right way where
    the tolerance leaves only one: a stroke within it may be drawn as hardly more than a dot."""
    paths = smooth_paths([line], TOLERANCE_MM)
    curve = curve_of(paths, 0)
    ends = [0.0, float(paths.n_cells[0]) - 1e-12]
    rounding = 1e-12 * max(float(np.abs(line).max()), 1.0)
    for order in (1, 2):
        np.testing.assert_allclose(curve.derivative(order)(ends), 0.0, atol=20 * rounding)
    third = curve.derivative(3)(ends)
    for derivative, step in ((third[0], line[1] - line[0]), (third[1], line[-1] - line[-2])):
        assert derivative @ step > 0 or np.hypot(*step) < 4 * TOLERANCE_MM


def test_derivatives_are_continuous_to_the_fourth_and_are_those_of_the_spline() -> None:
    lines = [SHAPES["square"], SHAPES["hair"], SHAPES["reversal"]]
    paths = smooth_paths(lines, TOLERANCE_MM)
    begin = 0
    for index, n_cells in enumerate(paths.n_cells.tolist()):
        curve = curve_of(paths, index)
        for order in range(DEGREE):
            ends = paths.positions(np.array([0.0, 1.0]), order)[begin : begin + n_cells]
            np.testing.assert_allclose(ends[:-1, 1], ends[1:, 0], atol=1e-11)
            np.testing.assert_allclose(ends[1:, 0], curve.derivative(order)(np.arange(1, n_cells)), atol=1e-10)
        begin += n_cells


@settings(deadline=None, max_examples=40)
@given(st.lists(polylines(), min_size=2, max_size=5), st.data())
def test_a_stroke_does_not_depend_on_the_others(lines: Sequence[FloatArray], data: st.DataObject) -> None:
    chosen = data.draw(st.integers(0, len(lines) - 1))
    together, alone = smooth_paths(lines, TOLERANCE_MM), smooth_paths([lines[chosen]], TOLERANCE_MM)
    assert abs(int(together.n_cells[chosen]) - int(alone.n_cells[0])) <= 1  # rounding may tip one cell over
    if together.n_cells[chosen] == alone.n_cells[0]:
        np.testing.assert_allclose(traced(together, chosen), traced(alone, 0), atol=1e-6)


def test_cells_grow_with_the_path_and_not_with_the_points_on_it() -> None:
    """Points added on straight lines change nothing, and a curve needs no more cells for denser chords."""
    plain = smooth_paths([SHAPES["square"]], TOLERANCE_MM)
    filled = smooth_paths(
        [
            dense(SHAPES["square"], 0.05)[
                np.concatenate(([True], np.hypot(*np.diff(dense(SHAPES["square"], 0.05), axis=0).T) > 1e-9))
            ]
        ],
        TOLERANCE_MM,
    )
    assert filled.n_cells[0] <= 1.05 * plain.n_cells[0]
    coarse, fine = (smooth_paths([SHAPES[name]], TOLERANCE_MM) for name in ("coarse circle", "dense circle"))
    assert fine.n_cells[0] <= 1.1 * coarse.n_cells[0]


def test_a_straight_line_stays_straight() -> None:
    paths = smooth_paths([np.array([[0.0, 0.0], [30.0, 40.0]])], TOLERANCE_MM)
    x, y = traced(paths, 0).T
    np.testing.assert_allclose(4 * x, 3 * y, atol=1e-10)
    assert (np.diff(x) >= 0).all()


def test_a_subdivided_path_is_the_same_curve_in_twice_the_cells() -> None:
    paths = smooth_paths([SHAPES["square"], SHAPES["hair"], SHAPES["reversal"]], TOLERANCE_MM)
    finer = paths.subdivided()
    assert finer.n_cells.tolist() == (2 * paths.n_cells).tolist()
    fractions = np.linspace(0.0, 1.0, 9)
    for derivative in range(DEGREE):
        whole = paths.positions(fractions, derivative)
        halves = finer.positions(fractions, derivative).reshape(len(whole), 2, len(fractions), 2)
        np.testing.assert_allclose(2**derivative * halves[:, 0, ::2], whole[:, :5], atol=1e-9)
        np.testing.assert_allclose(2**derivative * halves[:, 1, ::2], whole[:, 4:], atol=1e-9)
