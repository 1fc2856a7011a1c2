"""The table of properties: what SVG 2, SVG 1.1 and CSS can say about an element, and what becomes of it here.

Those that bear on nothing that a pen draws (colours of shadows, the cursor, hints for rendering) are in the table
too, so that nothing is left out of it by mistake.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from planner.drawing.style import grammar as g
from planner.drawing.style.grammar import Grammar

Bearing = Literal["drawn", "none", "counted"]


@dataclass(frozen=True, slots=True)
class Property:
    """bearing: "drawn", what it says is honoured; "none", it bears neither on geometry nor on visibility of lines;
    "counted", it may, is not honoured, and is counted as `kind` where its value is not among `harmless` and it stands
    on an element among `tags` (any, where there are none). elements: those whose attribute of this name is a
    presentation attribute; `ANY` for all of them.
    """

    name: str
    initial: str
    is_inherited: bool
    grammar: Grammar
    bearing: Bearing
    elements: frozenset[str] = frozenset()
    kind: str = ""
    harmless: frozenset[str] = frozenset()
    tags: frozenset[str] = frozenset()

    def is_attribute_of(self, tag: str) -> bool:
        return self.elements is ANY or tag in self.elements


ANY = frozenset({"*"})
NEVER_RENDERED = frozenset(
    {
        "animate",
        "animateMotion",
        "animateTransform",
        "clipPath",
        "defs",
        "desc",
        "discard",
        "filter",
        "hatch",
        "linearGradient",
        "marker",
        "mask",
        "mesh",
        "metadata",
        "mpath",
        "pattern",
        "radialGradient",
        "script",
        "set",
        "solidcolor",
        "stop",
        "style",
        "symbol",
        "title",
        "view",
    }
)
"""Elements that show nothing where they stand, whatever `display` says."""
TEXT_ELEMENTS = frozenset({"text", "tspan", "textPath", "tref", "altGlyph", "a"})
_PLACED = frozenset({"foreignObject", "image", "mask", "rect", "svg", "symbol", "use"})
_ROUND = frozenset({"circle", "ellipse"})
_OUTERMOST = frozenset({"svg"})
_CSS_ALONE: frozenset[str] = frozenset()


def _drawn(
    name: str, initial: str, grammar: Grammar, elements: frozenset[str] = ANY, *, is_inherited: bool = False
) -> Property:
    return Property(name, initial, is_inherited, grammar, "drawn", elements)


def _inherited(name: str, initial: str, grammar: Grammar, elements: frozenset[str] = ANY) -> Property:
    return _drawn(name, initial, grammar, elements, is_inherited=True)


def _counted(
    name: str,
    initial: str,
    kind: str,
    *harmless: str,
    elements: frozenset[str] = _CSS_ALONE,
    tags: frozenset[str] = frozenset(),
) -> Property:
    is_inherited = tags == TEXT_ELEMENTS
    values = frozenset({initial, *harmless})
    return Property(name, initial, is_inherited, g.anything, "counted", elements, kind, values, tags)


def _without_bearing(names: str) -> Iterator[Property]:
    return (Property(name, "", False, g.anything, "none") for name in names.split())


_UNSIGNED = g.length(is_unitless=True, is_signed=False)
_COORDINATE = g.length(is_unitless=True)
_SIZE = g.length("auto min-content max-content fit-content", is_signed=False)
_RADIUS = g.length("auto", is_unitless=True, is_signed=False)
_OPACITY = g.number(has_percentage=True)
_BASELINES = (
    "auto baseline before-edge text-before-edge middle central after-edge text-after-edge ideographic alphabetic"
    " hanging mathematical"
)
_DISPLAYS = (
    "none inline block contents inline-block inline-flex inline-grid inline-table flex grid table flow flow-root"
    " list-item run-in ruby math table-cell table-row table-column table-caption table-row-group table-header-group"
    " table-footer-group table-column-group -webkit-box -webkit-flex -webkit-inline-box -webkit-inline-flex"
)
_WRITING_MODES = "horizontal-tb vertical-rl vertical-lr sideways-rl sideways-lr lr lr-tb rl rl-tb tb tb-rl"
_FONT_SIZES = "xx-small x-small small medium large x-large xx-large xxx-large smaller larger"

_TABLE = (
    # Geometry (SVG 2, section 7.4 and chapter 9)
    _drawn("x", "0", _COORDINATE, _PLACED),
    _drawn("y", "0", _COORDINATE, _PLACED),
    _drawn("width", "auto", _SIZE, _PLACED),
    _drawn("height", "auto", _SIZE, _PLACED),
    _drawn("cx", "0", _COORDINATE, _ROUND),
    _drawn("cy", "0", _COORDINATE, _ROUND),
    _drawn("r", "0", _UNSIGNED, frozenset({"circle"})),
    _drawn("rx", "auto", _RADIUS, frozenset({"rect", "ellipse"})),
    _drawn("ry", "auto", _RADIUS, frozenset({"rect", "ellipse"})),
    _drawn("d", "", g.path_data, frozenset({"path"})),
    # Transforms (CSS Transforms 1 and 2); the origin is where the browser's own style sheet for SVG puts it
    _drawn("transform", "none", g.transform),
    _drawn("transform-origin", "0 0", g.transform_origin),
    _drawn("transform-box", "view-box", g.words("content-box border-box fill-box stroke-box view-box"), _CSS_ALONE),
    _drawn("translate", "none", g.translate, _CSS_ALONE),
    _drawn("rotate", "none", g.rotate, _CSS_ALONE),
    _drawn("scale", "none", g.scale, _CSS_ALONE),
    # Rendering (SVG 2, chapters 3 and 13)
    _drawn("display", "inline", g.several(_DISPLAYS)),
    _inherited("visibility", "visible", g.words("visible hidden collapse")),
    _drawn("overflow", "visible", g.several("visible hidden scroll auto clip overlay")),
    _drawn("opacity", "1", _OPACITY),
    _inherited("color", "black", g.colour),
    _inherited("fill", "black", g.paint),
    _inherited("fill-opacity", "1", _OPACITY),
    _inherited("fill-rule", "nonzero", g.words("nonzero evenodd")),
    _inherited("stroke", "none", g.paint),
    _inherited("stroke-opacity", "1", _OPACITY),
    _inherited("stroke-width", "1", _UNSIGNED),
    _inherited("stroke-dasharray", "none", g.lengths("none")),
    _inherited("stroke-dashoffset", "0", _COORDINATE),
    _inherited("stroke-linecap", "butt", g.words("butt round square")),
    _inherited("stroke-linejoin", "miter", g.words("miter round bevel")),
    _inherited("stroke-miterlimit", "4", g.number(least=0.0)),
    _drawn("vector-effect", "none", g.words("none non-scaling-stroke")),
    _inherited("marker-start", "none", g.reference),
    _inherited("marker-mid", "none", g.reference),
    _inherited("marker-end", "none", g.reference),
    _drawn("stop-color", "black", g.colour),
    _drawn("stop-opacity", "1", _OPACITY),
    # Clips and masks (CSS Masking 1)
    _drawn("clip-path", "none", g.clip_path),
    _inherited("clip-rule", "nonzero", g.words("nonzero evenodd")),
    _drawn("mask", "none", g.anything),
    _drawn("mask-type", "luminance", g.words("luminance alpha")),
    _inherited("color-interpolation", "srgb", g.words("auto srgb linearrgb")),
    # Text (SVG 2, chapter 11)
    _inherited("font-family", "", g.anything),
    _inherited("font-size", "16px", g.length(_FONT_SIZES, is_signed=False)),
    _inherited("font-style", "normal", g.font_style),
    _inherited("font-weight", "400", g.number("normal bold bolder lighter", least=1.0, most=1000.0)),
    _inherited("font-stretch", "normal", g.font_stretch),
    _inherited("line-height", "normal", g.length("normal", is_unitless=True, is_signed=False), _CSS_ALONE),
    _inherited("direction", "ltr", g.words("ltr rtl")),
    _drawn("unicode-bidi", "normal", g.words("normal embed isolate bidi-override isolate-override plaintext")),
    _inherited("writing-mode", "horizontal-tb", g.words(_WRITING_MODES)),
    _inherited("text-orientation", "mixed", g.words("mixed upright sideways"), _CSS_ALONE),
    _inherited("text-anchor", "start", g.words("start middle end")),
    _inherited("dominant-baseline", "auto", g.words("use-script no-change reset-size " + _BASELINES)),
    _drawn("alignment-baseline", "baseline", g.words(_BASELINES)),
    _drawn("baseline-shift", "baseline", g.length("baseline sub super", is_unitless=True)),
    _inherited("letter-spacing", "normal", g.length("normal")),
    _inherited("word-spacing", "normal", g.length("normal")),
    _drawn("text-decoration", "none", g.anything),
    _inherited("white-space", "normal", g.words("normal pre nowrap pre-wrap pre-line break-spaces"), _CSS_ALONE),
    _inherited("text-transform", "none", g.words("none capitalize uppercase lowercase math-auto"), _CSS_ALONE),
    # Not honoured
    _counted("filter", "none", "filter", elements=ANY),
    _counted("offset-path", "none", "offset-path"),
    _counted("content-visibility", "visible", "content-visibility", "auto", tags=_OUTERMOST),
    _counted("animation", "none", "animation"),
    _counted("animation-name", "none", "animation"),
    _counted("mask-mode", "match-source", "layers of a mask"),
    _counted("mask-repeat", "repeat", "layers of a mask", "no-repeat"),
    _counted("mask-position", "0% 0%", "layers of a mask", "0 0", "0px 0px"),
    _counted("mask-size", "auto", "layers of a mask", "contain", "cover", "100% 100%"),
    _counted("mask-clip", "border-box", "layers of a mask"),
    _counted("mask-origin", "border-box", "layers of a mask"),
    _counted("mask-composite", "add", "layers of a mask"),
    _counted("mask-border", "none", "border of a mask"),
    _counted("border", "none", "border", "0", "0px", tags=_OUTERMOST),
    _counted("outline", "none", "border", "0", "0px", tags=_OUTERMOST),
    _counted("padding", "0", "padding", "0px", tags=_OUTERMOST),
    _counted("font-variant", "normal", "font variant", "none", "small-caps", elements=ANY, tags=TEXT_ELEMENTS),
    _counted("font-variant-caps", "normal", "font variant", "small-caps", tags=TEXT_ELEMENTS),
    _counted("font-size-adjust", "none", "font-size-adjust", tags=TEXT_ELEMENTS),
    _counted("text-emphasis", "none", "text-emphasis", tags=TEXT_ELEMENTS),
    _counted("text-emphasis-style", "none", "text-emphasis", tags=TEXT_ELEMENTS),
    _counted("text-shadow", "none", "text-shadow", tags=TEXT_ELEMENTS),
    # No browser knows these, or they have no effect in a drawing: `shape-inside` of text, the rectangle of `clip`, the
    # boxes of CSS, `zoom`. Or they tell how something is painted, not where.
    *_without_bearing(
        """
        appearance aspect-ratio backface-visibility background background-color background-image buffered-rendering
        clip color-interpolation-filters color-profile color-rendering color-scheme cursor enable-background
        flood-color flood-opacity font-feature-settings font-kerning font-language-override font-optical-sizing
        font-palette font-synthesis font-variant-alternates font-variant-east-asian font-variant-emoji
        font-variant-ligatures font-variant-numeric font-variant-position font-variation-settings
        forced-color-adjust glyph-orientation-horizontal glyph-orientation-vertical hyphens image-orientation
        image-rendering isolation kerning lighting-color line-break margin mix-blend-mode object-fit
        object-position offset-anchor offset-distance offset-position offset-rotate overflow-wrap paint-order
        perspective perspective-origin pointer-events position print-color-adjust quotes scroll-behavior
        shape-image-threshold shape-inside shape-margin shape-padding shape-rendering shape-subtract solid-color
        solid-opacity tab-size text-align text-align-all text-align-last text-combine-upright text-decoration-color
        text-decoration-fill text-decoration-skip-ink text-decoration-stroke text-decoration-style
        text-decoration-thickness text-indent text-overflow text-rendering text-underline-offset
        text-underline-position text-wrap touch-action transform-style transition transition-property user-select
        vertical-align viewport-fill viewport-fill-opacity white-space-collapse will-change word-break z-index zoom
        """
    ),
)

PROPERTIES = {row.name: row for row in _TABLE}
ALIASES = {
    "-webkit-transform": "transform",
    "-webkit-transform-origin": "transform-origin",
    "-webkit-clip-path": "clip-path",
    "-webkit-filter": "filter",
    "-webkit-opacity": "opacity",
    "-webkit-mask": "mask",
    "-webkit-mask-image": "mask",
    "mask-image": "mask",
    "-webkit-mask-box-image": "mask-border",
    "-webkit-mask-repeat": "mask-repeat",
    "-webkit-mask-position": "mask-position",
    "-webkit-mask-size": "mask-size",
    "-webkit-mask-composite": "mask-composite",
    "-webkit-animation": "animation",
    "-webkit-animation-name": "animation-name",
    "inline-size": "width",
    "block-size": "height",
    "overflow-x": "overflow",
    "overflow-y": "overflow",
    "offset": "offset-path",
    "font-width": "font-stretch",
    "text-decoration-line": "text-decoration",
}
"""Other names of the same property, and longhands of which the shorthand stands in the table."""
INITIAL = {row.name: row.initial for row in _TABLE}
INHERITED = frozenset(row.name for row in _TABLE if row.is_inherited)
COUNTED = {row.name: row for row in _TABLE if row.bearing == "counted"}
ATTRIBUTES = {row.name: row for row in _TABLE if row.elements}
"""Those that are presentation attributes of some element."""
