"""The indices of properties and elements of SVG 2, walked: each is drawn, counted, or known to bear on no line.

One drawing holds something for every property to act on. A property that is drawn changes its lines; one that is not
honoured is counted; one that bears on nothing leaves them as they are.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from planner.drawing.drawing import Drawing
from planner.drawing.options import ReadingOptions
from planner.drawing.source import SvgInMemory
from planner.drawing.style.properties import ALIASES, PROPERTIES
from planner.drawing.svg import read_drawing
from planner.errors import DrawingError

INDEX = [
    "alignment-baseline",
    "baseline-shift",
    "clip",
    "clip-path",
    "clip-rule",
    "color",
    "color-interpolation",
    "color-interpolation-filters",
    "color-rendering",
    "cursor",
    "cx",
    "cy",
    "d",
    "direction",
    "display",
    "dominant-baseline",
    "fill",
    "fill-opacity",
    "fill-rule",
    "filter",
    "flood-color",
    "flood-opacity",
    "font",
    "font-family",
    "font-feature-settings",
    "font-kerning",
    "font-size",
    "font-size-adjust",
    "font-stretch",
    "font-style",
    "font-variant",
    "font-variant-alternates",
    "font-variant-caps",
    "font-variant-east-asian",
    "font-variant-ligatures",
    "font-variant-numeric",
    "font-variant-position",
    "font-weight",
    "glyph-orientation-horizontal",
    "glyph-orientation-vertical",
    "height",
    "image-rendering",
    "inline-size",
    "isolation",
    "letter-spacing",
    "lighting-color",
    "line-height",
    "marker",
    "marker-end",
    "marker-mid",
    "marker-start",
    "mask",
    "mask-border",
    "mask-clip",
    "mask-composite",
    "mask-image",
    "mask-mode",
    "mask-origin",
    "mask-position",
    "mask-repeat",
    "mask-size",
    "mask-type",
    "mix-blend-mode",
    "object-fit",
    "object-position",
    "opacity",
    "overflow",
    "paint-order",
    "pointer-events",
    "r",
    "rx",
    "ry",
    "shape-image-threshold",
    "shape-inside",
    "shape-margin",
    "shape-padding",
    "shape-rendering",
    "shape-subtract",
    "stop-color",
    "stop-opacity",
    "stroke",
    "stroke-dasharray",
    "stroke-dashoffset",
    "stroke-linecap",
    "stroke-linejoin",
    "stroke-miterlimit",
    "stroke-opacity",
    "stroke-width",
    "text-align",
    "text-align-all",
    "text-align-last",
    "text-anchor",
    "text-decoration",
    "text-decoration-color",
    "text-decoration-fill",
    "text-decoration-line",
    "text-decoration-stroke",
    "text-decoration-style",
    "text-indent",
    "text-orientation",
    "text-overflow",
    "text-rendering",
    "transform",
    "transform-box",
    "transform-origin",
    "unicode-bidi",
    "vector-effect",
    "vertical-align",
    "visibility",
    "white-space",
    "width",
    "will-change",
    "word-spacing",
    "writing-mode",
    "x",
    "y",
]
"""Appendix L of SVG 2, with the properties that its chapters take from CSS Masking, Fonts and Text."""
OLDER = ["clip-path", "color-profile", "enable-background", "glyph-orientation-vertical", "kerning", "font-stretch"]
"""SVG 1.1."""
CSS = [
    "rotate",
    "scale",
    "translate",
    "offset-path",
    "offset-rotate",
    "offset-distance",
    "perspective",
    "perspective-origin",
    "transform-style",
    "backface-visibility",
    "content-visibility",
    "zoom",
    "z-index",
    "position",
    "text-transform",
    "text-shadow",
    "text-emphasis",
    "tab-size",
    "word-break",
    "overflow-wrap",
    "hyphens",
    "line-break",
    "white-space-collapse",
    "text-wrap",
    "font-optical-sizing",
    "font-variation-settings",
    "font-synthesis",
    "font-palette",
    "font-language-override",
    "object-fit",
    "animation",
    "animation-name",
    "transition",
    "all",
    "border",
    "padding",
    "margin",
    "outline",
    "background",
    "background-color",
    "background-image",
    "color-scheme",
    "overflow-x",
    "overflow-y",
]
"""What browsers honour in SVG, or might."""
SHORTHANDS = {"font", "marker", "all"}

DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200" viewBox="0 0 200 200">
<style>svg {{ font-family: serif }} {css}</style>
<defs>
  <linearGradient id="lg"><stop id="stop" stop-color="red"/></linearGradient>
  <pattern id="hatch" width="4" height="4" patternUnits="userSpaceOnUse"><path d="M0 1h4" stroke="black"/></pattern>
  <marker id="arrow" markerWidth="3" markerHeight="3" overflow="visible"><path d="M0 0h2v2"/></marker>
  <clipPath id="ring"><path id="clipping" d="M110 10h40v40h-40zM120 20h20v20h-20z"/></clipPath>
  <mask id="hole" maskUnits="userSpaceOnUse" x="0" y="0" width="200" height="200">
    <path id="masking" d="M160 20L175 45 190 20" fill="none" stroke="white" stroke-width="8"/></mask>
  <mask id="grey" maskUnits="userSpaceOnUse" x="0" y="0" width="200" height="200">
    <rect x="160" y="60" width="30" height="20" fill="black"/></mask>
</defs>
<rect id="rect" x="10" y="10" width="20" height="12"/>
<circle id="circle" cx="50" cy="16" r="8"/>
<ellipse id="ellipse" cx="75" cy="16" rx="9" ry="6"/>
<path id="path" d="M10 40h20l5 10"/>
<g id="box" transform="translate(1 2)"><rect x="20" y="60" width="20" height="12" transform="rotate(9)"/></g>
<path id="line" d="M10 90h20v10h20v10" fill="none" stroke="black" stroke-width="2"/>
<path id="dashed" d="M10 115h60" fill="none" stroke="black" stroke-width="2" stroke-dasharray="9 7"
  transform="scale(1.2 1)"/>
<path id="zero" d="M90 115h0" fill="none" stroke="black" stroke-width="2"/>
<path id="star" d="M80 60l10 30-25-18h30l-25 18z" fill="url(#hatch)"/>
<rect id="shaded" x="80" y="95" width="9" height="9" fill="url(#lg)"/>
<path id="clipped" d="M100 15h70M100 30h70" clip-path="url(#ring)" fill="none" stroke="black"/>
<path id="masked" d="M150 30h50M150 50h50" mask="url(#hole)" fill="none" stroke="black"/>
<path id="shadowed" d="M150 70h50" mask="url(#grey)" fill="none" stroke="black"/>
<svg id="window" x="120" y="60" width="20" height="20"><path d="M0 0l40 30" fill="none" stroke="black"/></svg>
<text id="text" x="60" y="140" font-size="10">ab <tspan id="span">cd ef</tspan>  gh</text>
<text id="tall" x="20" y="140" font-size="8">one</text>
</svg>"""

