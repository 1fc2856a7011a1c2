"""The header's map keeps the shape of the page, does not mirror it unless that is told, and fits what else is told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.checking.check import check_trajectory
from planner.checking.mapping import map_findings
from planner.drawing.drawing import Drawing
from planner.head import LeftOut, Placement
from planner.trajectory import Trajectory
from tests.checking.rig import CORNERED, DOT, SHORT, Hand, drawing_of, gantry, hand

DRAWING = drawing_of(CORNERED, SHORT, DOT)
PAGE_TO_ARM = np.array([[0.0, -1.0], [-1.0, 0.0]])


def faults(trajectory: Trajectory, drawing: Drawing | None = DRAWING) -> set[str]:
    return {one.check for one in check_trajectory(trajectory, gantry(), drawing).faults}


def placed(linear: FloatArray, placement: Placement = Placement()) -> Trajectory:  # noqa: B008 - frozen
    (a, c), (b, d) = linear.tolist()
    return replace(hand().trajectory(), svg_to_arm_mm=(a, b, c, d, 100.0, 50.0), placement=placement)


@given(
    scale=st.floats(1, 10),
    angle_deg=st.floats(-360, 360),
    mirror=st.booleans(),
    stretch=st.tuples(st.floats(0.5, 2), st.floats(0.5, 2)),
)
def test_a_page_may_be_turned_and_scaled_whatever_its_own_coordinates(
    scale: float, angle_deg: float, mirror: bool, stretch: tuple[float, float]
) -> None:
    angle = np.radians(angle_deg)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    page = np.diag(stretch)
    linear = scale * PAGE_TO_ARM @ turn @ np.diag([-1.0 if mirror else 1.0, 1.0]) @ page
    drawing = replace(DRAWING, user_to_page=np.column_stack((page, (3.0, 4.0))))
    told = Placement(scale=scale, rotate_deg=angle_deg, mirror=mirror)
    assert all(one.passed for one in map_findings(placed(linear, told), drawing, 0.05))
    other = replace(told, mirror=not mirror)
    assert [one.check for one in map_findings(placed(linear, other), drawing, 0.05)] == ["svg_to_arm_mm"]
    assert not map_findings(placed(linear, other), None, 0.05)[0].passed
    sheared = linear @ np.array([[1.0, 0.1], [0.0, 1.0]])
    assert "svg_to_arm_mm" in {
        one.check for one in map_findings(placed(sheared, told), drawing, 0.05) if not one.passed
    }


@pytest.mark.parametrize(
    ("told", "wanted"),
    [
        (Placement(), set()),
        (Placement(scale=1.0, rotate_deg=0.0), set()),
        (Placement(rotate_deg=360.0), set()),
        (Placement(scale=1.01), {"scale"}),
        (Placement(scale=-1.0), {"scale"}),
        (Placement(rotate_deg=90.0), {"rotation"}),
        (Placement(rotate_deg=0.2), {"rotation"}),
        (Placement(mirror=True), {"svg_to_arm_mm"}),
        (Placement(canvas_mm=(55, 105, -30, 15), margin_mm=5), set()),
        (Placement(canvas_mm=(55, 105, -30, 15), margin_mm=5.1), {"within the canvas"}),
        (Placement(canvas_mm=(61, 105, -30, 15)), {"within the canvas"}),
        (Placement(canvas_mm=(50, 99, -30, 15)), {"within the canvas"}),
    ],
)
def test_what_the_header_tells_has_to_be_so(told: Placement, wanted: set[str]) -> None:
    assert faults(replace(hand().trajectory(), placement=told)) == wanted


def test_without_the_drawing_a_mirror_and_the_canvas_are_seen() -> None:
    mirrored = replace(hand().trajectory(), svg_to_arm_mm=(0, 0.5, -0.5, 0, 100, 50))
    assert faults(mirrored, None) == {"svg_to_arm_mm"}
    small = replace(hand().trajectory(), placement=Placement(canvas_mm=(61, 105, -30, 15)))
    assert faults(small, None) == {"within the canvas"}


def without(*left_out: str) -> Trajectory:
    parts = Hand(60, 0)
    lines = [line for name, line in (("cornered", CORNERED), ("short", SHORT), ("dot", DOT)) if name not in left_out]
    for stroke, line in enumerate(lines):
        parts.draw(line, stroke)
    return parts.trajectory()


SHORT_MM = float(np.hypot(20, 5))


def test_what_was_left_out_as_asked_is_told() -> None:
    trajectory = replace(without("short", "dot"), left_out=LeftOut(SHORT_MM, 1))
    check_result = check_trajectory(trajectory, gantry(), DRAWING)
    assert check_result.passed
    assert "ok    nothing missing: left out as asked: 20.6 mm and 1 tap" in check_result.text()


@pytest.mark.parametrize(
    ("missing", "told"),
    [
        (("short", "dot"), LeftOut(SHORT_MM, 0)),
        (("short", "dot"), LeftOut(0.0, 1)),
        (("short",), LeftOut(SHORT_MM - 1, 0)),
        (("cornered",), LeftOut(SHORT_MM, 0)),
        (("cornered", "short"), LeftOut(40.0, 0)),
        (("short",), LeftOut(1e6, 0)),
        (("short",), LeftOut(SHORT_MM, 1)),
        ((), LeftOut(SHORT_MM, 0)),
    ],
)
def test_other_than_told_is_found(missing: tuple[str, ...], told: LeftOut) -> None:
    assert faults(replace(without(*missing), left_out=told)) == {"nothing missing"}
