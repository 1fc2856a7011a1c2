"""Nothing silent: every property is drawn, without bearing, or counted; whatever a sheet says, there is an answer."""

from __future__ import annotations

import gzip
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.drawing.source import SvgInMemory, read_source
from planner.drawing.style import cascade, sheet
from planner.drawing.style.properties import ALIASES, COUNTED, INHERITED, INITIAL, PROPERTIES
from planner.drawing.style.shorthands import SHORTHANDS
from planner.drawing.style.style import Styles
from planner.drawing.xml_tree import read_tree
from planner.errors import DrawingError
from tests.drawing.style.styling import style_of, styles_of

SVG_2 = """
alignment-baseline baseline-shift clip-path clip-rule color color-interpolation color-interpolation-filters cursor
cx cy d direction display dominant-baseline fill fill-opacity fill-rule filter flood-color flood-opacity font
font-family font-size font-size-adjust font-stretch font-style font-variant font-weight glyph-orientation-vertical
height image-rendering isolation letter-spacing lighting-color line-height marker marker-end marker-mid marker-start
mask mask-type mix-blend-mode opacity overflow paint-order pointer-events r rx ry shape-image-threshold shape-inside
shape-margin shape-padding shape-rendering shape-subtract stop-color stop-opacity stroke stroke-dasharray
stroke-dashoffset stroke-linecap stroke-linejoin stroke-miterlimit stroke-opacity stroke-width text-align
text-align-all text-align-last text-anchor text-decoration text-decoration-color text-decoration-fill
text-decoration-line text-decoration-stroke text-decoration-style text-indent text-orientation text-overflow
text-rendering transform transform-box transform-origin unicode-bidi vector-effect vertical-align visibility
white-space width will-change word-spacing writing-mode x y
"""
SVG_1_1 = "clip color-profile color-rendering enable-background glyph-orientation-horizontal kerning"
CSS = """
all animation animation-name backface-visibility content-visibility mask-border mask-clip mask-composite mask-image
mask-mode mask-origin mask-position mask-repeat mask-size offset offset-anchor offset-distance offset-path
offset-position offset-rotate overflow-x overflow-y perspective rotate scale text-emphasis text-shadow
text-transform transform-style transition translate z-index zoom -webkit-transform -webkit-clip-path -webkit-mask
-webkit-filter
"""


@pytest.mark.parametrize("name", (SVG_2 + SVG_1_1 + CSS).split())
def test_every_property_is_drawn_or_counted_or_without_bearing(name: str) -> None:
    rows = SHORTHANDS[name][0] if name in SHORTHANDS else (ALIASES.get(name, name),)
    for row in rows:
        assert PROPERTIES[row].bearing in ("drawn", "counted", "none")


def test_initial_values_are_values_of_their_property() -> None:
    for name, row in PROPERTIES.items():
        if row.bearing == "drawn" and row.initial:
            assert row.grammar(row.initial, True) is not None, name
            assert style_of(f"{name}:initial")[name] == INITIAL[name]


def test_what_is_not_honoured_is_counted_where_it_bears_on_something() -> None:
    found = styles_of(
        '<rect id="a" filter="url(#f)" style="offset-path:none;cursor:none;border:1px solid"/>'
        '<g font-variant="petite-caps" style="text-emphasis:dot"><text id="b"/><rect id="c"/></g>'
        '<text id="d" font-variant="small-caps"/>',
        'style="border:1px solid;animation:none"',
    )
    counted = {name: style.unhonoured() for name, style in found.items()}
    assert counted == {
        "a": ["filter"],
        "b": ["font variant", "text-emphasis"],
        "c": [],
        "d": [],
        "": ["border"],
    }
    for name, row in COUNTED.items():
        assert row.kind, name
        assert style_of(f"{name}:{row.initial}").unhonoured() == []


