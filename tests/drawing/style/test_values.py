"""Values: lengths and what is calculated, colours and paints, media queries, transforms. What is expected is what
Chromium gives."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.drawing.style.colour import PaintValue, Rgba, fragment, parse_colour, parse_paint
from planner.drawing.style.media import matches_text
from planner.drawing.style.units import units_of_page
from tests.drawing.style.styling import style_of, styles_of

UNITS = units_of_page((200.0, 100.0))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("5", 5.0),
        ("-.5e1", -5.0),
        ("1in", 96.0),
        ("25.4MM", 96.0),
        ("2.54cm", 96.0),
        ("101.6q", 96.0),
        ("72pt", 96.0),
        ("6pc", 96.0),
        ("2em", 32.0),
        ("2rem", 32.0),
        ("1ex", 9.0),
        ("1ic", 16.0),
        ("1lh", 19.0),
        ("1rlh", 19.0),
        ("10%", 20.0),
        ("10vw", 20.0),
        ("10vh", 10.0),
        ("10vi", 20.0),
        ("10vb", 10.0),
        ("10vmin", 10.0),
        ("10dvmax", 20.0),
        ("calc(1px + 10%)", 21.0),
        ("calc(2 * (3px - 1px) / 4)", 1.0),
        ("min(5px, 1em, 10%)", 5.0),
        ("max(5px, 1em)", 16.0),
        ("clamp(1px, 9px, 3px)", 3.0),
        ("round(up, 5.4px, 2px)", 6.0),
        ("mod(-7px, 3px)", 2.0),
        ("rem(-7px, 3px)", -1.0),
        ("hypot(3px, 4px)", 5.0),
        ("abs(-3px)", 3.0),
        ("calc(sqrt(16) * sin(30deg) * 1px)", 2.0),
        ("calc(10px / 4px * 1px)", 2.5),
        ("calc(1px * pi)", math.pi),
        ("1e400", 2.0**25),
        ("calc(1px * infinity)", 2.0**25),
        ("5.", None),
        ("5 px", None),
        ("1e", None),
        ("", None),
        ("auto", None),
        ("5foo", None),
        ("45deg", None),
        ("calc(1px + 2)", None),
        ("calc(1px+2px)", None),
        ("calc(1px * 2px)", None),
        ("calc(1px / 0)", None),
        ("calc()", None),
        ("calc(1px", 1.0),
        ("foo(1px)", None),
        ("calc(" * 3000 + "1px" + ")" * 3000, None),
    ],
)
def test_lengths(text: str, expected: float | None) -> None:
    assert UNITS.length(text, "x") == (None if expected is None else pytest.approx(expected, abs=1e-9))


def test_percentages_are_of_the_viewport_along_their_axis() -> None:
    style = styles_of('<rect id="a" width="10%" height="10%" stroke-width="10%"/>')["a"]
    assert style.length("width", "x") == 20.0
    assert style.length("height", "y") == 10.0
    assert style.length("stroke-width", "diagonal") == pytest.approx(0.1 * math.sqrt((200**2 + 100**2) / 2))


def test_lines_and_letters_are_those_of_the_own_font() -> None:
    found = styles_of(
        '<g font-size="20"><rect id="a" font-size="50" width="1lh" height="1em"/>'
        '<g style="line-height:2"><rect id="b" width="1lh" height="1rem"/></g></g>',
        'font-size="10"',
    )
    assert [found["a"].length(name, "x") for name in ("width", "height")] == [58.0, 50.0]
    assert [found["b"].length(name, "x") for name in ("width", "height")] == [40.0, 10.0]


expressions = st.recursive(
    st.integers(-9, 9).map(lambda number: (f"{number}px", float(number))),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from("+-"), inner).map(
            lambda parts: (
                f"({parts[0][0]} {parts[1]} {parts[2][0]})",
                parts[0][1] + parts[2][1] if parts[1] == "+" else parts[0][1] - parts[2][1],
            )
        ),
        st.tuples(inner, st.integers(-3, 3)).map(lambda parts: (f"({parts[0][0]}*{parts[1]})", parts[0][1] * parts[1])),
        st.tuples(inner, st.integers(1, 4)).map(lambda parts: (f"({parts[0][0]}/{parts[1]})", parts[0][1] / parts[1])),
        st.lists(inner, min_size=1, max_size=3).map(
            lambda parts: (f"min({', '.join(text for text, _ in parts)})", min(value for _, value in parts))
        ),
        st.lists(inner, min_size=1, max_size=3).map(
            lambda parts: (f"max({', '.join(text for text, _ in parts)})", max(value for _, value in parts))
        ),
    ),
    max_leaves=8,
)


@given(expressions)
def test_what_is_calculated_is_what_python_calculates(expression: tuple[str, float]) -> None:
    text, value = expression
    assert UNITS.length(f"calc({text})", "x") == pytest.approx(value, abs=1e-6)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("red", Rgba(255, 0, 0)),
        ("RebeccaPurple", Rgba(102, 51, 153)),
        ("#0a1", Rgba(0, 170, 17)),
        ("#0A1F", Rgba(0, 170, 17)),
        ("#01020380", Rgba(1, 2, 3, 128 / 255)),
        ("transparent", Rgba(0, 0, 0, 0.0)),
        ("rgb(300,-5, 0)", Rgba(255, 0, 0)),
        ("RGB(10%,20%,30%)", Rgba(26, 51, 77)),
        ("rgb(1 2 3 / 50%)", Rgba(1, 2, 3, 0.5)),
        ("rgb(1 none 3 / none)", Rgba(1, 0, 3, 0.0)),
        ("rgba(1,2,3,.5)", Rgba(1, 2, 3, 0.5)),
        ("hsl(120,100%,25%)", Rgba(0, 128, 0)),
        ("hsl(999 100% 25%)", Rgba(83, 0, 128)),
        ("hsla(0.5turn 100% 50% / 20%)", Rgba(0, 255, 255, 0.2)),
        ("hwb(0 10% 20%)", Rgba(204, 26, 26)),
        ("lab(0 0 0)", Rgba(0, 0, 0)),
        ("oklab(1 0 0)", Rgba(255, 255, 255)),
        ("color(srgb 1 0.5 0)", Rgba(255, 128, 0)),
        ("color-mix(in srgb, red, blue)", Rgba(128, 0, 128)),
        ("color-mix(in srgb, red 25%, blue)", Rgba(64, 0, 191)),
        ("light-dark(red, blue)", Rgba(255, 0, 0)),
        ("CanvasText", Rgba(0, 0, 0)),
        ("currentColor", "currentcolor"),
        ("#12345", None),
        ("rgb(1,2)", None),
        ("rgb(10%,2,3)", None),
        ("rgb(1,2,3,4,5)", None),
        ("rgb()", None),
        ("rgb(#fff)", None),
        ("color()", None),
        ("hsl(120,50,50)", None),
        ("red blue", None),
        ("red;", None),
        ("red icc-color(a,1)", None),
        ("none", None),
        ("", None),
    ],
)
def test_colours(text: str, expected: Rgba | str | None) -> None:
    found = parse_colour(text)
    if isinstance(expected, Rgba) and isinstance(found, Rgba):
        assert (found.red, found.green, found.blue) == (expected.red, expected.green, expected.blue)
        assert found.alpha == pytest.approx(expected.alpha)
    else:
        assert found == expected


RED = PaintValue("colour", Rgba(255, 0, 0))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("red", RED),
        ("NONE", PaintValue("none")),
        ("context-fill", PaintValue("context-fill")),
        ("url(#a)", PaintValue("reference", url="#a")),
        ("url( '#a' )red", PaintValue("reference", url="#a", fallback=RED)),
        ("url(b.svg#a) none", PaintValue("reference", url="b.svg#a", fallback=PaintValue("none"))),
        ("url(#a) currentColor", PaintValue("reference", url="#a", fallback=PaintValue("currentcolor"))),
        ("url(#a", PaintValue("reference", url="#a")),
        ("url(#a) red blue", None),
        ("url(#a) url(#b)", None),
        ("#a", None),
        ("foo", None),
    ],
)
def test_paints(text: str, expected: PaintValue | None) -> None:
    assert parse_paint(text) == expected


def test_fragments() -> None:
    assert [fragment(url) for url in ("#a", " #a%20b ", "a.svg#a", "#", "")] == ["a", "a b", None, None, None]


@pytest.mark.parametrize(
    ("query", "expected"),
    [
        ("", True),
        ("all", True),
        ("SCREEN", True),
        ("print", False),
        ("only screen", True),
        ("not print", True),
        ("not all", False),
        ("print, screen", True),
        ("screen, foo(", True),
        ("(min-width:200px)", True),
        ("(max-width:199px)", False),
        ("screen and (min-width:12.5em) and (max-height:100px)", True),
        ("print and (min-width:1px)", False),
        ("not screen and (color)", False),
        ("(100px < width <= 200px)", True),
        ("(200px < width < 300px)", False),
        ("(width > 500px) or (height = 100px)", True),
        ("(width > 500px) and (height = 100px)", False),
        ("not (width > 500px)", True),
        ("(orientation:landscape)", True),
        ("(aspect-ratio:2/1)", True),
        ("(min-aspect-ratio:21/10)", False),
        ("(prefers-color-scheme:light)", True),
        ("(prefers-color-scheme:dark)", False),
        ("(prefers-reduced-motion)", False),
        ("(color)", True),
        ("(monochrome)", False),
        ("(min-resolution:1dppx)", True),
        ("(min-resolution:192dpi)", False),
        ("(foo)", False),
        ("not (foo)", False),
        ("(foo) or (color)", True),
        ("((color) and (width))", True),
        ("screen (color)", False),
        ("(" * 5000, False),
    ],
)
def test_media_queries(query: str, expected: bool) -> None:
    assert matches_text(query, (200.0, 100.0)) is expected


@pytest.mark.parametrize(
    ("text", "in_attribute", "in_css"),
    [
        ("rotate(45)", True, False),
        ("rotate(45deg)", False, True),
        ("rotate(45 1 2)", True, False),
        ("rotate(0)", True, True),
        ("translate(5px, 10%)", False, True),
        ("translate(5 6)", True, False),
        ("translate(1-2)", True, False),
        ("translate(.5.5)", True, False),
        ("translate(5.)", False, False),
        ("translate(1) , scale(2)", True, False),
        ("translate (1)", True, False),
        ("scale(2)rotate(0)", True, True),
        ("scale(50%)", False, True),
        ("scale(2), scale(3)", True, False),
        ("matrix(1,0,0,1,0,0)", True, True),
        ("matrix(1 0 0 1 5)", False, False),
        ("skewX(10)", True, False),
        ("skew(10deg)", False, True),
        ("rotate(45 5)", False, False),
        ("Rotate(45)", False, False),
        ("rotate(45) foo", False, False),
        (",scale(2)", False, False),
        ("scale(2),", False, False),
        ("none", True, True),
        ("rotate3d(1, 0, 0, 10deg)", False, True),
    ],
)
def test_transforms(text: str, in_attribute: bool, in_css: bool) -> None:
    attribute = styles_of(f'<rect id="a" transform="{text}"/>')["a"]["transform"]
    assert attribute == (text if in_attribute else "none")
    assert style_of(f"transform:{text}")["transform"] == (text if in_css else "none")


def test_a_long_transform_that_breaks_off_is_found_out_at_once() -> None:
    blanks = " " * 200_000
    for text in (f"scale(2){blanks}x", f"translate(1{blanks}x", f"translate(1,{blanks}", f"scale{blanks}2"):
        assert styles_of(f'<rect id="a" transform="{text}"/>')["a"]["transform"] == "none"


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ("5px 6px", "5px 6px"),
        ("center", "50% 50%"),
        ("left", "0% 50%"),
        ("top", "50% 0%"),
        ("bottom right", "100% 100%"),
        ("top 5px", "0 0"),
        ("5px top 3px", "5px 0%"),
        ("5 6", "0 0"),
        ("left right", "0 0"),
        ("", "0 0"),
    ],
)
def test_origins(said: str, expected: str) -> None:
    assert style_of(f"transform-origin:{said}")["transform-origin"] == expected


@pytest.mark.parametrize(
    ("said", "name", "expected"),
    [
        ("stroke-dasharray:5,6", "stroke-dasharray", "5 6"),
        ("stroke-dasharray:5px , 10% 1em", "stroke-dasharray", "5px 10% 16px"),
        ("stroke-dasharray:calc(1px + 2px), 5", "stroke-dasharray", "3px 5px"),
        ("stroke-dasharray:5,,6", "stroke-dasharray", "none"),
        ("stroke-dasharray:5 -6", "stroke-dasharray", "none"),
        ("opacity:150%", "opacity", "1.5"),
        ("fill-rule:EvenOdd", "fill-rule", "evenodd"),
        ("d:path('M0 0L1 1')", "d", "M0 0L1 1"),
        ("d:path('M0 0x')", "d", ""),
        ("d:none", "d", ""),
        ("clip-path:url(#a)", "clip-path", "url(#a)"),
        ("clip-path:circle(5px) fill-box", "clip-path", "circle(5px) fill-box"),
        ("clip-path:url(#a) fill-box", "clip-path", "none"),
        ("clip-path:foo(1)", "clip-path", "none"),
        ("marker:url('#m')", "marker-mid", "url('#m')"),
        ("marker:url(#m) none", "marker-mid", "none"),
        ("stroke-miterlimit:-1", "stroke-miterlimit", "4"),
        ("display:inline foo", "display", "inline"),
        ("rotate:45deg", "rotate", "45deg"),
        ("rotate:45", "rotate", "none"),
        ("scale:2 3", "scale", "2 3"),
        ("translate:5px 6%", "translate", "5px 6%"),
        ("letter-spacing:50%", "letter-spacing", "8px"),
        ("-webkit-transform:none;-webkit-clip-path:url(#b)", "clip-path", "url(#b)"),
    ],
)
def test_values_are_kept_or_dropped(said: str, name: str, expected: str) -> None:
    assert style_of(said)[name].replace('"', "'") == expected


def test_sizes_that_are_calculated_below_zero_are_zero() -> None:
    assert style_of("width:calc(5px - 9px)").length("width", "x") == 0.0
    assert style_of("width:-4px;opacity:-3;fill-opacity:calc(1 + 1)")["width"] == "auto"
    assert style_of("opacity:-3").number("opacity") == 0.0
    assert style_of("fill-opacity:calc(1 + 1)").number("fill-opacity") == 1.0
