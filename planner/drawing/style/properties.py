"""The table of properties: what SVG 2, SVG 1.1 and CSS can say about an element, and what becomes of it here.

Those that bear on nothing that a pen draws (colours of shadows, the cursor, hints for rendering) are in the table
too, so that nothing is left out of it by mistake.
"""

from __future__ import annotations

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
_VIEWPORTS = frozenset({"svg", "symbol", "image", "foreignObject", "mask", "rect", "use"})
_OUTERMOST = frozenset({"svg"})
_FONT_WORDS = {"normal"}

_TABLE: list[Property] = []


def _drawn(
    name: str, initial: str, grammar: Grammar, *, inherited: bool = False, elements: frozenset[str] = ANY
) -> None:
    _TABLE.append(Property(name, initial, inherited, grammar, "drawn", elements))


def _css(name: str, initial: str, grammar: Grammar, *, inherited: bool = False) -> None:
    """Drawn, and no presentation attribute."""
    _drawn(name, initial, grammar, inherited=inherited, elements=frozenset())


def _counted(
    name: str,
    initial: str,
    kind: str,
    *harmless: str,
    grammar: Grammar = g.anything,
    inherited: bool = False,
    elements: frozenset[str] = frozenset(),
    tags: frozenset[str] = frozenset(),
) -> None:
    values = frozenset({initial, *harmless})
    _TABLE.append(Property(name, initial, inherited, grammar, "counted", elements, kind, values, tags))


def _without_bearing(names: str) -> None:
    _TABLE.extend(Property(name, "", False, g.anything, "none") for name in names.split())


_UNSIGNED = g.length(is_unitless=True, is_signed=False)
_COORDINATE = g.length(is_unitless=True)
_SIZE = g.length("auto", "min-content", "max-content", "fit-content", is_signed=False)
_OPACITY = g.number(has_percentage=True)

