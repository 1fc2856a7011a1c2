"""Placement is an exact affine that keeps to the canvas and its margin."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.affine import compose, rotation
from planner.arrays import FloatArray
from planner.errors import DoesNotFit, UsageError
from planner.placement.fit import fit_to_canvas
from planner.settings import CanvasKind
from planner.workspace.canvas import Canvas

CANVAS = Canvas(CanvasKind.USABLE, 40.0, 120.0, -75.0, 75.0)
WIDTH_MM, HEIGHT_MM = 150.0, 80.0

coordinate = st.floats(-500, 500)
corners = st.tuples(coordinate, coordinate, st.floats(0.01, 800), st.floats(0.01, 800)).map(
    lambda values: (np.array(values[:2]), np.array(values[:2]) + np.array(values[2:]))
)


def applied(affine: FloatArray, points: FloatArray) -> FloatArray:
    moved: FloatArray = points @ affine[:, :2].T + affine[:, 2]
    return moved


@settings(deadline=None, max_examples=50)
@given(corners, st.floats(0.0, 39.0))
def test_a_fitted_drawing_fills_the_canvas_within_its_margin(
    box: tuple[FloatArray, FloatArray], margin_mm: float
) -> None:
    low, high = box
    affine = fit_to_canvas(low, high, CANVAS, margin_mm=margin_mm, scale=True)
    (x0, y0), (x1, y1) = np.sort(applied(affine, np.stack((low, high))), axis=0)
    room = np.array([x0 - 40.0, 120.0 - x1, y0 + 75.0, 75.0 - y1]) - margin_mm
    assert (room >= -1e-9).all() and min(room[0] + room[1], room[2] + room[3]) < 1e-9  # as large as can be
    np.testing.assert_allclose([room[0], room[2]], [room[1], room[3]], atol=1e-9)  # and in the middle


@settings(deadline=None, max_examples=50)
@given(corners, st.floats(0.0, 39.0), st.booleans())
def test_scale_is_uniform_and_the_page_lies_as_seen_from_behind_the_arm(
    box: tuple[FloatArray, FloatArray], margin_mm: float, scale: bool
) -> None:
    low, high = box
    if not scale:
        high = low + np.minimum(high - low, np.array([WIDTH_MM, HEIGHT_MM]) - 2 * margin_mm)
    linear = fit_to_canvas(low, high, CANVAS, margin_mm=margin_mm, scale=scale)[:, :2]
    factor = -linear[0, 1]
    np.testing.assert_array_equal(linear, factor * np.array([[0.0, -1.0], [-1.0, 0.0]]))
    assert factor > 0 and (scale or factor == 1.0)


@settings(deadline=None, max_examples=50)
@given(st.floats(-720, 720), st.lists(st.tuples(coordinate, coordinate), min_size=2, max_size=6))
def test_a_turned_drawing_fits_and_keeps_its_shape(angle_deg: float, points: list[tuple[float, float]]) -> None:
    shape = np.array(points)
    turned = rotation(angle_deg)
    corners_mm = applied(turned, shape)
    low, high = corners_mm.min(axis=0), corners_mm.max(axis=0)
    if (high - low).max() < 0.1:
        return
    affine = compose(fit_to_canvas(low, high, CANVAS, margin_mm=5.0, scale=True), turned)
    placed = applied(affine, shape)
    assert (placed >= np.array([45.0, -70.0]) - 1e-8).all() and (placed <= np.array([115.0, 70.0]) + 1e-8).all()
    factor = np.sqrt(abs(np.linalg.det(affine[:, :2])))
    np.testing.assert_allclose(affine[:, :2].T @ affine[:, :2], factor**2 * np.eye(2), atol=1e-9 * factor**2)
    assert np.linalg.det(affine[:, :2]) < 0  # the page's y points down: its mirror image lies before the arm


@pytest.mark.parametrize(
    ("angle_deg", "moved"), [(0, (1, 0)), (90, (0, 1)), (180, (-1, 0)), (-90, (0, -1)), (450, (0, 1))]
)
def test_right_angles_are_exact_and_clockwise_on_the_page(angle_deg: float, moved: tuple[float, float]) -> None:
    np.testing.assert_array_equal(applied(rotation(angle_deg), np.array([1.0, 0.0])), moved)


def test_a_single_dot_lies_in_the_middle_at_its_size() -> None:
    dot = np.array([7.0, -3.0])
    affine = fit_to_canvas(dot, dot, CANVAS, margin_mm=5.0, scale=True)
    np.testing.assert_allclose(applied(affine, dot), [80.0, 0.0], atol=1e-12)
    np.testing.assert_array_equal(np.abs(affine[:, :2]).sum(axis=0), [1.0, 1.0])


@pytest.mark.parametrize("size", [(140.1, 10.0), (10.0, 70.1)])
def test_a_drawing_kept_at_its_size_has_to_fit(size: tuple[float, float]) -> None:
    low = np.array([3.0, 4.0])
    with pytest.raises(DoesNotFit, match=f"{size[0]:.1f} x {size[1]:.1f} mm") as caught:
        fit_to_canvas(low, low + size, CANVAS, margin_mm=5.0, scale=False)
    assert caught.value.exit_code == 3
    fit_to_canvas(low, low + size, CANVAS, margin_mm=4.9, scale=False)


@pytest.mark.parametrize("scale", [True, False])
def test_a_margin_has_to_leave_room(scale: bool) -> None:
    with pytest.raises(UsageError, match="40 mm"):
        fit_to_canvas(np.zeros(2), np.ones(2), CANVAS, margin_mm=HEIGHT_MM / 2, scale=scale)
