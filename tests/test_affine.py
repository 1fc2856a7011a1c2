"""Affine maps of the plane: composition is application in turn, turns are clockwise on a page and exact."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from planner.affine import compose, rotation
from planner.arrays import FloatArray

MAPS = arrays(np.float64, (2, 3), elements=st.floats(-10, 10))
POINTS = arrays(np.float64, (2,), elements=st.floats(-100, 100))
ANGLES = st.floats(-720, 720)


def applied(affine: FloatArray, point: FloatArray) -> FloatArray:
    return affine[:, :2] @ point + affine[:, 2]


@given(outer=MAPS, inner=MAPS, point=POINTS)
def test_composition_applies_the_inner_map_first(outer: FloatArray, inner: FloatArray, point: FloatArray) -> None:
    np.testing.assert_allclose(applied(compose(outer, inner), point), applied(outer, applied(inner, point)), atol=1e-8)


@given(angle=ANGLES, other=ANGLES, point=POINTS)
def test_turns_add_up_and_keep_lengths(angle: float, other: float, point: FloatArray) -> None:
    np.testing.assert_allclose(compose(rotation(angle), rotation(other)), rotation(angle + other), atol=1e-9)
    np.testing.assert_allclose(np.hypot(*applied(rotation(angle), point)), np.hypot(*point), atol=1e-9)


@pytest.mark.parametrize(
    ("angle", "right"),
    [(0, (1, 0)), (90, (0, 1)), (180, (-1, 0)), (270, (0, -1)), (360, (1, 0)), (-90, (0, -1)), (-450, (0, -1))],
)
def test_right_angles_are_exact_and_clockwise_where_y_points_down(angle: float, right: tuple[float, float]) -> None:
    """Where the page's rightward unit vector goes: a quarter turn takes it down the page."""
    turned = applied(rotation(angle), np.array([1.0, 0.0]))
    assert tuple(turned) == right
    assert tuple(applied(rotation(angle), np.array([0.0, 1.0]))) == (-right[1], right[0])