# Geometry (SVG 2, section 7.4 and chapter 9)
_drawn("x", "0", _COORDINATE, elements=_VIEWPORTS)
_drawn("y", "0", _COORDINATE, elements=_VIEWPORTS)
_drawn("width", "auto", _SIZE, elements=_VIEWPORTS)
_drawn("height", "auto", _SIZE, elements=_VIEWPORTS)
_drawn("cx", "0", _COORDINATE, elements=frozenset({"circle", "ellipse"}))
_drawn("cy", "0", _COORDINATE, elements=frozenset({"circle", "ellipse"}))
_drawn("r", "0", _UNSIGNED, elements=frozenset({"circle"}))
_drawn("rx", "auto", g.length("auto", is_unitless=True, is_signed=False), elements=frozenset({"rect", "ellipse"}))
_drawn("ry", "auto", g.length("auto", is_unitless=True, is_signed=False), elements=frozenset({"rect", "ellipse"}))
_drawn("d", "", g.path_data, elements=frozenset({"path"}))
# Transforms (CSS Transforms 1 and 2); the user agent's style sheet of SVG puts the origin at 0 0
_drawn("transform", "none", g.transform)
_drawn("transform-origin", "0 0", g.transform_origin)
_css("transform-box", "view-box", g.words("content-box", "border-box", "fill-box", "stroke-box", "view-box"))
_css("translate", "none", g.anything)
_css("rotate", "none", g.anything)
_css("scale", "none", g.anything)
# Rendering (SVG 2, chapters 3 and 13)
_drawn(
    "display",
    "inline",
    g.several(
        *["none", "inline", "block", "contents", "inline-block", "inline-flex", "inline-grid", "inline-table", "flex", "grid", "table", "flow", "flow-root", "list-item", "run-in", "ruby", "math", "table-cell", "table-row", "table-column", "table-caption", "table-row-group", "table-header-group", "table-footer-group", "table-column-group", "-webkit-box", "-webkit-flex", "-webkit-inline-box", "-webkit-inline-flex"]
    ),
)
_drawn("visibility", "visible", g.words("visible", "hidden", "collapse"), inherited=True)
_drawn("overflow", "visible", g.several("visible", "hidden", "scroll", "auto", "clip", "overlay"))
_drawn("opacity", "1", _OPACITY)
_drawn("color", "black", g.colour, inherited=True)
_drawn("fill", "black", g.paint, inherited=True)
_drawn("fill-opacity", "1", _OPACITY, inherited=True)
_drawn("fill-rule", "nonzero", g.words("nonzero", "evenodd"), inherited=True)
_drawn("stroke", "none", g.paint, inherited=True)
_drawn("stroke-opacity", "1", _OPACITY, inherited=True)
_drawn("stroke-width", "1", _UNSIGNED, inherited=True)
_drawn("stroke-dasharray", "none", g.lengths("none"), inherited=True)
_drawn("stroke-dashoffset", "0", _COORDINATE, inherited=True)
_drawn("stroke-linecap", "butt", g.words("butt", "round", "square"), inherited=True)
_drawn("stroke-linejoin", "miter", g.words("miter", "round", "bevel"), inherited=True)
_drawn("stroke-miterlimit", "4", g.number(least=0.0), inherited=True)
_drawn("vector-effect", "none", g.words("none", "non-scaling-stroke"))
_drawn("marker-start", "none", g.reference, inherited=True)
_drawn("marker-mid", "none", g.reference, inherited=True)
_drawn("marker-end", "none", g.reference, inherited=True)
_drawn("stop-color", "black", g.colour)
_drawn("stop-opacity", "1", _OPACITY)
# Clips and masks (CSS Masking 1)
_drawn("clip-path", "none", g.clip_path)
_drawn("clip-rule", "nonzero", g.words("nonzero", "evenodd"), inherited=True)
_drawn("mask", "none", g.anything)
_drawn("mask-type", "luminance", g.words("luminance", "alpha"))
_drawn("color-interpolation", "srgb", g.words("auto", "srgb", "linearrgb"), inherited=True)
# Text (SVG 2, chapter 11)
_drawn("font-family", "", g.anything, inherited=True)
_drawn(
    "font-size",
    "medium",
    g.length(*["xx-small", "x-small", "small", "medium", "large", "x-large", "xx-large", "xxx-large", "smaller", "larger"], is_signed=False),
    inherited=True,
)
_drawn("font-style", "normal", g.anything, inherited=True)
_drawn("font-weight", "normal", g.number("normal", "bold", "bolder", "lighter", least=1.0), inherited=True)
_drawn("font-stretch", "normal", g.anything, inherited=True)
_css("line-height", "normal", g.length("normal", is_unitless=True, is_signed=False), inherited=True)
_drawn("direction", "ltr", g.words("ltr", "rtl"), inherited=True)
_drawn(
    "unicode-bidi",
    "normal",
    g.words("normal", "embed", "isolate", "bidi-override", "isolate-override", "plaintext"),
)
_drawn(
    "writing-mode",
    "horizontal-tb",
    g.words(*["horizontal-tb", "vertical-rl", "vertical-lr", "sideways-rl", "sideways-lr", "lr", "lr-tb", "rl", "rl-tb", "tb", "tb-rl"]),
    inherited=True,
)
_css("text-orientation", "mixed", g.words("mixed", "upright", "sideways"), inherited=True)
_drawn("text-anchor", "start", g.words("start", "middle", "end"), inherited=True)
_BASELINES = ["auto", "baseline", "before-edge", "text-before-edge", "middle", "central", "after-edge", "text-after-edge", "ideographic", "alphabetic", "hanging", "mathematical"]
_drawn(
    "dominant-baseline",
    "auto",
    g.words("use-script", "no-change", "reset-size", *_BASELINES),
    inherited=True,
)
_drawn("alignment-baseline", "baseline", g.words(*_BASELINES))
_drawn("baseline-shift", "baseline", g.length("baseline", "sub", "super", is_unitless=True))
_drawn("letter-spacing", "normal", g.length("normal"), inherited=True)
_drawn("word-spacing", "normal", g.length("normal"), inherited=True)
_drawn("text-decoration", "none", g.anything)
_css(
    "white-space", "normal", g.words("normal", "pre", "nowrap", "pre-wrap", "pre-line", "break-spaces"), inherited=True
)
_css(
    "text-transform",
    "none",
    g.words("none", "capitalize", "uppercase", "lowercase", "full-size-kana", "math-auto"),
    inherited=True,
)
# Not honoured
_counted("filter", "none", "filter", elements=ANY)
_counted("offset-path", "none", "offset-path")
_counted("perspective", "none", "perspective")
_counted("zoom", "1", "zoom", "normal", "100%", "reset")
_counted("content-visibility", "visible", "content-visibility", "auto", tags=_OUTERMOST)
_counted("animation", "none", "animation")
_counted("animation-name", "none", "animation")
_counted("mask-mode", "match-source", "mask layers")
_counted("mask-repeat", "repeat", "mask layers", "no-repeat")
_counted("mask-position", "0% 0%", "mask layers", "0 0", "0px 0px")
_counted("mask-size", "auto", "mask layers", "contain", "cover", "100% 100%")
_counted("mask-clip", "border-box", "mask layers")
_counted("mask-origin", "border-box", "mask layers")
_counted("mask-composite", "add", "mask layers")
_counted("mask-border", "none", "mask border")
_counted("border", "none", "border", "0", "0px", tags=_OUTERMOST)
_counted("outline", "none", "border", "0", "0px", tags=_OUTERMOST)
_counted("padding", "0", "padding", "0px", tags=_OUTERMOST)
_counted(
    "font-variant", "normal", "font variant", "none", "small-caps", elements=ANY, inherited=True, tags=TEXT_ELEMENTS
)
_counted("font-variant-caps", "normal", "font variant", "small-caps", inherited=True, tags=TEXT_ELEMENTS)
_counted("font-variant-position", "normal", "font variant", inherited=True, tags=TEXT_ELEMENTS)
_counted("font-size-adjust", "none", "font-size-adjust", inherited=True, tags=TEXT_ELEMENTS)
_counted("text-combine-upright", "none", "text-combine-upright", inherited=True, tags=TEXT_ELEMENTS)
_counted("text-emphasis", "none", "text-emphasis", inherited=True, tags=TEXT_ELEMENTS)
_counted("text-emphasis-style", "none", "text-emphasis", inherited=True, tags=TEXT_ELEMENTS)
_counted("text-indent", "0", "text-indent", "0px", "0%", inherited=True, tags=TEXT_ELEMENTS)
# No browser knows these, or they have no effect in drawings: `inline-size` and `shape-inside` of text, rectangles of
# `clip`, the boxes of CSS, `vertical-align` of text. Or they tell how something is painted, not where.
_without_bearing(
    """
    all appearance aspect-ratio backface-visibility background background-color background-image buffered-rendering
    clip color-interpolation-filters color-profile color-rendering color-scheme cursor enable-background fill-color
    flood-color flood-opacity font-feature-settings font-kerning font-language-override font-optical-sizing
    font-palette font-synthesis font-variant-alternates font-variant-east-asian font-variant-emoji
    font-variant-ligatures font-variant-numeric font-variation-settings forced-color-adjust
    glyph-orientation-horizontal glyph-orientation-vertical hyphens image-orientation image-rendering inline-size
    isolation kerning lighting-color line-break margin mix-blend-mode object-fit object-position offset-anchor
    offset-distance offset-position offset-rotate overflow-wrap paint-order pointer-events position
    print-color-adjust quotes scroll-behavior shape-image-threshold shape-inside shape-margin shape-padding
    shape-rendering shape-subtract solid-color solid-opacity tab-size text-align text-align-all text-align-last
    text-decoration-color text-decoration-fill text-decoration-skip-ink text-decoration-stroke
    text-decoration-style text-decoration-thickness text-overflow text-rendering text-shadow text-underline-offset
    text-underline-position text-wrap touch-action transform-style transition transition-property user-select
    vertical-align white-space-collapse will-change word-break z-index
    """
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
    "-webkit-perspective": "perspective",
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
