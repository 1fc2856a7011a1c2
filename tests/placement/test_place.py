"""Placement is an exact similarity that keeps to the paper, and drawings of one page land in register."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from planner.affine import rotation
from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.drawing.drawing import Drawing, Outline
from planner.errors import DoesNotFit, UsageError
from planner.paper_size import Orientation, paper_size
from planner.placement.place import Placed, placed
from planner.settings import Anchor, CanvasKind, PlaceKind, PlanSettings
from planner.workspace.canvas import Canvas

CANVAS = Canvas(CanvasKind.USABLE, 40.0, 120.0, -75.0, 75.0)
WIDTH_MM, HEIGHT_MM = 150.0, 80.0
PAGE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 60.0], [0.0, 60.0]])

coordinate = st.floats(-500, 500)
boxes = st.tuples(coordinate, coordinate, st.floats(0.01, 800), st.floats(0.01, 800))


def drawing_of(*points: tuple[float, float], page: tuple[float, float] = (100.0, 60.0), per_mm: float = 1.0) -> Drawing:
    """Lines from each point to the next, in user units of which so many make a millimetre."""
    ends = np.array(points, dtype=float)
    if len(ends) == 1:
        ends = np.repeat(ends, 2, axis=0)
    curves = np.stack([ends[:-1] + share * np.diff(ends, axis=0) for share in (0, 1 / 3, 2 / 3, 1)], axis=1)
    to_page = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]) / per_mm
    return Drawing("drawn", (Outline(curves * per_mm),), to_page, page)


def inked(place: Placed) -> FloatArray:
    """(n, 2) ends of all lines of all copies, arm mm."""
    ends = np.concatenate([outline.beziers[:, (0, 3)].reshape(-1, 2) for outline in place.drawing.outlines])
    moved: FloatArray = ends @ place.svg_to_arm[:, :2].T + place.svg_to_arm[:, 2]
    return moved


def as_seen(place: Placed) -> FloatArray:
    """The same, mm to the right and down from the canvas' top left corner."""
    x, y = inked(place).T
    return np.column_stack((CANVAS.left_mm - y, CANVAS.far_mm - x))


INK = PlanSettings(place=PlaceKind.INK)


@hypothesis_settings(deadline=None, max_examples=50)
@given(boxes, st.floats(0.0, 39.0))
def test_fitted_ink_fills_the_canvas_within_its_margin(
    box: tuple[float, float, float, float], margin_mm: float
) -> None:
    left, top, width, height = box
    place = placed(drawing_of((left, top), (left + width, top + height)), CANVAS, replace(INK, margin_mm=margin_mm))
    low, high = as_seen(place).min(axis=0), as_seen(place).max(axis=0)
    room = np.concatenate((low, (WIDTH_MM, HEIGHT_MM) - high)) - margin_mm
    assert (room >= -1e-9).all() and min(room[0] + room[2], room[1] + room[3]) < 1e-9  # as large as can be
    np.testing.assert_allclose(room[:2], room[2:], atol=1e-9)  # and in the middle


@hypothesis_settings(deadline=None, max_examples=50)
@given(
    st.floats(-720, 720),
    st.booleans(),
    st.sampled_from(PlaceKind),
    st.lists(st.tuples(coordinate, coordinate), min_size=2),
)
def test_a_turned_drawing_fits_and_keeps_its_shape(
    angle_deg: float, mirror: bool, kind: PlaceKind, points: list[tuple[float, float]]
) -> None:
    if np.ptp(points, axis=0).max() < 0.1:
        return
    ends = np.array(points) - np.min(points, axis=0)
    drawing = drawing_of(*map(tuple, ends), page=(1000.0, 1000.0), per_mm=3.0)
    place = placed(drawing, CANVAS, PlanSettings(place=kind, rotate_deg=angle_deg, mirror=mirror))
    ink = as_seen(place)
    assert (ink >= 5.0 - 1e-8).all() and (ink <= np.array([WIDTH_MM, HEIGHT_MM]) - 5.0 + 1e-8).all()
    linear = place.svg_to_arm[:, :2]
    factor = np.sqrt(abs(np.linalg.det(linear)))
    np.testing.assert_allclose(linear.T @ linear, factor**2 * np.eye(2), atol=1e-9 * factor**2)
    # The page's y points down: its mirror image lies before the arm.
    assert (np.linalg.det(linear) < 0) != mirror
    assert place.scale == pytest.approx(3.0 * factor)


