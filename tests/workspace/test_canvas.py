"""The three canvases: the documents' figures, and that every point of the usable one can be drawn and lifted from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.errors import PlanError
from planner.settings import CanvasKind
from planner.workspace.canvas import (
    Canvas,
    canvas_of,
    documented_canvas,
    geometric_reach_mm,
    optimal_canvas,
    usable_canvas,
)
from tests.arms.chains import load_once, model_of, tips_by_product, variant

R_MAX_MM, R_MIN_MM = 150.0, 33.0
RADII = st.tuples(st.floats(20, 100), st.floats(2.01, 6)).map(lambda pair: (pair[0] * pair[1], pair[0]))


def area_mm2(canvas: Canvas) -> float:
    return canvas.width_mm * canvas.height_mm


def test_documented_canvas_has_the_printed_size() -> None:
    canvas = documented_canvas(R_MAX_MM, R_MIN_MM)
    assert (round(canvas.width_mm / 10, 2), round(canvas.height_mm / 10, 2)) == (13.56, 10.08)
    assert round(area_mm2(canvas) / 100, 2) == 136.69
    assert round(np.degrees(np.arctan2(canvas.left_mm, canvas.far_mm)), 2) == 26.87


def test_optimal_canvas_is_larger_by_the_known_share() -> None:
    canvas = optimal_canvas(R_MAX_MM, R_MIN_MM)
    assert (round(canvas.width_mm / 10, 4), round(canvas.height_mm / 10, 4)) == (19.3479, 8.1636)
    assert round(area_mm2(canvas) / 100, 3) == 157.949
    assert np.degrees(np.arctan2(canvas.left_mm, canvas.far_mm)) == pytest.approx(40.1604, abs=1e-4)
    assert area_mm2(canvas) / area_mm2(documented_canvas(R_MAX_MM, R_MIN_MM)) == pytest.approx(1.156, abs=5e-4)


def test_the_default_arm_has_both() -> None:
    arm = load_once("drawing_arm")
    assert geometric_reach_mm(model_of(arm)) == pytest.approx(R_MAX_MM, abs=1e-5)
    for kind, make in ((CanvasKind.DOCUMENTED, documented_canvas), (CanvasKind.OPTIMAL, optimal_canvas)):
        expected = make(R_MAX_MM, R_MIN_MM)
        assert canvas_of(model_of(arm), kind, 5.0).corners_arm_mm == pytest.approx(expected.corners_arm_mm, abs=1e-4)


@given(RADII)
def test_both_lie_in_the_half_ring_and_none_of_the_kind_is_larger_than_the_optimal(radii: tuple[float, float]) -> None:
    r_max, r_min = radii
    documented, optimal = documented_canvas(r_max, r_min), optimal_canvas(r_max, r_min)
    half_angles = np.linspace(0, np.arccos(r_min / r_max), 2000)
    best = np.max(2 * r_max * np.sin(half_angles) * (r_max * np.cos(half_angles) - r_min))
    assert best * (1 - 1e-5) < area_mm2(optimal) * (1 + 1e-12) and area_mm2(optimal) >= best * (1 - 1e-12)
    assert area_mm2(documented) <= area_mm2(optimal)
    for canvas in (documented, optimal):
        assert canvas.near_mm == r_min
        np.testing.assert_allclose(np.hypot(*canvas.corners_arm_mm[:2].T), r_max)


def test_a_ring_too_narrow_has_no_documented_canvas() -> None:
    with pytest.raises(PlanError, match="outer radius"):
        documented_canvas(1.9 * R_MIN_MM, R_MIN_MM)


def test_canvas_point_of_the_worked_example() -> None:
    """Its height is rounded to 10 cm there: (2, 8) cm lies at (5.3, 4.78) cm."""
    documented = documented_canvas(R_MAX_MM, R_MIN_MM)
    rounded = replace(documented, far_mm=documented.near_mm + 100.0)
    arm_cm = rounded.to_arm_mm(np.array([20.0, 80.0])) / 10
    np.testing.assert_array_equal(np.round(arm_cm, 2), [5.3, 4.78])


def test_corners_are_the_canvas_own() -> None:
    canvas = Canvas(CanvasKind.USABLE, 40.0, 110.0, -20.0, 70.0)
    w, h = canvas.width_mm, canvas.height_mm
    assert (w, h) == (90.0, 70.0)
    own = np.array([[0, 0], [w, 0], [w, h], [0, h]])
    np.testing.assert_array_equal(canvas.to_arm_mm(own), canvas.corners_arm_mm)
    np.testing.assert_array_equal(canvas.corners_arm_mm, [[110, 70], [110, -20], [40, -20], [40, 70]])


@pytest.mark.parametrize(
    "lengths_mm", [(50.0, 50.0, 50.0, 50.0, 37.0), (40.0, 55.0, 50.0, 45.0, 60.0), (70.0, 60.0, 45.0, 50.0, 45.0)]
)
def test_reach_shrinks_by_the_difference_of_first_and_last_link(
    lengths_mm: tuple[float, float, float, float, float], tmp_path: Path
) -> None:
    l1, l2, l3, l4, l5 = lengths_mm
    arm = variant(tmp_path, lengths_mm)
    assert geometric_reach_mm(model_of(arm)) == pytest.approx(np.sqrt((l2 + l3 + l4) ** 2 - (l5 - l1) ** 2), abs=1e-4)


def test_reach_of_the_arm_with_a_pen_beside_its_plane() -> None:
    assert geometric_reach_mm(model_of(load_once("drawing_arm_2022"))) == pytest.approx(
        np.sqrt(150**2 - 13**2 + 27**2), abs=1e-4
    )


def drawable(arm: Arm, points_mm: FloatArray, lift_mm: float) -> BoolArray:
    """(n,) whether the map's configurations put the pen on points (n, 2) and lift it, by a product of matrices."""
    configuration_map = model_of(arm).configuration_map()
    radius = np.hypot(*points_mm.T)
    good = (radius >= configuration_map.radii_mm[0] - 1e-9) & (radius <= configuration_map.radii_mm[-1] + 1e-9)
    for height in np.linspace(0, lift_mm, 4):
        tips = np.column_stack((points_mm, np.full(len(points_mm), height)))
        joints = arm.complete(configuration_map.configurations_at(tips)[0])
        good &= ((joints >= arm.minimum - 1e-9) & (joints <= arm.maximum + 1e-9)).all(axis=1)
        good &= np.abs(tips_by_product(arm, joints) - tips).max(axis=1) < 1e-6
    return good


