"""Where `use`, `symbol`, nested `svg`, `switch` and pictures show what they show."""

from __future__ import annotations

import base64

import pytest

from planner.errors import DrawingError
from tests.drawing.scene.shown import Line, drawing, lines

LINE = '<path stroke="red" d="M1 2L3 4"/>'


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (f'<defs><g id="a">{LINE}</g></defs><use href="#a" x="10" transform="scale(2)"/>', [[(22, 4), (26, 8)]]),
        (
            f'<symbol id="a" x="5" viewBox="0 0 10 10">{LINE}</symbol><use href="#a" width="20" height="20"/>',
            [[(7, 4), (11, 8)]],
        ),
        (
            f'<svg id="a" width="4" height="4">{LINE}</svg><use href="#a" y="10"/>',
            [[(1, 2), (3, 4)], [(1, 12), (3, 14)]],
        ),
        (f'<svg x="10" transform="translate(5)" width="10" height="10">{LINE}</svg>', [[(16, 2), (18, 4)]]),
        (f'<svg width="2" height="10">{LINE}</svg>', [[(1, 2), (2, 3)]]),
        (f'<svg width="2" height="10" overflow="visible">{LINE}</svg>', [[(1, 2), (3, 4)]]),
        (f'<svg width="2" height="10" overflow="auto">{LINE}</svg>', [[(1, 2), (3, 4)]]),
        (f'<svg width="2" height="10" overflow="scroll">{LINE}</svg>', [[(1, 2), (2, 3)]]),
        (f'<svg width="0" height="10">{LINE}</svg>{LINE}', [[(1, 2), (3, 4)]]),
        (f'<svg width="50%" height="20%" viewBox="0 0 5 5">{LINE}</svg>', [[(19, 8), (27, 16)]]),
        (
            f'<switch><g systemLanguage="de"/><g systemLanguage="fr, en-GB">{LINE}</g>{LINE}</switch>',
            [[(1, 2), (3, 4)]],
        ),
        (f'<switch><foreignObject width="9" height="9"/>{LINE}</switch>', [[(1, 2), (3, 4)]]),
        (f'<g requiredExtensions="http://unknown.invalid/">{LINE}</g>{LINE}', [[(1, 2), (3, 4)]]),
        (f'<g display="none">{LINE}</g><unknown>{LINE}</unknown><symbol>{LINE}</symbol>{LINE}', [[(1, 2), (3, 4)]]),
    ],
)
def test_places(body: str, expected: list[Line]) -> None:
    assert lines(body) == expected


@pytest.mark.parametrize(
    "body",
    [
        f'<g id="a">{LINE}<use href="#a"/></g>',
        f'<g id="a">{LINE}<use href="#b"/></g><defs><g id="b"><use href="#a"/></g></defs>',
        f'{LINE}<use id="u" href="#u"/>',
    ],
)
def test_what_would_show_itself_is_left_out_and_counted(body: str) -> None:
    found = drawing(body)
    assert len(found.outlines) == 1
    assert found.skipped == {"reference to itself": 1}


def test_other_documents_are_left_out_and_counted() -> None:
    assert drawing(f'{LINE}<use href="other.svg#a"/>').skipped == {"external reference": 1}
    assert drawing(f'{LINE}<use href="#missing"/><use/>').skipped == {}


def test_what_multiplies_is_refused_before_it_is_worked_out() -> None:
    levels = "".join(f'<g id="g{i}">' + f'<use href="#g{i - 1}"/>' * 10 + "</g>" for i in range(1, 12))
    with pytest.raises(DrawingError, match="multiply"):
        drawing(f'<path id="g0" d="M0 0L1 1"/>{levels}')
    chain = "".join(f'<g id="g{i}"><use href="#g{i - 1}"/></g>' for i in range(1, 400))
    with pytest.raises(DrawingError, match="deep"):
        drawing(f'<path id="g0" d="M0 0L1 1"/>{chain}')


INNER = '<svg xmlns="http://www.w3.org/2000/svg" {}><path stroke="red" d="M0 0L20 10"/></svg>'


@pytest.mark.parametrize(
    ("root", "image", "expected"),
    [
        ('viewBox="0 0 20 10"', 'width="40" height="40"', [(0, 10), (40, 30)]),
        ('viewBox="0 0 20 10"', 'width="40" height="40" preserveAspectRatio="xMinYMin slice"', [(0, 10), (40, 30)]),
        ('viewBox="0 0 20 10"', 'width="40" height="40" preserveAspectRatio="none"', [(0, 0), (40, 40)]),
        ('viewBox="0 0 20 10"', 'width="40"', [(0, 0), (40, 20)]),
        ('width="20" height="10"', 'width="40" height="40"', [(0, 0), (40, 40)]),
        ('width="20" height="10"', "", [(0, 0), (20, 10)]),
    ],
)
@pytest.mark.parametrize("is_base64", [True, False])
def test_an_svg_in_a_picture_is_drawn(root: str, image: str, expected: Line, is_base64: bool) -> None:
    inner = INNER.format(root)
    text = base64.b64encode(inner.encode()).decode() if is_base64 else inner.replace("<", "%3C").replace('"', "%22")
    href = f"data:image/svg+xml{';base64' if is_base64 else ''},{text}"
    assert lines(f'<image {image} href="{href}"/>') == [expected]


def test_pictures_in_pictures_end_somewhere_and_others_are_counted() -> None:
    inner = LINE
    for _ in range(20):
        svg = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">{inner}</svg>'
        encoded = base64.b64encode(svg.encode()).decode()
        inner = f'<image width="9" height="9" href="data:image/svg+xml;base64,{encoded}"/>'
    assert drawing(LINE + inner).skipped == {"references nested too deeply": 1}
    pictures = '<image width="9" height="9" href="{}"/>'
    hrefs = ("a.png", "https://x.invalid/a.svg", "data:image/png;base64,AAAA", "data:image/svg+xml,nonsense")
    assert drawing(LINE + "".join(map(pictures.format, hrefs))).skipped == {"image": 4}
