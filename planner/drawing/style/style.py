"""What a property of an element comes to: cascade, inheritance, custom properties, units."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from planner.drawing.style.cascade import ATTRIBUTE_LAYER, STYLE_LAYER, Cascade, Declared
from planner.drawing.style.colour import BLACK, NO_PAINT, PaintValue, Rgba, parse_colour, parse_paint
from planner.drawing.style.declarations import UNITLESS_IN_STYLE, WIDE_KEYWORDS, has_substitution, valid
from planner.drawing.style.properties import COUNTED, INHERITED, INITIAL, TEXT_ELEMENTS
from planner.drawing.style.sheet import Sheets
from planner.drawing.style.shorthands import expanded
from planner.drawing.style.tokens import component_values, text_of
from planner.drawing.style.units import MEDIUM_FONT_PX, Axis, Units, normal_line_height, units_of_page
from planner.drawing.style.variables import Unresolvable, resolved, substituted
from planner.drawing.xml_tree import Document, Element

_NOTHING: Mapping[str, str] = MappingProxyType({})
_SIZES = {
    "xx-small": 0.5625,
    "x-small": 0.625,
    "small": 0.8125,
    "medium": 1.0,
    "large": 1.125,
    "x-large": 1.5,
    "xx-large": 2.0,
    "xxx-large": 3.0,
}
"""Of the medium size."""
_STEP = 1.2
"""From one size to the next, for `larger` and `smaller`."""
# Lengths that depend on the font where they are said, and are handed down as what they came to there.
_HANDED_DOWN = frozenset({"stroke-width", "stroke-dasharray", "stroke-dashoffset", "line-height"})
_OF_FONT = frozenset({"letter-spacing", "word-spacing", "baseline-shift", "line-height"})
"""Lengths whose percentages are of the font size."""
# Lengths that are not handed down, but may be asked for with `inherit`.
_WITH_UNITS = frozenset({"x", "y", "width", "height", "cx", "cy", "r", "rx", "ry", "transform", "transform-origin"})
_NEVER_NEGATIVE = frozenset({"width", "height", "r", "rx", "ry", "stroke-width"})
_OLD_WRITING_MODES = {
    "lr": "horizontal-tb",
    "lr-tb": "horizontal-tb",
    "rl": "horizontal-tb",
    "rl-tb": "horizontal-tb",
    "tb": "vertical-rl",
    "tb-rl": "vertical-rl",
}


class Style:
    """The computed style of one element in one place of the rendering tree (`use` shows an element in several)."""

    __slots__ = ("_inherited", "_own", "_page", "_units", "_variables", "element", "parent")

    def __init__(
        self,
        page: _Page,
        element: Element | None,
        parent: Style | None,
        own: Mapping[str, str],
        inherited: Mapping[str, str],
        variables: Mapping[str, str],
        units: Units,
    ) -> None:
        """parent: that of what the element is shown under. own: what was said of it; inherited: what it hands down.
        Both computed."""
        self.element = element
        self.parent = parent
        self._page = page
        self._own = own
        self._inherited = inherited
        self._variables = variables
        self._units = units

    @property
    def font_size(self) -> float:
        """In user units."""
        return self._units.font_size

    def __getitem__(self, name: str) -> str:
        """The computed value of a property as text: cascade by origin, importance, specificity and order, `var()`,
        `inherit`, `initial`, `unset` and `revert` resolved, inherited where that is the rule, invalid values dropped.
        Presentation attributes and geometry properties (`x`, `r`, `d`, `transform`, ...) included; the initial value
        where nothing was said. `d` is plain path data, "" for none. Errors: KeyError for no property that is drawn."""
        value = self._own.get(name)
        if value is None:
            value = self._inherited.get(name)
        return INITIAL[name] if value is None else value

    def length(self, name: str, axis: Axis) -> float | None:
        """A property that is a length, in user units, what is calculated for a size at least zero; None for `auto` and
        the like."""
        length = self._units.length(self[name], axis)
        return max(length, 0.0) if length is not None and name in _NEVER_NEGATIVE else length

    def in_units(self, text: str, axis: Axis) -> float | None:
        """Any length or percentage by the units of this place; None where it is none."""
        return self._units.length(text.strip(), axis)

    def number(self, name: str) -> float:
        """A property that is a number, an opacity within 0 to 1."""
        quantity = self._units.quantity(self[name], "diagonal")
        value = quantity.value if quantity else float(INITIAL[name])
        return min(max(value, 0.0), 1.0) if name.endswith("opacity") else value

    def colour(self, name: str) -> Rgba:
        """A property that is a colour, `currentcolor` resolved."""
        found = parse_colour(self[name])
        if found == "currentcolor":
            found = BLACK if name == "color" else self.colour("color")
        return found or BLACK

    def paint(self, name: str) -> PaintValue:
        """`fill` or `stroke`, `currentcolor` resolved, in a fallback too."""
        return self._resolved(parse_paint(self[name]) or NO_PAINT)

    def _resolved(self, paint: PaintValue) -> PaintValue:
        if paint.kind == "currentcolor":
            return PaintValue("colour", self.colour("color"))
        if paint.fallback is not None:
            return PaintValue(paint.kind, paint.colour, paint.url, self._resolved(paint.fallback))
        return paint

    def unhonoured(self) -> list[str]:
        """What is said of the element, bears on what it shows and is not honoured, as people read it."""
        tag = self.element.tag if self.element is not None else ""
        said = self._own.keys() | self._inherited.keys() if tag in TEXT_ELEMENTS else self._own.keys()
        found = set()
        for name in said & COUNTED.keys():
            row = COUNTED[name]
            if self[name].lower() not in row.harmless and (not row.tags or tag in row.tags):
                found.add(row.kind)
        return sorted(found)


class _Page:
    """The cascade on a page of one size, and the styles that were computed there."""

    def __init__(self, cascade: Cascade) -> None:
        self.cascade = cascade
        self.styles: dict[tuple[Element, Style, tuple[float, float]], Style] = {}


class Styles:
    """All styles of a document. skipped: what its style sheets ask for that is not followed, by kind."""

    def __init__(self, document: Document) -> None:
        sheets = Sheets()
        sheets.read(document)
        self.skipped: Counter[str] = sheets.skipped
        self._rules = sheets.rules
        self._document = document

    def root(self, viewport: tuple[float, float]) -> Style:
        """That of what the outermost `svg` inherits from: initial values, with the page as the viewport."""
        page = _Page(Cascade(self._document, self._rules, viewport))
        return Style(page, None, None, _NOTHING, _NOTHING, _NOTHING, units_of_page(viewport))

    def of(self, element: Element, parent: Style, viewport: tuple[float, float]) -> Style:
        """That of an element that is shown under something with the style `parent`; `viewport` is the size of the
        nearest viewport in user units, which percentages are of."""
        key = element, parent, viewport
        known = parent._page.styles
        style = known.get(key)
        if style is None:
            style = known[key] = _computed(element, parent, viewport)
        return style


def _computed(element: Element, parent: Style, viewport: tuple[float, float]) -> Style:
    said = parent._page.cascade.said(element)
    variables = _custom_properties(said.variables, parent) if said.variables else parent._variables
    values = {}
    handed_down = {}
    for name, entry in said.properties.items():
        value = entry.value
        if value in WIDE_KEYWORDS or ("(" in value and name != "d"):
            value = _value(name, entry, parent, variables)
        values[name] = value
    font_size = parent._units.font_size
    if "font-size" in values:
        font_size = _font_size(values["font-size"], parent._units)
        values["font-size"] = f"{font_size:.10g}px"
    units = _units(element, parent, viewport, font_size, values)
    for name, value in values.items():
        if name in _RECKONED:
            values[name] = value = _reckoned(name, value, parent, units)
        if name in INHERITED:
            handed_down[name] = value
    inherited = {**parent._inherited, **handed_down} if handed_down else parent._inherited
    return Style(parent._page, element, parent, values, inherited, variables, units)


def _custom_properties(said: Mapping[str, Declared], parent: Style) -> Mapping[str, str]:
    """Those of the parent with those that are said, variables in them replaced."""
    parent._page.cascade.spend(len(said) + len(parent._variables))
    given = {name: _winner(name, entry, parent) for name, entry in said.items()}
    defined = {name: value for name, value in given.items() if value is not None}
    inherited = {name: value for name, value in parent._variables.items() if name not in given}
    return resolved(defined, inherited)


_RECKONED = _HANDED_DOWN | _OF_FONT | {"font-weight", "writing-mode", "color"}


def _units(
    element: Element, parent: Style, viewport: tuple[float, float], font_size: float, values: dict[str, str]
) -> Units:
    """Those of an element. `lh` is its own line height, but in `line-height`, which is reckoned here, that above."""
    above = parent._units
    is_outermost = element.parent is None  # `rem` and `rlh` are those of it
    if not is_outermost and "line-height" not in values and font_size == above.font_size:
        return above if viewport == above.viewport else replace(above, viewport=viewport)
    units = replace(above, font_size=font_size, viewport=viewport)
    if is_outermost:
        units = replace(units, root_font_size=font_size)
    if "line-height" in values:
        values["line-height"] = units.without_font(values["line-height"], is_percentage_of_font=True)
    quantity = units.quantity(values.get("line-height", parent["line-height"]), "y")
    if quantity is None:  # `normal`
        line_height = normal_line_height(font_size)
    else:
        line_height = quantity.value * (font_size if quantity.kind == "number" else 1.0)
    return replace(
        units, line_height=line_height, root_line_height=line_height if is_outermost else above.root_line_height
    )


def _winner(name: str, entry: Declared | None, parent: Style) -> str | None:
    """A custom property before its variables are replaced; None where it is not defined."""
    entry = _reverted(entry)
    if entry is None or entry.value.lower() in ("inherit", "unset"):
        return parent._variables.get(name)
    return None if entry.value.lower() == "initial" else entry.value


def _reverted(entry: Declared | None) -> Declared | None:
    """The declaration that counts once `revert` and `revert-layer` have gone back to what they overrule."""
    while entry is not None and entry.value in ("revert", "revert-layer"):
        layer, to_browser = entry.layer, entry.value == "revert"
        while entry is not None and (entry.layer == layer or (to_browser and entry.layer is not None)):
            entry = entry.below
    return entry


def _value(name: str, entry: Declared | None, parent: Style, variables: Mapping[str, str]) -> str:
    """The value of a property with nothing left to look up, but for units."""
    entry = _reverted(entry)
    value: str | None = "unset" if entry is None else entry.value
    if entry is not None and value is not None and "(" in value and has_substitution(value):
        value = _substituted(name, entry, variables)
    if value is None or value == "unset" or value in ("revert", "revert-layer"):
        value = "inherit" if name in INHERITED else "initial"
    if value == "inherit":
        return parent._units.without_font(parent[name]) if name in _WITH_UNITS else parent[name]
    return INITIAL[name] if value == "initial" else value


def _substituted(name: str, entry: Declared, variables: Mapping[str, str]) -> str | None:
    """None where it does not come to a value: then it is as if `unset` had been said."""
    try:
        text = substituted(entry.value, variables)
    except (Unresolvable, RecursionError):
        return None
    if entry.shorthand and text.lower() not in WIDE_KEYWORDS:
        return expanded(entry.shorthand, text).get(name)
    is_quirky = entry.layer == STYLE_LAYER and name in UNITLESS_IN_STYLE
    return valid(name, text, is_attribute=is_quirky or entry.layer == ATTRIBUTE_LAYER)


def _font_size(value: str, above: Units) -> float:
    """In user units. Percentages and `em` are of the parent's."""
    if value in _SIZES:
        return MEDIUM_FONT_PX * _SIZES[value]
    if value in ("larger", "smaller"):
        return above.font_size * (_STEP if value == "larger" else 1.0 / _STEP)
    size = replace(above, viewport=(above.font_size, above.font_size)).length(value, "x")
    return above.font_size if size is None else max(size, 0.0)


