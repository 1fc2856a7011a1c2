"""Laws of the sheet's layout: whatever the marks, tags keep clear of them, of each other and of the base."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.error_model.sheet.layout import (
    BAR_MM,
    BASE_RING_MM,
    N_DIGITS,
    QUIET_MM,
    TAG_MM,
    Page,
    PaperSize,
    drawable_mm,
    layout_on,
    pages_of,
    sheet_for,
)
from planner.error_model.sheet.marks import Mark
from planner.errors import PlanError

STRAY_MM = 8.0


@st.composite
def marks_on_a_page(draw: st.DrawFn) -> tuple[Page, list[Mark]]:
    page = draw(st.sampled_from(pages_of(tuple(PaperSize))))
    room = np.array(page.room_mm) - 1
    middle = np.array([draw(st.floats(-50, 400)), draw(st.floats(-100, 100))])
    shares = draw(st.lists(st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)), min_size=1, max_size=12))
    return page, [Mark(k, float(k), tuple((middle + room * share).tolist())) for k, share in enumerate(shares)]


@given(marks_on_a_page())
@settings(max_examples=60, deadline=None)
def test_marks_may_stray_and_tags_stay_clear(case: tuple[Page, list[Mark]]) -> None:
    page, marks = case
    layout = layout_on(page, marks)
    assert layout is not None
    assert len(layout.tag_places) >= 12 and len(set(layout.tag_ids)) == len(layout.tag_ids)
    assert [number // N_DIGITS for number in layout.tag_ids] == list(layout.tag_places)
    places = layout.to_page_mm(np.array([mark.place_mm for mark in marks]))
    np.testing.assert_allclose(layout.to_sheet_mm(places), [mark.place_mm for mark in marks], atol=1e-9)
    low, high = layout.ink_page_mm
    assert np.all(places >= low + STRAY_MM - 1e-6) and np.all(places <= high - STRAY_MM + 1e-6)
    boxes = [layout.tag_corners_page_mm(place) for place in layout.tag_places]
    for k, box in enumerate(boxes):
        least, most = box.min(axis=0), box.max(axis=0)
        assert np.all(least >= 5.0) and np.all(most <= np.array(page.extent_mm) - 5.0)
        assert np.any(most <= low + 1e-9) or np.any(least >= high - 1e-9)
        nearest = np.clip(layout.origin_page_mm, least, most)
        assert math.dist(nearest, layout.origin_page_mm) >= BASE_RING_MM
        for other in boxes[:k]:
            apart = np.maximum(least - other.max(axis=0), other.min(axis=0) - most).max()
            assert apart >= 2 * QUIET_MM
    for start, end in layout.bars_page_mm:
        assert math.dist(start, end) == pytest.approx(BAR_MM)
        assert np.all(np.minimum(start, end) >= low) and np.all(np.maximum(start, end) <= high)


@given(marks_on_a_page(), st.sampled_from([0, 1]), st.sampled_from([-0.001, 0.001]))
@settings(max_examples=30, deadline=None)
def test_another_pattern_is_another_sheet(case: tuple[Page, list[Mark]], axis: int, by: float) -> None:
    """One mark a thousandth of a millimetre elsewhere, and nearly all tags differ."""
    page, marks = case
    x, y = marks[0].place_mm
    moved = Mark(0, 0.0, (x + by, y) if axis == 0 else (x, y + by))
    layout, other = layout_on(page, marks), layout_on(page, [moved, *marks[1:]])
    assert layout is not None and other is not None
    assert len(set(layout.tag_ids) & set(other.tag_ids)) <= 5
    assert layout.name != other.name


def test_a_tag_has_room_for_its_white_border() -> None:
    assert QUIET_MM >= TAG_MM / 8


@pytest.mark.parametrize("size", list(PaperSize))
def test_what_is_drawable_fits_on_the_sheet_and_no_more_does(size: PaperSize) -> None:
    low, high = drawable_mm((-100.0, -900.0), (900.0, 900.0), size)
    corners = [Mark(0, 0.0, tuple(low.tolist())), Mark(1, 1.0, tuple(high.tolist()))]
    assert sheet_for(corners, size).page.size is size
    with pytest.raises(PlanError, match="room for"):
        sheet_for([*corners, Mark(2, 2.0, (high[0] + 2, high[1]))], size)


def test_a_small_box_is_drawable_as_it_is() -> None:
    low, high = drawable_mm((60.0, -40.0), (120.0, 40.0))
    np.testing.assert_allclose([low, high], [[60, -40], [120, 40]])