CHANGES = {
    "x": "#rect { x: 15px }",
    "y": "#rect { y: 15px }",
    "width": "#rect { width: 5px }",
    "height": "#rect { height: 5px }",
    "cx": "#circle { cx: 45px }",
    "cy": "#circle { cy: 20px }",
    "r": "#circle { r: 3px }",
    "rx": "#ellipse { rx: 3px }",
    "ry": "#rect { ry: 3px }",
    "d": "#path { d: path('M10 40h10v9') }",
    "transform": "#rect { transform: rotate(9deg) }",
    "transform-origin": "#box rect { transform-origin: 30px 60px }",
    "transform-box": "#box rect { transform-origin: center; transform-box: fill-box }",
    "translate": "#rect { translate: 3px 4px }",
    "rotate": "#rect { rotate: 9deg }",
    "scale": "#rect { scale: 2 }",
    "display": "#rect { display: none }",
    "visibility": "#rect { visibility: hidden }",
    "overflow": "#window { overflow: visible }",
    "opacity": "#rect { opacity: 0 }",
    "color": "#rect { fill: currentColor; color: blue }",
    "fill": "#rect { fill: none }",
    "fill-opacity": "#rect { fill-opacity: 0 }",
    "fill-rule": "#star { fill-rule: evenodd }",
    "stroke": "#line { stroke: none }",
    "stroke-opacity": "#line { stroke-opacity: 0 }",
    "stroke-width": "#masking { stroke-width: 3 }",
    "stroke-dasharray": "#line { stroke-dasharray: 5 }",
    "stroke-dashoffset": "#dashed { stroke-dashoffset: 3 }",
    "stroke-linecap": "#zero { stroke-linecap: round }",
    "stroke-linejoin": "#masking { stroke-linejoin: bevel }",
    "stroke-miterlimit": "#masking { stroke-miterlimit: 1 }",
    "vector-effect": "#dashed { vector-effect: non-scaling-stroke }",
    "marker-start": "#line { marker-start: url(#arrow) }",
    "marker-mid": "#line { marker-mid: url(#arrow) }",
    "marker-end": "#line { marker-end: url(#arrow) }",
    "marker": "#line { marker: url(#arrow) }",
    "stop-color": "#stop { stop-color: blue }",
    "stop-opacity": "#stop { stop-opacity: 0 }",
    "clip-path": "#clipped { clip-path: none }",
    "clip-rule": "#clipping { clip-rule: evenodd }",
    "mask": "#masked { mask: none }",
    "mask-image": "#masked { mask-image: none }",
    "mask-type": "#grey { mask-type: alpha }",
    "font": "#text { font: 14px monospace }",
    "font-family": "#text { font-family: monospace }",
    "font-size": "#text { font-size: 14px }",
    "font-style": "#text { font-style: italic }",
    "line-height": "#rect { width: 2lh; line-height: 3px }",
    "direction": "#text { direction: rtl }",
    "unicode-bidi": "#span { direction: rtl; unicode-bidi: bidi-override }",
    "writing-mode": "#tall { writing-mode: vertical-rl }",
    "text-orientation": "#tall { writing-mode: vertical-rl; text-orientation: upright }",
    "text-anchor": "#text { text-anchor: middle }",
    "dominant-baseline": "#text { dominant-baseline: hanging }",
    "alignment-baseline": "#span { alignment-baseline: hanging }",
    "baseline-shift": "#span { baseline-shift: super }",
    "letter-spacing": "#text { letter-spacing: 2px }",
    "word-spacing": "#text { word-spacing: 5px }",
    "text-decoration": "#text { text-decoration: underline }",
    "text-decoration-line": "#text { text-decoration-line: underline }",
    "white-space": "#text { white-space: pre }",
    "text-transform": "#text { text-transform: uppercase }",
    "overflow-x": "#window { overflow-x: visible; overflow-y: visible }",
    "overflow-y": "#window { overflow-x: visible; overflow-y: visible }",
    "all": "#rect { all: unset }",
}
"""For each property that is drawn, a rule that moves, shows or hides something."""
BEFORE = {
    "transform-box": "#box rect { transform-origin: center }",
    "text-orientation": "#tall { writing-mode: vertical-rl }",
    "color": "#rect { fill: currentColor }",
    "line-height": "#rect { width: 2lh }",
}
"""What has to be so for the property to count; nothing elsewhere."""
OUTLINES_ALONE = {
    "font-weight": "#text { font-weight: 900 }",
    "font-stretch": "#text { font-stretch: condensed }",
}
"""Weight and width tell the faces of a family apart, where the machine has them; a single line has neither."""
WORKING = {
    "filter": "#rect { filter: blur(3px) }",
    "offset-path": "#rect { offset-path: path('M0 0h50') }",
    "content-visibility": "#window { content-visibility: hidden }",
    "animation": "#rect { animation: a 3s }",
    "animation-name": "#rect { animation-name: a }",
    "mask-mode": "#masked { mask-mode: alpha }",
    "mask-repeat": "#masked { mask-repeat: repeat-x }",
    "mask-position": "#masked { mask-position: 5px 5px }",
    "mask-size": "#masked { mask-size: 5px 5px }",
    "mask-clip": "#masked { mask-clip: fill-box }",
    "mask-origin": "#masked { mask-origin: fill-box }",
    "mask-composite": "#masked { mask-composite: subtract }",
    "mask-border": "#masked { mask-border: url(#hole) 5 }",
    "border": "svg:root { border: 3px solid red }",
    "outline": "svg:root { outline: 3px solid red }",
    "padding": "svg:root { padding: 5px }",
    "font-variant": "#text { font-variant: all-petite-caps }",
    "font-variant-caps": "#text { font-variant-caps: all-petite-caps }",
    "font-size-adjust": "#text { font-size-adjust: 0.9 }",
    "text-emphasis": "#text { text-emphasis: dot }",
    "text-emphasis-style": "#text { text-emphasis-style: dot }",
    "text-shadow": "#text { text-shadow: 3px 3px red }",
}
"""For each property that is counted, a rule with a value that a browser shows something of."""


