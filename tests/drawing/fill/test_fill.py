"""Fills cover what they should, as densely as asked, and nothing else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from shapely import LineString, MultiLineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray
from planner.checking.filled import filled
from planner.drawing.drawing import Drawing
from planner.drawing.fill.areas import lightness, n_areas
from planner.drawing.fill.contour import contours, spirals
from planner.drawing.fill.fill import fill_lines, with_fills
from planner.drawing.fill.hatch import hatched
from planner.drawing.fill_options import NO_FILL, FillBy, FillKind, FillOptions, WideStrokes, fill_options
from planner.drawing.flatten import flatten_all
from planner.drawing.source import SvgInMemory
from planner.drawing.svg import read_drawing
from planner.errors import PlanError, UsageError
from planner.pens import colour_of

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100" width="100mm" height="100mm">'
KINDS = [kind for kind in FillKind if kind is not FillKind.NONE]
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


corners = st.tuples(st.floats(8.0, 92.0), st.floats(8.0, 92.0))
rings = st.lists(st.lists(corners, min_size=3, max_size=8), min_size=1, max_size=4)


@settings(deadline=None, max_examples=60)
@given(
    rings,
    st.sampled_from(["evenodd", "nonzero"]),
    st.sampled_from(KINDS),
    st.floats(0.5, 1.2),
    st.none() | st.just(0.0) | st.floats(0.01, 2.0),
    st.floats(-180.0, 180.0),
)
@example(
    [
        [(8.0, 8.0), (81.0, 60.0), (85.6875, 35.25), (62.0, 92.0)],
        [(8.0, 16.0), (19.3125, 22.71875), (91.96875, 66.0390625)],
    ],
    "evenodd",
    FillKind.HATCH,
    1.0,
    None,
    0.0,
)
def test_any_area_is_covered_and_nothing_else(
    drawn: list[list[tuple[float, float]]], rule: str, kind: FillKind, spacing: float, inset: float | None, angle: float
) -> None:
    """Rings that cross each other and themselves, by either rule, as the check knows what they fill."""
    path = " ".join("M" + " ".join(f"{x:.4f},{y:.4f}" for x, y in ring) + "z" for ring in drawn)
    options = FillOptions(kind, angle, spacing, inset)
    polylines = [np.round(ring, 4) @ TRUE_SIZE[:, :2].T + TRUE_SIZE[:, 2] for ring in drawn]
    area = filled(polylines, rule == "evenodd")
    assume(area.area > 1.0)
    inner = area.buffer(-options.from_edge_mm)
    lines = inked(on_paper(read(f'<path fill-rule="{rule}" d="{path}"/>'), options))
    # An edge that the library moves in has been made simpler before: what is outside of that may yet be far enough in.
    beyond = lines.difference(inner.buffer(1e-3))
    is_in = area.covers(beyond) and beyond.distance(area.boundary) >= options.from_edge_mm - 1e-3
    assert beyond.length < 1e-3 or is_in
    ink = lines.buffer(0.501 * spacing, quad_segs=4)  # within the round ink, and made in half the time
    # A sliver that is narrower than the spacing may lie between two rows.
    slivers = inner.difference(inner.buffer(-0.5 * spacing).buffer(0.5 * spacing)).area
    assert inner.difference(ink).area <= 0.02 * inner.area + slivers + spacing * (0.1 * inner.length + spacing)


@settings(deadline=None, max_examples=30)
@given(stars, st.floats(-3.2, 3.2), st.floats(0.3, 0.8))
def test_a_hatch_is_as_dense_as_asked(area: BaseGeometry, angle_rad: float, spacing_mm: float) -> None:
    lines = hatched(area, angle_rad, spacing_mm)
    turn = np.array([[np.cos(angle_rad), -np.sin(angle_rad)], [np.sin(angle_rad), np.cos(angle_rad)]])
    pieces = np.concatenate([np.stack((line[:-1], line[1:]), axis=1) for line in lines])
    level = pieces @ turn
    is_row = np.ptp(level[:, :, 1], axis=1) < 1e-6
    rows = np.ptp(level[is_row, :, 0], axis=1).sum()
    assert rows * spacing_mm == pytest.approx(area.area, rel=0.03, abs=0.1 * spacing_mm * area.length)
    # From row to row the pen stays down, and what it draws for that lies on the edge.
    if not is_row.all():
        beside = inked(list(pieces[~is_row]))
        assert beside.difference(area.boundary.buffer(1e-6)).length < 1e-6


@pytest.mark.parametrize(
    ("area", "at_most"),
    [
        (shapely.box(-20.0, -15.0, 20.0, 15.0), 1),
        (Point(0.0, 0.0).buffer(20.0, 64).difference(Point(1.0, 2.0).buffer(8.0, 64)), 4),
        (Point(0.0, 0.0).buffer(20.0, 64).difference(Point(10.0, 2.0).buffer(16.0, 64)), 3),
        (shapely.box(-20.0, -3.0, 20.0, 3.0).union(shapely.box(-3.0, -20.0, 3.0, 20.0)), 3),
    ],
)
def test_the_pen_stays_down(area: BaseGeometry, at_most: int) -> None:
    for angle in (0.0, 0.3, 1.2, np.pi / 2):
        assert len(hatched(area, angle, 0.5)) <= at_most
        assert len(hatched(area, angle, 0.25, is_zigzag=True)) <= at_most
    assert len(spirals(contours(area, 0.5), 0.5)) <= at_most + 2


@settings(deadline=None, max_examples=20)
@given(stars, st.floats(0.4, 2.0))
def test_a_spiral_is_the_contours_in_fewer_lines(area: BaseGeometry, spacing_mm: float) -> None:
    levels = contours(area, spacing_mm)
    separate = [line for level in levels for line in level.lines]
    lines = spirals(levels, spacing_mm)
    assert inked(separate).difference(inked(lines).buffer(1e-6)).length < 1e-6
    assert len(lines) <= len(separate)
    assert inked(lines).length <= inked(separate).length + 1.5 * spacing_mm * len(separate) + 1e-6


@pytest.mark.parametrize("width_mm", np.arange(1.05, 4.0, 0.35).tolist())
def test_no_middle_of_a_narrow_area_is_left_free_by_contours(width_mm: float) -> None:
    area = shapely.box(0.0, 0.0, 40.0, width_mm)
    lines = spirals(contours(area.buffer(-0.25), 0.5), 0.5)
    assert area.difference(inked(lines).buffer(0.25)).area < 0.11 * 40.0


def test_a_plain_disc_is_one_spiral() -> None:
    disc = Point(0.0, 0.0).buffer(20.0)
    assert len(spirals(contours(disc, 1.0), 1.0)) == 1
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


@pytest.mark.parametrize("kind", KINDS)
def test_the_share_of_the_paper_that_ink_covers_is_the_tone(kind: FillKind) -> None:
    for colour in ("#000", "#5f5f5f", "#bcbcbc", "#e0e0e0"):
        drawing = read(f'<rect x="10" y="10" width="80" height="80" fill="{colour}"/>')
        lines = inked(on_paper(drawing, FillOptions(kind, spacing_mm=0.6, by=FillBy.LIGHTNESS)))
        share = lines.buffer(0.3, cap_style="flat", quad_segs=4).area / 80.0**2
        assert share == pytest.approx(1.0 - lightness(colour_of(colour)), abs=0.03), colour


@pytest.mark.parametrize("cap", ["butt", "round", "square"])
@pytest.mark.parametrize("path", ["M20 50H80", "M20 20L80 30L30 60", "M20 20h60v50z"])
def test_wide_strokes_are_drawn_as_wide_as_they_are(cap: str, path: str) -> None:
    drawing = read(
        f'<path d="{path}" stroke="#00f" stroke-width="6" fill="none" stroke-linecap="{cap}"/>'
        '<path d="M20 80H80" stroke="#000"/>'
    )
    options = FillOptions(wide_strokes=WideStrokes.PASSES, spacing_mm=1.0)
    drawn = with_fills(drawing, options, TRUE_SIZE)
    assert len(drawn.outlines) >= 2 and drawn.outlines[0].width > 0
    lines = inked(flatten_all(drawn.outlines[1:], TRUE_SIZE, 1e-3))
    (middle,) = flatten_all(drawing.outlines[:1], TRUE_SIZE, 1e-3)
    line = shapely.LinearRing(middle) if path.endswith("z") else LineString(middle)
    kind = {"butt": "flat"}.get(cap, cap)
    wide = line.buffer(3.0, quad_segs=32, cap_style=kind, join_style="mitre", mitre_limit=4.0)
    ink = shapely.make_valid(lines.buffer(0.5))
    assert wide.area - wide.intersection(ink).area < 0.03 * wide.area
    assert lines.difference(wide.buffer(-0.49, join_style="mitre")).length < 1e-6


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


@pytest.mark.parametrize("is_zigzag", [False, True])
def test_rows_between_the_parts_of_an_area_are_no_lines(is_zigzag: bool) -> None:
    """An i has a dot, and rows pass between the two."""
    letter = shapely.union_all([shapely.box(0.0, 0.0, 2.0, 10.0), shapely.box(0.0, 13.0, 2.0, 15.0)])
    lines = hatched(letter, 0.0, 0.5, is_zigzag=is_zigzag)
    assert lines and all(shapely.covers(letter.buffer(1e-6), shapely.LineString(line)) for line in lines)