@hypothesis_settings(deadline=None, max_examples=50)
@given(
    st.tuples(st.floats(0, 100), st.floats(0, 60)),
    st.tuples(st.floats(0, 100), st.floats(0, 60)),
    st.sampled_from([PlanSettings(), PlanSettings(fit=False), PlanSettings(scale=0.3, align=Anchor.BOTTOM_LEFT)]),
    st.sampled_from([0.0, 90.0, 33.0]),
    st.sampled_from([None, "a6", "90x70"]),
)
def test_drawings_of_one_page_land_in_register(
    one: tuple[float, float], other: tuple[float, float], how: PlanSettings, angle_deg: float, paper: str | None
) -> None:
    how = replace(how, rotate_deg=angle_deg, skip_unreachable=True, paper=paper and paper_size(paper))
    maps = [placed(drawing_of(point), CANVAS, how).svg_to_arm for point in (one, other)]
    np.testing.assert_array_equal(*maps)


def test_ink_alone_is_placed_where_there_is_no_page() -> None:
    lines = drawing_of((10.0, 10.0), (20.0, 15.0))
    without = replace(lines, has_page=False)
    np.testing.assert_array_equal(
        placed(without, CANVAS, PlanSettings()).svg_to_arm, placed(lines, CANVAS, INK).svg_to_arm
    )
    assert placed(lines, CANVAS, PlanSettings()).scale == pytest.approx(70.0 / 60.0)


@pytest.mark.parametrize(("anchor", "low"), [("top-left", (5, 5)), ("right", (115, 25)), ("bottom", (60, 45))])
def test_ink_is_aligned(anchor: str, low: tuple[float, float]) -> None:
    lines = drawing_of((0.0, 0.0), (30.0, 30.0))
    place = placed(lines, CANVAS, replace(INK, fit=False, align=Anchor(anchor)))
    np.testing.assert_allclose(as_seen(place).min(axis=0), low, atol=1e-9)


def test_a_drawing_is_put_where_it_is_wanted_on_the_paper() -> None:
    settings = PlanSettings(paper=paper_size("100x60"), at_mm=(30.0, 20.0), scale=0.5, origin=Anchor.CENTRE)
    place = placed(drawing_of((50.0, 30.0), (60.0, 40.0)), CANVAS, settings)
    np.testing.assert_allclose(as_seen(place), [(55, 30), (60, 35)], atol=1e-9)
    assert place.told.margin_mm == 0.0


@pytest.mark.parametrize(("fit", "step"), [(True, (130.0 / 3 + 5.0, 65.0 / 2 + 5.0)), (False, (25.0, 15.0))])
def test_copies_lie_in_rows_and_columns(fit: bool, step: tuple[float, float]) -> None:
    place = placed(drawing_of((0.0, 0.0), (20.0, 10.0), per_mm=4.0), CANVAS, replace(INK, copies=(3, 2), fit=fit))
    starts = as_seen(place)[::2]
    offsets = [(column * step[0], row * step[1]) for row in range(2) for column in range(3)]
    np.testing.assert_allclose(starts - starts[0], offsets, atol=1e-9)
    assert place.told.copies is not None and place.told.copies.count == 6


@pytest.mark.parametrize(
    ("paper", "orientation", "sides"),
    [
        ("a7", Orientation.AUTO, (43.0, 117.0, -52.5, 52.5)),
        ("a7", Orientation.PORTRAIT, (40.0, 120.0, -37.0, 37.0)),  # as much of it as is canvas
        ("60x70", Orientation.AUTO, (45.0, 115.0, -30.0, 30.0)),
        ("60x70", Orientation.LANDSCAPE, (50.0, 110.0, -35.0, 35.0)),
    ],
)
def test_paper_lies_amid_the_canvas(paper: str, orientation: Orientation, sides: tuple[float, ...]) -> None:
    settings = PlanSettings(paper=paper_size(paper), orientation=orientation)
    place = placed(drawing_of((1.0, 1.0), (9.0, 5.0)), CANVAS, settings)
    assert place.told.canvas_mm == sides
    assert place.board.where(PaperPose()).startswith(f"lay the {'A7' if paper == 'a7' else paper} (")


def test_a_turn_that_makes_it_much_larger_is_hinted_at() -> None:
    tall = drawing_of((0.0, 0.0), (60.0, 100.0), page=(60.0, 140.0))
    (hint,) = placed(tall, CANVAS, PlanSettings()).notes
    assert hint.startswith("--rotate 90 would make it 2 times as large")
    assert placed(tall, CANVAS, PlanSettings(rotate_deg=90)).notes == ()
    assert placed(tall, CANVAS, PlanSettings(fit=False, skip_unreachable=True)).notes == ()