@cache
def read(css: str = "", text: str = "single") -> Drawing:
    options = ReadingOptions(text="outline" if text == "outline" else "single")
    return read_drawing(SvgInMemory("index.svg", DRAWING.format(css=css).encode()), options=options)


def lines(drawing: Drawing) -> list[tuple[bytes, tuple[int, int, int]]]:
    return [(np.round(outline.beziers, 4).tobytes(), outline.colour) for outline in drawing.outlines]


def bearing(name: str) -> str:
    return PROPERTIES[ALIASES.get(name, name)].bearing


@pytest.mark.parametrize("name", sorted({*INDEX, *OLDER, *CSS} - SHORTHANDS))
def test_every_property_is_in_the_table(name: str) -> None:
    assert name in PROPERTIES or name in ALIASES


def test_every_row_of_the_table_has_a_rule_here() -> None:
    drawn, counted = ({row.name for row in PROPERTIES.values() if row.bearing == kind} for kind in ("drawn", "counted"))
    assert drawn - set(CHANGES) - set(OUTLINES_ALONE) - {"color-interpolation"} == set()
    assert counted - set(WORKING) == set()


@pytest.mark.parametrize("name", CHANGES)
def test_a_property_that_is_drawn_changes_lines(name: str) -> None:
    assert name in SHORTHANDS or bearing(name) == "drawn"
    assert lines(read(CHANGES[name])) != lines(read(BEFORE.get(name, "")))


