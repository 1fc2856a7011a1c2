"""What is drawn of a scene: clips, the page, later paint, backgrounds, repeats."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray
from planner.drawing.drawing import Outline
from planner.drawing.options import ReadingOptions
from planner.drawing.outlines import REPEAT_LIMIT, outlines
from planner.drawing.scene.shape import Paint, Scene, Shape, Stroke
from planner.drawing.subpath import Subpath, polyline

INK, WHITE = Paint((0, 0, 0), True), Paint((255, 255, 255), True)
SEEN = ReadingOptions(occlude=True)


def rectangle(x: float, y: float, width: float, height: float) -> Subpath:
    return polyline(np.array([(x, y), (x + width, y), (x + width, y + height), (x, y + height)]), is_closed=True)


def filled(path: Subpath, paint: Paint = INK, clips: tuple[BaseGeometry, ...] = ()) -> Shape:
    return Shape((path,), (path,), paint, False, None, clips, "")


def stroked(path: Subpath, clips: tuple[BaseGeometry, ...] = ()) -> Shape:
    return Shape((path,), (path,), None, False, Stroke(INK, 2.0), clips, "pens")


def line(*points: tuple[float, float]) -> Subpath:
    return polyline(np.array(points, dtype=np.float64))


def scene(*shapes: Shape, scale: float = 0.5) -> Scene:
    """On a page of 100 by 100 user units."""
    user_to_page = np.array([[scale, 0.0, 0.0], [0.0, scale, 0.0]])
    return Scene(shapes, user_to_page, (100.0 * scale, 100.0 * scale), Counter())


def ends(drawn: Sequence[Outline]) -> list[list[float]]:
    return [[*outline.beziers[0, 0].tolist(), *outline.beziers[-1, 3].tolist()] for outline in drawn]


def length(drawn: Sequence[Outline]) -> float:
    """Of straight lines."""
    return float(sum(np.hypot(*(outline.beziers[:, 3] - outline.beziers[:, 0]).T).sum() for outline in drawn))


def test_an_outline_knows_its_layer_its_colour_and_its_width() -> None:
    (drawn,), _ = outlines(scene(stroked(line((1, 1), (2, 2)))), ReadingOptions())
    assert (drawn.layer, drawn.colour, drawn.width) == ("pens", (0, 0, 0), 2.0)
    (edge,), _ = outlines(scene(filled(rectangle(1, 1, 5, 5), WHITE)), ReadingOptions())
    assert (edge.layer, edge.colour, edge.width) == ("", (255, 255, 255), 0.0)


def test_all_clips_cut() -> None:
    one, other = shapely.box(10, 0, 90, 100), shapely.box(0, 0, 50, 100)
    drawn, left_out = outlines(
        scene(stroked(line((0, 20), (100, 20)), (one, other)), stroked(line((0, 30), (100, 30)), (one,))),
        ReadingOptions(),
    )
    assert ends(drawn) == [pytest.approx([10, 20, 50, 20]), pytest.approx([10, 30, 90, 30])]
    assert not left_out


def test_ink_beyond_the_page_is_cut_and_told() -> None:
    shapes = stroked(line((50, 50), (150, 50))), stroked(line((120, 0), (120, 9))), stroked(rectangle(0, 0, 100, 100))
    drawn, left_out = outlines(scene(*shapes), ReadingOptions())
    assert ends(drawn) == [pytest.approx([50, 50, 100, 50]), [0, 0, 0, 0]]
    assert left_out == {"ink beyond the page": 2}
    drawn, left_out = outlines(scene(*shapes), ReadingOptions(crop="none"))
    assert len(drawn) == 3
    assert not left_out


def test_what_is_on_the_page_is_not_touched() -> None:
    frame = rectangle(0, 0, 100, 100 + 1e-7)
    drawn, left_out = outlines(scene(stroked(frame)), ReadingOptions())
    assert drawn[0].beziers is frame.beziers
    assert not left_out


@pytest.mark.parametrize(
    ("background", "is_left_out"),
    [
        (filled(rectangle(0, 0, 100, 100), WHITE), True),
        (filled(rectangle(-5, -5, 120, 120), INK), True),
        (filled(rectangle(0, 0, 100, 100), WHITE, (shapely.box(0, 0, 100, 100),)), True),
        (filled(rectangle(0, 0, 100, 100), WHITE, (shapely.box(0, 0, 50, 100),)), False),
        (filled(rectangle(0, 0, 100, 90), WHITE), False),
        (stroked(rectangle(0, 0, 100, 100)), False),
        (filled(line((-300, -300), (300, -300), (50, 400), (-300, -300))), False),
    ],
)
def test_a_rectangle_as_large_as_the_page_is_paper(background: Shape, is_left_out: bool) -> None:
    drawn, left_out = outlines(scene(background, stroked(line((1, 1), (2, 2)))), ReadingOptions(crop="none"))
    assert len(drawn) == 1 + (not is_left_out)
    assert left_out["background"] == is_left_out


def test_a_background_alone_is_drawn() -> None:
    drawn, left_out = outlines(scene(filled(rectangle(0, 0, 100, 100), WHITE)), ReadingOptions())
    assert len(drawn) == 1
    assert not left_out


def test_a_fill_without_area_shows_nothing_and_a_stroke_does() -> None:
    there_and_back = line((5, 5), (50, 50), (5, 5))
    eight = line((10, 10), (20, 20), (20, 10), (10, 20), (10, 10))
    assert outlines(scene(filled(there_and_back)), ReadingOptions())[0] == ()
    assert len(outlines(scene(filled(eight)), ReadingOptions())[0]) == 1
    assert len(outlines(scene(stroked(there_and_back)), ReadingOptions())[0]) == 1


def test_the_same_line_is_drawn_so_often_and_no_more() -> None:
    shapes = [stroked(line((1, 1), (2, 2))) for _ in range(REPEAT_LIMIT + 3)]
    drawn, left_out = outlines(scene(*shapes), ReadingOptions())
    assert len(drawn) == REPEAT_LIMIT
    assert left_out.total() == 3


def test_lines_under_later_fills_are_hidden_if_asked_for() -> None:
    below, above = stroked(line((0, 50), (100, 50))), filled(rectangle(40, 40, 20, 20), WHITE)
    drawn, _ = outlines(scene(below, above), SEEN)
    assert ends(drawn[:-1]) == [pytest.approx([0, 50, 40, 50]), pytest.approx([60, 50, 100, 50])]
    assert len(outlines(scene(above, below), SEEN)[0]) == 2
    assert len(outlines(scene(below, above), ReadingOptions())[0]) == 2


def test_what_can_be_seen_through_hides_nothing() -> None:
    below, glass = stroked(line((0, 50), (100, 50))), filled(rectangle(40, 40, 20, 20), Paint((9, 9, 9), False))
    assert len(outlines(scene(below, glass), SEEN)[0]) == 2


def test_a_clipped_fill_hides_what_is_under_what_is_left_of_it() -> None:
    below = stroked(line((0, 50), (100, 50)))
    above = filled(rectangle(40, 40, 20, 20), WHITE, (shapely.box(0, 0, 50, 100),))
    drawn, _ = outlines(scene(below, above), SEEN)
    assert ends(drawn[:2]) == [pytest.approx([0, 50, 40, 50]), pytest.approx([50, 50, 100, 50])]


def test_an_edge_that_two_fills_share_is_drawn_once() -> None:
    drawn, _ = outlines(scene(filled(rectangle(0, 0, 20, 20)), filled(rectangle(20, 0, 20, 20))), SEEN)
    assert length(drawn) == pytest.approx(60 + 80)


squares = st.tuples(*[st.integers(0, 60)] * 2, *[st.integers(5, 40)] * 2)


@settings(max_examples=60, deadline=None)
@given(st.lists(squares, min_size=1, max_size=12))
def test_what_is_seen_is_what_no_later_fill_covers(sides: list[tuple[int, int, int, int]]) -> None:
    drawn, _ = outlines(scene(*(filled(rectangle(*map(float, one))) for one in sides)), SEEN)
    seen: BaseGeometry = shapely.MultiLineString()
    boxes = [shapely.box(x, y, x + width, y + height) for x, y, width, height in sides]
    for index, box in enumerate(boxes):
        edge = box.exterior
        for later in boxes[index + 1 :]:
            edge = shapely.difference(edge, later)
        seen = shapely.union(seen, edge)
    assert length(drawn) == pytest.approx(seen.length, abs=1e-6)


def test_stacked_fills_are_soon_told() -> None:
    shapes = [filled(rectangle(10 + 1e-3 * index, 10, 50, 50)) for index in range(300)]
    drawn, _ = outlines(scene(*reversed(shapes)), SEEN)
    points: FloatArray = np.concatenate([outline.beziers.reshape(-1, 2) for outline in drawn])
    assert points[:, 0].min() == 10.0