def test_what_sheets_ask_for_outside_the_file_is_counted() -> None:
    text = "<svg><style>@import 'a.css'; @font-face{src:url(data:x)} @font-face{} @scope (a){} @page{}</style></svg>"
    styles = Styles(read_tree(text.encode(), "drawing.svg"))
    assert styles.skipped == {"external reference": 1, "embedded font": 2, "@scope rules": 1}


def test_sheets_beyond_the_limits_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sheet, "_TEXT_LIMIT", 1000)
    monkeypatch.setattr(cascade, "WORK_LIMIT", 1000)
    font = f"@font-face{{src:url('data:font/woff;base64,{'A' * 2000}')}}"
    assert styles_of(f"<style>{font} rect{{width:5px}}</style><rect id='a'/>")["a"]["width"] == "5px"
    with pytest.raises(DrawingError, match="style sheets are longer than 1000"):
        styles_of(f"<style>{'a{}' * 400}</style>")
    for body in (
        "<style>" + "*{fill:red}" * 50 + "</style>" + "<g/>" * 20,
        "<g style='" + "".join(f"--v{n}:1;" for n in range(50)) + "'>" + "<g style='--a:1'/>" * 30 + "</g>",
        f"<g style='fill:{'[' * 1001}'/>",
    ):
        with pytest.raises(DrawingError, match="too much work"):
            styles_of(body)


CSS_PIECES = """
rect #a * .k :not( :is( :has( :nth-child( 2n > ~ , { } ( ) [ ] : ; width fill font --a var(--a calc( 5px 50% 1 + - /
!important @media @layer @supports and not url( ' " \\ /* */ red rgb( inherit revert-layer &amp; &lt;!-- transform
rotate( stroke-dasharray é color-mix( in srgb d:path(
"""


@given(
    st.lists(st.sampled_from([*CSS_PIECES.split(), " ", " "]), max_size=25),
    st.sampled_from(["sheet", "style", "width", "fill", "transform"]),
)
def test_whatever_is_said_there_is_an_answer(pieces: list[str], place: str) -> None:
    said = "".join(pieces)
    attribute = said.replace('"', "&quot;")
    body = f'<style>{said}</style><rect id="a"/>' if place == "sheet" else f'<rect id="a" {place}="{attribute}"/>'
    style = styles_of(body)["a"]
    for name, row in PROPERTIES.items():
        if row.bearing != "none":
            assert isinstance(style[name], str)
    assert style.paint("fill").kind in ("none", "colour", "context-fill", "context-stroke", "reference")
    for name in ("width", "x", "stroke-width"):
        length = style.length(name, "x")
        assert length is None or abs(length) <= 2.0**25
    assert 0.0 <= style.number("opacity") <= 1.0
    assert style.font_size >= 0.0


def test_inherited_properties_are_those_that_are_said_once_for_a_group() -> None:
    assert {"fill", "stroke-width", "visibility", "font-size", "marker-mid", "clip-rule"} <= INHERITED
    assert not {"opacity", "transform", "display", "clip-path", "mask", "overflow", "stop-color"} & INHERITED


@pytest.mark.parametrize(
    ("start", "expected"),
    [
        (b"8BPS\0\1", "this is a picture (Photoshop), not an SVG: export it as a PNG first"),
        (b"%PDF-1.7", "this is a PDF, not an SVG: export it as an SVG first"),
        (b"PK\x03\x04", "this is a ZIP archive, not an SVG: unpack it"),
        (b" \n", "the file is empty"),
    ],
)
def test_files_of_other_kinds_are_told_what_they_are(tmp_path: Path, start: bytes, expected: str) -> None:
    for data in (start, gzip.compress(start)):
        path = tmp_path / "drawing.svg"
        path.write_bytes(data)
        for source in (path, SvgInMemory("drawing.svg", data)):
            with pytest.raises(DrawingError) as caught:
                read_source(source)
            assert str(caught.value).startswith(f"drawing.svg: {expected}")
