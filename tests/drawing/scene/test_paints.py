"""What can be seen of fills and strokes, and in which colour; patterns, markers, layers, the page."""

from __future__ import annotations

import math

import numpy as np
import pytest

from planner.drawing.options import ReadingOptions
from planner.drawing.scene import patterns
from tests.drawing.scene.shown import drawing, lines, scene

SQUARE = '<path {} d="M10 10H30V30H10z"/>'
OPEN = '<path {} d="M10 10H30V30H10"/>'


@pytest.mark.parametrize(
    ("attributes", "colour", "is_opaque"),
    [
        ('fill="red"', (255, 0, 0), True),
        ('fill="red" fill-opacity="50%"', (255, 0, 0), False),
        ('fill="red" opacity=".5"', (255, 0, 0), False),
        ('fill="currentColor" color="#0000ff"', (0, 0, 255), True),
        ('fill="url(#missing) lime"', (0, 255, 0), True),
        ('fill="url(#g)"', (128, 0, 128), True),
        ('fill="url(#h)"', (128, 0, 128), True),
        ('fill="url(#empty-pattern) lime"', (0, 255, 0), True),
    ],
)
def test_paints_that_can_be_seen(attributes: str, colour: tuple[int, int, int], is_opaque: bool) -> None:
    stops = '<stop stop-color="red"/><stop stop-color="blue"/>'
    defs = (
        f'<linearGradient id="g">{stops}</linearGradient><radialGradient id="h" href="#g"/>'
        '<pattern id="empty-pattern"/>'
    )
    (shape,) = scene(defs + SQUARE.format(attributes)).shapes
    assert shape.fill is not None
    assert shape.fill.colour == pytest.approx(colour, abs=1) and shape.fill.is_opaque is is_opaque


@pytest.mark.parametrize(
    "attributes",
    [
        'fill="none"',
        'fill="transparent"',
        'fill="url(#missing)"',
        'fill="url(#empty) red"',
        'fill="url(#hidden)"',
        'fill="context-fill"',
        'fill-opacity="0"',
        'opacity="0"',
        'visibility="hidden"',
        'fill="none" stroke="red" stroke-width="0"',
        'fill="none" stroke="red" stroke-opacity="0"',
        'transform="scale(0 1)"',
    ],
)
def test_paints_that_cannot_be_seen(attributes: str) -> None:
    defs = '<linearGradient id="empty"/><linearGradient id="hidden" display="none"><stop/></linearGradient>'
    assert not scene(defs + SQUARE.format(attributes)).shapes


def test_lines_of_strokes_and_edges_of_fills() -> None:
    square = [(10, 10), (30, 10), (30, 30), (10, 30)]
    assert lines(OPEN.format('fill="none" stroke="red"')) == [square]
    closed = [*square, square[0]]
    for paint in ('fill="red"', 'fill="red" stroke="blue"'):
        assert lines(OPEN.format(paint)) == [closed]
    assert lines('<path stroke="red" d="M1 1L5 5"/>') == [[(1, 1), (5, 5)]]
    dashed = lines(OPEN.format('stroke="red" stroke-dasharray="15 5"'))
    assert sorted(dashed) == sorted(
        [[(10, 10), (25, 10)], [(30, 10), (30, 25)], [(30, 30), (15, 30)], [(10, 30), (10, 10)]]
    )


@pytest.mark.parametrize(("cap", "n_taps"), [("butt", 0), ("round", 1), ("square", 1)])
def test_subpaths_without_length_are_taps_where_caps_show_them(cap: str, n_taps: int) -> None:
    found = drawing(f'<path stroke="red" d="M0 0H1"/><path stroke="red" stroke-linecap="{cap}" d="M5 5z M7 7"/>')
    assert len(found.outlines) == 1 + n_taps