@pytest.mark.parametrize("name", WORKING)
def test_a_property_that_is_not_honoured_is_counted(name: str) -> None:
    kind = PROPERTIES[name].kind
    assert read(WORKING[name]).skipped[kind] > read().skipped.get(kind, 0)


def test_properties_without_bearing_change_and_count_nothing() -> None:
    names = [row.name for row in PROPERTIES.values() if row.bearing == "none"]
    rule = "".join(f"* {{ {name}: {value} }}" for name in names for value in ("3px", "none", "auto", "3"))
    assert lines(read(rule)) == lines(read())
    assert read(rule).skipped == read().skipped


ELEMENTS = [
    "a",
    "animate",
    "animateMotion",
    "animateTransform",
    "audio",
    "canvas",
    "circle",
    "clipPath",
    "defs",
    "desc",
    "discard",
    "ellipse",
    "feBlend",
    "feColorMatrix",
    "feComponentTransfer",
    "feComposite",
    "feConvolveMatrix",
    "feDiffuseLighting",
    "feDisplacementMap",
    "feDistantLight",
    "feDropShadow",
    "feFlood",
    "feFuncA",
    "feFuncB",
    "feFuncG",
    "feFuncR",
    "feGaussianBlur",
    "feImage",
    "feMerge",
    "feMergeNode",
    "feMorphology",
    "feOffset",
    "fePointLight",
    "feSpecularLighting",
    "feSpotLight",
    "feTile",
    "feTurbulence",
    "filter",
    "foreignObject",
    "g",
    "iframe",
    "image",
    "line",
    "linearGradient",
    "marker",
    "mask",
    "metadata",
    "mpath",
    "path",
    "pattern",
    "polygon",
    "polyline",
    "radialGradient",
    "rect",
    "script",
    "set",
    "stop",
    "style",
    "svg",
    "switch",
    "symbol",
    "text",
    "textPath",
    "title",
    "tspan",
    "unknown",
    "use",
    "video",
    "view",
]
"""Appendix K of SVG 2."""
OLDER_ELEMENTS = [
    "altGlyph",
    "altGlyphDef",
    "altGlyphItem",
    "animateColor",
    "color-profile",
    "cursor",
    "font",
    "font-face",
    "font-face-format",
    "font-face-name",
    "font-face-src",
    "font-face-uri",
    "glyph",
    "glyphRef",
    "hkern",
    "missing-glyph",
    "tref",
    "vkern",
]
"""SVG 1.1."""
DRAFTS = [
    "flowRoot",
    "flowRegion",
    "flowPara",
    "hatch",
    "hatchpath",
    "mesh",
    "meshgradient",
    "meshpatch",
    "meshrow",
    "solidcolor",
]
"""Drafts of SVG 1.2 and 2, that Inkscape wrote."""
SHOWN = {
    "a": "<a>{}</a>",
    "circle": '<circle r="5"/>',
    "ellipse": '<ellipse rx="5" ry="4"/>',
    "g": "<g>{}</g>",
    "line": '<line x2="9" stroke="red"/>',
    "path": '<path d="M0 0h9v9z"/>',
    "polygon": '<polygon points="0 0 9 0 9 9"/>',
    "polyline": '<polyline points="0 0 9 0 9 9"/>',
    "rect": '<rect width="9" height="9"/>',
    "svg": "<svg>{}</svg>",
    "switch": "<switch>{}</switch>",
    "text": '<text y="9">x</text>',
    "tspan": '<text y="9"><tspan>x</tspan></text>',
    "textPath": '<path id="p" d="M0 20h90"/><text><textPath href="#p">x</textPath></text>',
    "symbol": '<symbol id="y">{}</symbol><use href="#y"/>',
    "use": '<rect id="u" width="5" height="5"/><use href="#u" x="7"/>',
    "image": "<image width='9' height='9' href=\"data:image/svg+xml,&lt;svg xmlns='http://www.w3.org/2000/svg'>"
    "&lt;path d='M0 0h9v9z'/>&lt;/svg>\"/>",
}
"""Elements that show something, with something to show."""
SAID = {
    "foreignObject": ('<foreignObject width="9" height="9">x</foreignObject>', "foreignObject"),
    "image": ('<image width="9" height="9" href="data:image/png;base64,AAAA"/>', "image"),
    "animate": ('<rect width="5" height="5"><animate attributeName="x" to="9" dur="1s"/></rect>', "animation"),
    "set": ('<rect width="5" height="5"><set attributeName="x" to="9"/></rect>', "animation"),
    "animateMotion": ('<rect width="5" height="5"><animateMotion path="M0 0h9" dur="1s"/></rect>', "animation"),
    "animateTransform": (
        '<rect width="5" height="5"><animateTransform attributeName="transform" to="9" dur="1s"/></rect>',
        "animation",
    ),
}
"""Elements of which something is shown that no pen draws here, and what is said of it."""


def beside(element: str) -> Drawing:
    text = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 99 99"><path d="M50 50h9v9z"/>{element}</svg>'
    return read_drawing(SvgInMemory("element.svg", text.encode()))


@pytest.mark.parametrize("name", SHOWN)
def test_an_element_that_shows_something_is_drawn(name: str) -> None:
    assert len(beside(SHOWN[name].format('<rect width="9" height="9"/>')).outlines) > 1


@pytest.mark.parametrize("name", SAID)
def test_an_element_that_no_pen_draws_is_counted(name: str) -> None:
    element, kind = SAID[name]
    assert beside(element).skipped.get(kind) == 1


@pytest.mark.parametrize("name", sorted({*ELEMENTS, *OLDER_ELEMENTS, *DRAFTS} - {*SHOWN, "image"}))
def test_an_element_that_shows_nothing_where_it_stands_hides_what_is_in_it(name: str) -> None:
    try:
        drawing = beside(f'<{name}><rect width="9" height="9"/></{name}>')
    except DrawingError as error:
        pytest.fail(f"{name} is refused: {error}")
    assert len(drawing.outlines) == 1