def _reckoned(name: str, value: str, parent: Style, units: Units) -> str:
    """What is handed down: lengths without the font that they were said with, words as numbers."""
    if name == "color":
        return parent["color"] if value.lower() == "currentcolor" else value
    if name == "writing-mode":
        return _OLD_WRITING_MODES.get(value, value)
    if name == "font-weight":
        return _weight(value, parent)
    if name == "stroke-dasharray" and "(" in value:
        return _plain_lengths(value, units)
    return units.without_font(value, name in _OF_FONT)


def _plain_lengths(value: str, units: Units) -> str:
    """Each in px, so that blanks stand between lengths alone."""
    found = [units.length(text_of([token]), "diagonal") for token in component_values(value)]
    return " ".join(f"{max(length or 0.0, 0.0):.10g}px" for length in found)


def _weight(value: str, parent: Style) -> str:
    """As a number (CSS Fonts 4, section 2.2.1)."""
    known = {"normal": "400", "bold": "700"}
    if value in ("bolder", "lighter"):
        above = float(known.get(parent["font-weight"], parent["font-weight"]))
        if value == "bolder":
            return "400" if above < 350.0 else "700" if above < 550.0 else f"{max(above, 900.0):g}"
        return f"{above:g}" if above < 100.0 else "100" if above < 550.0 else "400" if above < 750.0 else "700"
    return known.get(value, value)