LIFTS_MM = pytest.mark.parametrize("lift_mm", [5.0, 25.0])


@LIFTS_MM
def test_every_point_of_the_usable_canvas_is_reached_pen_down_and_pen_up(arm: Arm, lift_mm: float) -> None:
    canvas = usable_canvas(model_of(arm), lift_mm)
    across, away = np.linspace(0, canvas.width_mm, 33), np.linspace(0, canvas.height_mm, 21)
    points = np.stack(np.meshgrid(across, away), axis=-1).reshape(-1, 2)
    assert drawable(arm, canvas.to_arm_mm(points), lift_mm).all()


@LIFTS_MM
@pytest.mark.parametrize("side", ["near_mm", "far_mm", "right_mm", "left_mm"])
def test_the_usable_canvas_cannot_grow_by_a_millimetre(arm: Arm, lift_mm: float, side: str) -> None:
    canvas = usable_canvas(model_of(arm), lift_mm)
    outwards = {"near_mm": -1.0, "far_mm": 1.0, "right_mm": -1.0, "left_mm": 1.0}[side]
    x = [canvas.near_mm, canvas.far_mm]
    y = [canvas.right_mm, canvas.left_mm]
    moved = getattr(canvas, side) + outwards
    if side in ("near_mm", "far_mm"):
        points = np.column_stack((np.full(101, moved), np.linspace(*y, 101)))
    else:
        points = np.column_stack((np.linspace(*x, 101), np.full(101, moved)))
    assert not drawable(arm, points, lift_mm).all()


def test_no_rectangle_of_a_grid_is_much_larger_than_the_usable_canvas(arm: Arm) -> None:
    """All pairs of rows, and for each the longest run of columns that are drawable from one row to the other."""
    radius = float(model_of(arm).configuration_map().radii_mm[-1])
    x, y = np.linspace(0.0, radius, 30), np.linspace(-radius, radius, 60)
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    inside = drawable(arm, points, 5.0).reshape(len(x), len(y))
    largest = 0.0
    for first in range(len(x)):
        for last in range(first + 1, len(x)):
            outside = np.flatnonzero(np.pad(~inside[first : last + 1].all(axis=0), 1, constant_values=True))
            longest = int(np.diff(outside).max()) - 2
            largest = max(largest, longest * (y[1] - y[0]) * (x[last] - x[first]))
    assert 0.0 < largest <= 1.01 * area_mm2(usable_canvas(model_of(arm), 5.0))


def test_without_joint_limits_in_the_way_the_usable_canvas_is_the_largest_of_the_fields_ring() -> None:
    arm = load_once("drawing_arm")
    radii = model_of(arm).configuration_map().radii_mm
    largest = area_mm2(optimal_canvas(float(radii[-1]), float(radii[0])))
    assert 0.995 * largest < area_mm2(usable_canvas(model_of(arm), 5.0)) <= largest


def test_an_arm_that_cannot_lift_so_high_has_no_usable_canvas(arm: Arm) -> None:
    with pytest.raises(PlanError, match="no usable canvas"):
        usable_canvas(model_of(arm), 250.0)
