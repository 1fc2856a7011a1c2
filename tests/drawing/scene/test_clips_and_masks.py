"""Clip paths and masks cut lines where they are, by the units and transforms that they are in."""

from __future__ import annotations

import pytest

from tests.drawing.scene.shown import Line, drawing, length, lines

ACROSS = '<path {} stroke="red" d="M0 50H100"/>'


@pytest.mark.parametrize(
    ("defs", "reference", "expected"),
    [
        ('<clipPath id="c"><rect x="10" y="10" width="30" height="80"/></clipPath>', "", [[(10, 50), (40, 50)]]),
        (
            '<clipPath id="c"><rect x="10" width="9" height="99"/><rect x="30" width="9" height="99"/></clipPath>',
            "",
            [[(10, 50), (19, 50)], [(30, 50), (39, 50)]],
        ),
        (
            '<clipPath id="c" transform="translate(20)">'
            '<rect width="30" height="80" transform="scale(.5 1)"/></clipPath>',
            "",
            [[(20, 50), (35, 50)]],
        ),
        (
            '<clipPath id="c" clip-path="url(#d)"><rect x="10" width="30" height="99"/></clipPath>'
            '<clipPath id="d"><rect x="20" width="50" height="99"/></clipPath>',
            "",
            [[(20, 50), (40, 50)]],
        ),
        (
            '<clipPath id="c"><rect x="10" width="30" height="99" clip-path="url(#d)"/></clipPath>'
            '<clipPath id="d"><rect x="20" width="50" height="99"/></clipPath>',
            "",
            [[(20, 50), (40, 50)]],
        ),
        (
            '<clipPath id="c"><use href="#r" x="5"/></clipPath><defs><rect id="r" width="9" height="99"/></defs>',
            "",
            [[(5, 50), (14, 50)]],
        ),
        (
            '<clipPath id="c"><path clip-rule="evenodd" d="M10 0H90V99H10zM20 0H80V99H20z"/></clipPath>',
            "",
            [[(10, 50), (20, 50)], [(80, 50), (90, 50)]],
        ),
        ('<clipPath id="c" clip-path="url(#c)"><rect width="9" height="99"/></clipPath>', "", [[(0, 50), (9, 50)]]),
        ("", "", [[(0, 50), (100, 50)]]),
        ('<mask id="c"><rect width="9" height="9"/></mask>', "", [[(0, 50), (100, 50)]]),
        ('<clipPath id="c" display="none"><rect width="9" height="99"/></clipPath>', "", [[(0, 50), (100, 50)]]),
        ("", "circle(20px at 50px 50px) view-box", [[(30, 50), (70, 50)]]),
        ("", "inset(0 30% 0 20%) view-box", [[(20, 50), (70, 50)]]),
        ("", "polygon(10px 0, 40px 0, 40px 100%, 10px 100%) view-box", [[(10, 50), (40, 50)]]),
        ("", "path('M10 0H40V99H10z') view-box", [[(10, 50), (40, 50)]]),
        ("", "ellipse(20px 10px at center) view-box", [[(30, 50), (70, 50)]]),
        ("", "xywh(10px 0 30px 99px) view-box", [[(10, 50), (40, 50)]]),
        ("", "rect(0 40px 99px 10px) view-box", [[(10, 50), (40, 50)]]),
    ],
)
def test_clip_paths(defs: str, reference: str, expected: list[Line]) -> None:
    style = f'style="clip-path: {reference or "url(#c)"}"'
    assert sorted(lines(defs + ACROSS.format(style))) == expected
    group = f"{defs}<g {style}>{ACROSS.format('')}</g>"
    if "view-box" in style or "url" in style:
        assert sorted(lines(group)) == expected


def test_units_of_the_box() -> None:
    clip = '<clipPath id="c" clipPathUnits="objectBoundingBox"><rect x=".25" width=".5" height="1"/></clipPath>'
    body = f'{clip}<path clip-path="url(#c)" fill="none" stroke="red" d="M20 20H60V40"/>'
    assert lines(body) == [[(30, 20), (50, 20)]]
    # A box without a height has no halves: nothing is left.
    assert len(drawing(clip + ACROSS.format('clip-path="url(#c)"') + ACROSS.format("")).outlines) == 1


def test_an_empty_clip_path_hides_and_groups_in_one_count_for_nothing() -> None:
    for content in ("", '<g><rect width="99" height="99"/></g>', '<rect width="99" height="99" visibility="hidden"/>'):
        found = drawing(
            f'<clipPath id="c">{content}</clipPath>{ACROSS.format("")}' + ACROSS.format('clip-path="url(#c)"')
        )
        assert len(found.outlines) == 1


WHITE = '<rect x="10" width="50" height="99" fill="white"/>'


@pytest.mark.parametrize(
    ("mask", "expected", "n_greys"),
    [
        (f'<mask id="m">{WHITE}</mask>', [[(10, 50), (60, 50)]], 0),
        (
            f'<mask id="m">{WHITE}<rect x="20" width="9" height="99"/></mask>',
            [[(10, 50), (20, 50)], [(29, 50), (60, 50)]],
            0,
        ),
        ('<mask id="m"><rect x="10" width="50" height="99"/></mask>', [], 0),
        ('<mask id="m" mask-type="alpha"><rect x="10" width="50" height="99"/></mask>', [[(10, 50), (60, 50)]], 0),
        ('<mask id="m"><rect x="10" width="50" height="99" fill="#999"/></mask>', [[(10, 50), (60, 50)]], 1),
        (f'<mask id="m">{WHITE}<rect x="20" width="9" height="99" opacity=".5"/></mask>', [[(10, 50), (60, 50)]], 1),
        ('<mask id="m"><path d="M0 50H30" stroke="white" stroke-width="9"/></mask>', [[(0, 50), (30, 50)]], 0),
        (
            f'<mask id="m" maskUnits="userSpaceOnUse" x="0" y="0" width="40" height="99">{WHITE}</mask>',
            [[(10, 50), (40, 50)]],
            0,
        ),
        ('<mask id="m"/>', [], 0),
    ],
)
def test_masks(mask: str, expected: list[Line], n_greys: int) -> None:
    mask = (
        mask
        if "maskUnits" in mask
        else mask.replace("<mask ", '<mask maskUnits="userSpaceOnUse" x="0" y="0" width="100" height="100" ')
    )
    found = drawing(mask + ACROSS.format('mask="url(#m)"') + '<path stroke="red" d="M0 90H1"/>')
    assert found.skipped == ({"mask with greys": n_greys} if n_greys else {})
    shown = lines(mask + ACROSS.format('mask="url(#m)"') + '<path stroke="red" d="M0 90H1"/>')
    assert sorted(shown) == sorted([*expected, [(0, 90), (1, 90)]])


def test_what_is_clipped_twice_is_in_both() -> None:
    body = (
        '<clipPath id="c"><circle cx="50" cy="50" r="30"/></clipPath><clipPath id="d">'
        '<circle cx="80" cy="50" r="30"/></clipPath>'
        '<g clip-path="url(#c)"><g clip-path="url(#d)">{}</g></g>'
    )
    assert length(body.format(ACROSS.format(""))) == pytest.approx(30.0, abs=1e-3)