@pytest.mark.parametrize(
    ("angle_deg", "moved"), [(0, (1, 0)), (90, (0, 1)), (180, (-1, 0)), (-90, (0, -1)), (450, (0, 1))]
)
def test_right_angles_are_exact_and_clockwise_on_the_page(angle_deg: float, moved: tuple[float, float]) -> None:
    np.testing.assert_array_equal(rotation(angle_deg)[:, :2] @ (1.0, 0.0), moved)


def test_a_single_dot_lies_in_the_middle_at_its_size() -> None:
    place = placed(drawing_of((7.0, -3.0)), CANVAS, INK)
    np.testing.assert_allclose(inked(place)[0], [80.0, 0.0], atol=1e-12)
    assert place.scale == 1.0


@pytest.mark.parametrize("size", [(140.1, 10.0), (10.0, 70.1)])
def test_ink_kept_at_its_size_has_to_fit(size: tuple[float, float]) -> None:
    lines = drawing_of((3.0, 4.0), (3.0 + size[0], 4.0 + size[1]))
    with pytest.raises(DoesNotFit, match=rf"{size[0]:.1f} x {size[1]:.1f} mm") as caught:
        placed(lines, CANVAS, replace(INK, fit=False))
    assert caught.value.exit_code == 3
    placed(lines, CANVAS, replace(INK, fit=False, margin_mm=4.9))


def test_a_page_at_its_true_size_may_be_larger_than_the_canvas_but_its_ink_may_not() -> None:
    placed(drawing_of((60.0, 30.0), (140.0, 70.0), page=(200.0, 100.0)), CANVAS, PlanSettings(fit=False))
    with pytest.raises(DoesNotFit, match=r"5\.0 mm over the left side"):
        placed(drawing_of((20.0, 30.0), (140.0, 70.0), page=(200.0, 100.0)), CANVAS, PlanSettings(fit=False))


def test_a_scale_that_leaves_a_dot_is_refused_but_dots_are_drawn_at_any() -> None:
    with pytest.raises(UsageError, match="a scale of 1e-06 leaves nothing to see of the drawing: choose a larger one"):
        placed(drawing_of((0.0, 0.0), (60.0, 50.0)), CANVAS, PlanSettings(scale=1e-6))
    assert placed(drawing_of((7.0, 3.0)), CANVAS, PlanSettings(scale=1e-6)).scale == 1e-6


@pytest.mark.parametrize("fit", [True, False])
def test_a_margin_has_to_leave_room(fit: bool) -> None:
    with pytest.raises(UsageError, match="40 mm"):
        placed(drawing_of((0.0, 0.0), (1.0, 1.0)), CANVAS, replace(INK, margin_mm=HEIGHT_MM / 2, fit=fit))


@pytest.mark.parametrize(
    ("options", "fault"),
    [
        ({"fit": True, "at_mm": (1.0, 2.0)}, "fit and at"),
        ({"fit": True, "scale": 2.0}, "fit and scale"),
        ({"at_mm": (1.0, 2.0), "align": "left"}, "at and align"),
        ({"origin": "centre"}, "no at"),
        ({"orientation": "portrait"}, "no paper"),
        ({"copies": (0, 3)}, "copies"),
        ({"copies": (100, 100)}, "more than 1000"),
        ({"at_mm": (float("nan"), 2.0)}, "at"),
        ({"scale": 0.0}, "scale"),
        ({"paper": "a5"}, "paper"),
    ],
)
def test_choices_that_contradict_each_other_are_refused(options: dict[str, object], fault: str) -> None:
    with pytest.raises(UsageError, match=fault):
        PlanSettings(**options)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "text", ["", "a11", "foolscap", "100", "100x", "0x10", "-5x10", "1e3x5", "100000x5", "5x5miles"]
)
def test_what_is_no_paper_is_refused(text: str) -> None:
    with pytest.raises(UsageError):
        paper_size(text)


@pytest.mark.parametrize(
    ("text", "size"), [("A4", (210, 297)), ("a6", (105, 148)), ("4x6in", (101.6, 152.4)), ("10cm x 8cm", (100, 80))]
)
def test_paper_goes_by_name_and_by_size(text: str, size: tuple[float, float]) -> None:
    paper = paper_size(text)
    assert (paper.width_mm, paper.height_mm) == pytest.approx(size)