def test_dashes_that_do_not_scale_are_measured_on_the_page() -> None:
    line = '<path {} stroke="red" stroke-dasharray="1" pathLength="4" transform="scale(10)" d="M0 0H4"/>'
    assert len(lines(line.format(""))) == 2
    plain = '<path {} stroke="red" stroke-dasharray="5" transform="scale(10)" d="M0 0H4"/>'
    assert len(lines(plain.format(""))) == 1
    assert len(lines(plain.format('vector-effect="non-scaling-stroke"'))) == 4


@pytest.mark.parametrize(
    "pattern",
    [
        '<pattern id="p" width="10" height="10" patternUnits="userSpaceOnUse">{}</pattern>',
        '<pattern id="p" width=".5" height=".5">{}</pattern>',
        '<pattern id="p" width=".5" height=".5" viewBox="0 0 5 5"><g transform="scale(.5)">{}</g></pattern>',
        '<pattern id="p" href="#q" width="10"/>'
        '<pattern id="q" width="20" height="10" patternUnits="userSpaceOnUse">{}</pattern>',
        '<pattern id="p" width="5" height="5" patternUnits="userSpaceOnUse" patternTransform="scale(2)">'
        '<g transform="scale(.5)">{}</g></pattern>',
    ],
)
def test_patterns_are_their_lines_within_the_shape(pattern: str) -> None:
    body = pattern.format('<path stroke="red" d="M0 5H10"/>') + SQUARE.format('fill="url(#p)"')
    found = sorted(lines(body))
    assert found == [[(10, y), (20, y)] for y in (15, 25)] + [[(20, y), (30, y)] for y in (15, 25)]


def test_patterns_too_fine_for_a_pen_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patterns, "TILE_LIMIT", 3)
    pattern = (
        '<pattern id="p" width="10" height="10" patternUnits="userSpaceOnUse">'
        '<path stroke="red" d="M0 5H10"/></pattern>'
    )
    found = drawing(pattern + SQUARE.format('fill="url(#p)"'))
    assert found.skipped == {"pattern of too many tiles": 1} and len(found.outlines) == 1


def test_a_pattern_in_itself_ends() -> None:
    square = SQUARE.format('fill="url(#p)"')
    pattern = f'<pattern id="p" width="1" height="1">{square}<path stroke="red" d="M0 0L9 9"/></pattern>'
    assert drawing(pattern + square).skipped == {"reference to itself": 1}


ARROW = '<marker id="m" {} overflow="visible" markerUnits="userSpaceOnUse"><path stroke="red" d="M0 0H1"/></marker>'


def directions(path: str, orient: str, name: str) -> list[tuple[float, float, int]]:
    """Where the markers of a path are, and their directions in degrees."""
    found = lines(ARROW.format(f'orient="{orient}"') + f'<path fill="none" {name}="url(#m)" d="{path}"/>')
    return [(x0, y0, round(math.degrees(math.atan2(y1 - y0, x1 - x0)))) for (x0, y0), (x1, y1) in found]


@pytest.mark.parametrize(
    ("path", "orient", "name", "expected"),
    [
        ("M0 0H9V9", "auto", "marker-start", [(0, 0, 0)]),
        ("M0 0H9V9", "auto", "marker-mid", [(9, 0, 45)]),
        ("M0 0H9V9", "auto", "marker-end", [(9, 9, 90)]),
        ("M0 0H9V9", "auto-start-reverse", "marker-start", [(0, 0, 180)]),
        ("M0 0H9V9", "30", "marker-mid", [(9, 0, 30)]),
        ("M0 0H9V9", ".25turn", "marker-mid", [(9, 0, 90)]),
        ("M0 0H9V9z", "auto", "marker-start", [(0, 0, -68)]),
        ("M0 0H9V9z", "auto", "marker-end", [(0, 0, -68)]),
        ("M0 0A5 5 0 0 1 10 0A5 5 0 0 1 0 0", "auto", "marker-mid", [(10, 0, 90)]),
        ("M0 0C0 0 0 9 9 9", "auto", "marker-start", [(0, 0, 90)]),
        ("M0 0H9z", "auto", "marker-mid", [(9, 0, -90)]),
        ("M0 0H5M7 7V9", "auto", "marker-mid", [(5, 0, 0), (7, 7, 90)]),
        ("M0 0H9V9zL-5 0", "auto", "marker-mid", [(9, 0, 45), (9, 9, 158), (0, 0, -68)]),
        ("M5 6", "0", "marker-end", [(5, 6, 0)]),
        ("M5 6", "0", "marker-start", []),
    ],
)
def test_markers(path: str, orient: str, name: str, expected: list[tuple[float, float, int]]) -> None:
    path += "" if expected else " M90 90"
    expected = expected or [(5, 6, 0)]
    assert directions(path, orient, name) == expected


