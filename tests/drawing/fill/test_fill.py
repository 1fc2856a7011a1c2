"""Fills cover what they should, as densely as asked, and nothing else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, MultiLineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray
from planner.drawing.drawing import Drawing
from planner.drawing.fill.areas import n_areas
from planner.drawing.fill.contour import contours, spirals
from planner.drawing.fill.fill import fill_lines, with_fills
from planner.drawing.fill.hatch import hatched
from planner.drawing.fill_options import NO_FILL, FillBy, FillKind, FillOptions, WideStrokes, fill_options
from planner.drawing.flatten import flatten_all
from planner.drawing.source import SvgInMemory
from planner.drawing.svg import read_drawing
from planner.errors import PlanError, UsageError

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100" width="100mm" height="100mm">'
TRUE_SIZE = np.array([[0.0, -1.0, 100.0], [-1.0, 0.0, 50.0]])

stars = st.tuples(st.integers(5, 12), st.floats(4.0, 20.0), st.floats(22.0, 40.0), st.booleans()).map(
    lambda told: _star(*told)
)


def _star(n: int, inner: float, outer: float, has_hole: bool) -> BaseGeometry:
    angles = np.arange(2 * n) * np.pi / n
    radii = np.where(np.arange(2 * n) % 2, inner, outer)
    star = Polygon(np.column_stack((radii * np.cos(angles), radii * np.sin(angles))))
    return star.difference(Point(1.0, 2.0).buffer(3.0)) if has_hole else star


def inked(lines: list[FloatArray]) -> MultiLineString:
    return MultiLineString([LineString(line) for line in lines])


def read(body: str) -> Drawing:
    return read_drawing(SvgInMemory("drawn", f"{HEAD}{body}</svg>".encode()))


def on_paper(drawing: Drawing, options: FillOptions) -> list[FloatArray]:
    return flatten_all(fill_lines(drawing, options, TRUE_SIZE), TRUE_SIZE, 1e-4)


@settings(deadline=None, max_examples=30)
@given(stars, st.floats(-3.2, 3.2), st.floats(0.3, 0.8))
def test_a_hatch_is_as_dense_as_asked_and_stays_inside(area: BaseGeometry, angle_rad: float, spacing_mm: float) -> None:
    lines = inked(hatched(area, angle_rad, spacing_mm))
    assert lines.difference(area.buffer(1e-5)).length < 1e-6
    rows = inked([line[k : k + 2] for line in hatched(area, angle_rad, spacing_mm) for k in range(0, len(line) - 1, 2)])
    assert rows.length * spacing_mm == pytest.approx(area.area, rel=0.03, abs=0.1 * spacing_mm * area.length)
    # Nothing inside is further from a line than half of the spacing, but for what the ends of rows leave at the edge.
    assert area.buffer(-spacing_mm).difference(rows.buffer(0.51 * spacing_mm)).area < 0.01 * area.area


@settings(deadline=None, max_examples=20)
@given(stars, st.floats(0.4, 2.0))
def test_contours_and_spirals_cover_an_area_and_stay_inside(area: BaseGeometry, spacing_mm: float) -> None:
    levels = contours(area, spacing_mm)
    rings = inked([ring for level in levels for ring in level])
    lines = spirals(levels, area, spacing_mm)
    spiral = inked(lines)
    for drawn in (rings, spiral):
        assert drawn.difference(area.buffer(0.03 * spacing_mm)).length < 1e-6
    assert rings.difference(spiral.buffer(1e-6)).length < 1e-6
    assert len(lines) <= sum(map(len, levels))
    assert area.difference(rings.buffer(0.75 * spacing_mm)).area < 0.04 * area.area


def test_a_plain_disc_is_one_spiral() -> None:
    disc = Point(0.0, 0.0).buffer(20.0)
    assert len(spirals(contours(disc, 1.0), disc, 1.0)) == 1
    assert len(hatched(disc, 0.3, 1.0)) <= 3  # the caps by themselves


@pytest.mark.parametrize("kind", [kind for kind in FillKind if kind is not FillKind.NONE])
def test_rules_islands_clips_and_the_page_hold(kind: FillKind) -> None:
    drawing = read(
        '<clipPath id="c"><rect width="70" height="100"/></clipPath>'
        '<path clip-path="url(#c)" fill-rule="evenodd" d="M10 10h120v80h-120zM30 30v30h20v-30z"/>'
    )
    seen = Polygon([(10, 10), (70, 10), (70, 90), (10, 90)]).difference(shapely.box(30, 30, 50, 60))
    area = shapely.transform(seen, lambda points: points @ TRUE_SIZE[:, :2].T + TRUE_SIZE[:, 2])
    lines = inked(on_paper(drawing, FillOptions(kind, spacing_mm=1.0, inset_mm=0.5)))
    assert lines.difference(area.buffer(-0.48)).length < 1e-3
    assert area.difference(lines.buffer(1.1)).area < 1.0


def test_what_is_painted_later_is_left_free_and_what_is_white_is_paper() -> None:
    drawing = read(
        '<rect width="100" height="100" fill="#fff"/><circle cx="50" cy="50" r="40" fill="red"/>'
        '<circle cx="50" cy="50" r="20" fill="white"/><rect x="45" y="45" width="10" height="10"/>'
    )
    options = FillOptions(FillKind.HATCH, spacing_mm=0.5, inset_mm=0.0)
    lines = inked(on_paper(drawing, options))
    middle = Point(50.0, 0.0)  # of the page, on the paper
    assert lines.intersection(middle.buffer(19.9).difference(middle.buffer(8.0))).is_empty
    assert lines.intersection(middle.buffer(4.0)).length > 50.0
    assert drawing.scene is not None and n_areas(drawing.scene) == 2
    colours = {outline.colour for outline in fill_lines(drawing, options, TRUE_SIZE)}
    assert colours == {(255, 0, 0), (0, 0, 0)}


def test_dark_is_denser_than_light_in_proportion() -> None:
    def length(colour: str) -> float:
        drawing = read(f'<rect x="10" y="10" width="80" height="80" fill="{colour}"/>')
        return float(inked(on_paper(drawing, FillOptions(FillKind.HATCH, spacing_mm=0.4, by=FillBy.LIGHTNESS))).length)

    black, grey = length("#000"), length("#bcbcbc")  # which sends back half of the light
    assert grey / black == pytest.approx(0.5, abs=0.03)


def test_wide_strokes_are_drawn_as_wide_as_they_are() -> None:
    drawing = read(
        '<path d="M20 50H80" stroke="#00f" stroke-width="6" fill="none"/><path d="M20 80H80" stroke="#000"/>'
    )
    options = FillOptions(wide_strokes=WideStrokes.PASSES, spacing_mm=1.0)
    filled = with_fills(drawing, options, TRUE_SIZE)
    lines = inked(flatten_all(filled.outlines, TRUE_SIZE, 1e-3))
    wide = shapely.transform(
        LineString([(20, 50), (80, 50)]).buffer(3.0), lambda p: p @ TRUE_SIZE[:, :2].T + TRUE_SIZE[:, 2]
    )
    ink = lines.buffer(0.5)
    assert wide.difference(ink).area < 0.01 * wide.area
    assert lines.intersection(wide).difference(wide.buffer(-0.49)).length < 1e-6
    assert len(filled.outlines) > 3 and filled.outlines[0].width > 0


@given(
    st.sampled_from(FillKind),
    st.floats(-400, 400),
    st.floats(0.05, 20),
    st.none() | st.floats(0, 5),
    st.sampled_from(WideStrokes),
)
def test_options_go_through_the_header(
    kind: FillKind, angle: float, spacing: float, inset: float | None, wide: WideStrokes
) -> None:
    options = FillOptions(kind, angle, spacing, inset, FillBy.LIGHTNESS, wide)
    assert fill_options(str(options)) == options


@pytest.mark.parametrize(
    "text", ["", "hatch", "hatch,45,0,,nothing,line", "stars,45,1,,nothing,line", "hatch,nan,1,,nothing,line"]
)
def test_what_says_nothing_of_fills_is_refused(text: str) -> None:
    with pytest.raises(UsageError):
        fill_options(text)


def test_too_many_lines_are_refused(tmp_path: Path) -> None:
    with pytest.raises(PlanError, match="wider --fill-spacing"):
        hatched(shapely.box(0, 0, 1e6, 1e6), 0.0, 0.1)
    assert not fill_lines(read('<rect width="9" height="9"/>'), NO_FILL, TRUE_SIZE)


def test_lines_have_nothing_to_be_filled() -> None:
    drawing = read('<path d="M5 5L90 50M5 5h9" stroke="red"/><path d="M20 50h30v30z" stroke="red"/>')
    assert drawing.scene is not None and n_areas(drawing.scene) == 1