def test_markers_scale_with_the_stroke_and_are_cut_to_their_box() -> None:
    marker = (
        '<marker id="m" markerWidth="2" markerHeight="2" refX="1" refY="1" viewBox="0 0 2 2">'
        '<path stroke="red" d="M0 1H9"/></marker>'
    )
    body = f'{marker}<path marker-end="url(#m)" stroke="red" stroke-width="4" d="M0 50H50"/>'
    assert lines(body) == [[(0, 50), (50, 50)], [(46, 50), (54, 50)]]


def test_context_paints_are_those_of_the_element_that_refers() -> None:
    marker = '<marker id="m" overflow="visible"><path fill="context-stroke" d="M0 0H1V1z"/></marker>'
    line, head = drawing(f'{marker}<path marker-end="url(#m)" stroke="#00ff00" d="M0 50H50"/>').outlines
    assert line.colour == head.colour == (0, 255, 0)
    square = SQUARE.format('id="a" fill="context-fill"')
    found = drawing(f'<defs>{square}</defs><use href="#a" fill="blue"/>').outlines
    assert [outline.colour for outline in found] == [(0, 0, 255)]


def test_layers() -> None:
    line = '<path stroke="red" d="M0 0H{}"/>'
    body = (
        f'<g inkscape:groupmode="layer" inkscape:label="outer">{line.format(1)}'
        f'<g inkscape:groupmode="layer" id="inner"><g inkscape:label="no layer">{line.format(2)}</g></g></g>'
        f'<g id="group"><g id="deeper">{line.format(3)}</g></g>{line.format(4)}'
    )
    assert [outline.layer for outline in drawing(body).outlines] == ["outer", "inner", "group", ""]


def test_widths_are_in_user_units() -> None:
    (line,) = drawing('<path transform="scale(2 8)" stroke="red" stroke-width="3" d="M0 0H1"/>').outlines
    assert line.width == pytest.approx(12.0)


@pytest.mark.parametrize(
    ("root", "page_mm", "unit_mm"),
    [
        ('width="283.465" height="283.465"', 100.0, 25.4 / 72),
        ('width="100mm" height="100mm" viewBox="0 0 50 50"', 100.0, 2.0),
        ('viewBox="0 0 72 72"', 25.4, 25.4 / 72),
    ],
)
def test_dots_per_inch_scale_what_has_no_unit(root: str, page_mm: float, unit_mm: float) -> None:
    found = drawing('<path stroke="red" d="M0 0H1"/>', root, ReadingOptions(dpi=72.0))
    assert np.allclose(found.page_mm, page_mm, rtol=1e-4)
    assert found.user_to_page[0, 0] == pytest.approx(unit_mm)


def test_the_transform_of_the_outermost_svg_turns_about_the_middle_of_the_page() -> None:
    found = drawing('<path stroke="red" d="M0 0H1"/>', 'width="100" height="50" style="transform: rotate(180deg)"')
    px = found.user_to_page / 25.4 * 96
    assert np.allclose(px, [[-1, 0, 100], [0, -1, 50]])
    assert lines('<path stroke="red" d="M0 0H1"/>') == [[(0, 0), (1, 0)]]
