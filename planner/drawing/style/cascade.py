"""The cascade: which declarations of an element win (CSS Cascading 5, section 6).

From the weakest to the strongest: the browser's own sheet, presentation attributes, rules by layer, specificity and
order, the style attribute; then what is `!important`, with layers the other way round.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import lru_cache
from typing import NamedTuple

from cssselect2.parser import SelectorError

from planner.drawing.style import media
from planner.drawing.style.declarations import (
    Declaration,
    in_attribute,
    in_common_attribute,
    is_plain,
    parse_style_attribute,
)
from planner.drawing.style.properties import ATTRIBUTES
from planner.drawing.style.selectors import Matches, Tree, compiled, subject
from planner.drawing.style.sheet import UNLAYERED, Layer, Rule
from planner.drawing.xml_tree import Document, Element
from planner.errors import DrawingError

WORK_LIMIT = 10_000_000
"""Steps: a rule tried on an element, a custom property handed down to it, a character of a long value."""
_STEPS_OF_A_MATCH = 3
_LONG = 1000


class Declared(NamedTuple):
    """A declaration that applies to an element, and the one that it wins over, if any. layer: None for what is no
    author's rule: the browser's own."""

    value: str
    shorthand: str
    layer: Layer | None
    below: Declared | None


class Said(NamedTuple):
    """The winning declarations of properties, and of custom properties."""

    properties: dict[str, Declared]
    variables: dict[str, Declared]


_HIDDEN = {"overflow": Declared("hidden", "", None, None)}
_BY_BROWSER: dict[str, dict[str, Declared]] = {
    **dict.fromkeys(("svg", "symbol", "image", "marker", "pattern", "foreignObject"), _HIDDEN)
}
"""The browser's own sheet, where it bears on drawings."""
_OUTERMOST = {"transform-origin": Declared("50% 50%", "", None, None)}
_TRANSFORM_ATTRIBUTES = {
    "linearGradient": "gradientTransform",
    "radialGradient": "gradientTransform",
    "pattern": "patternTransform",
}
"""What the attribute for `transform` is called where it is not called that."""
_BY_ATTRIBUTE_ALONE = {
    "svg": ("x", "y", "width", "height"),
    "symbol": ("x", "y", "width", "height"),
    "use": ("width", "height"),
    "mask": ("x", "y", "width", "height"),
}
"""What browsers take from the attribute whatever style sheets say; not so of the outermost `svg`."""
_GEOMETRY = frozenset({"x", "y", "width", "height", "cx", "cy", "r", "rx", "ry"})
ATTRIBUTE_LAYER: Layer = (-1.0,)
STYLE_LAYER: Layer = (*UNLAYERED, 1.0)


class Cascade:
    """The rules that are in force on a page of one size."""

    def __init__(self, document: Document, rules: Sequence[Rule], page: tuple[float, float]) -> None:
        self._source = document.source
        self._work = 0
        self._buckets: dict[tuple[str, str], list[tuple[Matches, Rule]]] = {}
        tree = Tree(document.root)
        for rule in rules:
            if all(media.matches(query, page) for query in rule.conditions):
                try:
                    entry = compiled(rule.selector, tree), rule
                except (SelectorError, RecursionError):
                    continue
                self._buckets.setdefault(subject(rule.selector), []).append(entry)
        self._known: dict[Element, Said] = {}

    def said(self, element: Element) -> Said:
        """What is said of an element, and wins."""
        found = self._known.get(element)
        if found is None:
            found = self._known[element] = self._cascaded(element)
        return found

    def spend(self, n: int) -> None:
        """Note n steps of work. Errors: DrawingError where they come to more than the limit."""
        self._work += n
        if self._work > WORK_LIMIT:
            raise DrawingError(self._source, "its style sheets ask for too much work (save it as plain SVG)")

    def _cascaded(self, element: Element) -> Said:
        tag, attributes = element.tag, element.attributes
        winners = dict(_BY_BROWSER.get(tag, ()) if element.parent is not None else _OUTERMOST)
        known = _presentation_attributes(tag)
        for key in attributes.keys() & known.keys():
            if len(attributes[key]) > _LONG and known[key] not in ("d", "transform"):
                self.spend(len(attributes[key]))
            value = _presented(known[key], attributes[key])
            if value is not None:
                winners[known[key]] = Declared(value, "", ATTRIBUTE_LAYER, winners.get(known[key]))
        rules = sorted(self._matching(element), key=_strength) if self._buckets else []
        self.spend(_STEPS_OF_A_MATCH * len(rules))
        own: Sequence[Declaration] = ()
        if "style" in attributes:
            if not is_plain(attributes["style"]):
                self.spend(len(attributes["style"]))
            own = parse_style_attribute(attributes["style"])
        if not rules and not own:
            return Said(winners, {})
        for rule in rules:
            _add(winners, rule.declarations, rule.layer, is_important=False)
        _add(winners, own, STYLE_LAYER, is_important=False)
        rules.sort(key=_strength_of_important)
        for rule in rules:
            _add(winners, rule.declarations, rule.layer, is_important=True)
        _add(winners, own, STYLE_LAYER, is_important=True)
        if tag in _BY_ATTRIBUTE_ALONE and element.parent is not None:
            for name in winners.keys() & _BY_ATTRIBUTE_ALONE[tag]:
                _keep_attribute(winners, name)
        variables = {name: winners.pop(name) for name in [*winners] if name[:2] == "--"}
        return Said(winners, variables)

    def _matching(self, element: Element) -> Iterator[Rule]:
        """The rules of all selectors that match."""
        attributes = element.attributes
        keys = [("", ""), ("tag", element.tag)]
        if "id" in attributes:
            keys.append(("id", attributes["id"]))
        if "class" in attributes:
            keys.extend(("class", name) for name in set(attributes["class"].split()))
        for key in keys:
            bucket = self._buckets.get(key, ())
            self.spend(len(bucket))
            for matches, rule in bucket:
                with suppress(RecursionError):  # a selector that nests too deeply matches nothing
                    if matches(element):
                        yield rule


@lru_cache(256)
def _presentation_attributes(tag: str) -> dict[str, str]:
    """Attributes of an element that say what a property is, and which."""
    known = {name: name for name, row in ATTRIBUTES.items() if row.is_attribute_of(tag)}
    if tag in _TRANSFORM_ATTRIBUTES:
        del known["transform"]
        known[_TRANSFORM_ATTRIBUTES[tag]] = "transform"
    return known


def _presented(name: str, text: str) -> str | None:
    """What a presentation attribute says. One of geometry that is no length counts as zero, but a negative size as if
    it had not been there."""
    if name not in _GEOMETRY:
        return in_attribute(name, text) if name in ("d", "transform") else in_common_attribute(name, text)
    value = in_attribute(name, text)
    return "0" if value is None and not text.lstrip().startswith("-") else value


def _keep_attribute(winners: dict[str, Declared], name: str) -> None:
    entry: Declared | None = winners.pop(name)
    while entry is not None and entry.layer != ATTRIBUTE_LAYER:
        entry = entry.below
    if entry is not None:
        winners[name] = entry


def _add(winners: dict[str, Declared], given: Sequence[Declaration], layer: Layer, *, is_important: bool) -> None:
    for name, value, important, shorthand in given:
        if important is is_important:
            over = winners.get(name)
            if over is not None and over.layer == layer:  # `revert-layer` passes over the whole layer
                over = over.below
            winners[name] = Declared(value, shorthand, layer, over)


def _strength(rule: Rule) -> tuple[Layer, tuple[int, int, int], int]:
    return rule.layer, rule.selector.specificity, rule.order


def _strength_of_important(rule: Rule) -> tuple[Layer, tuple[int, int, int], int]:
    return tuple(-number for number in rule.layer), rule.selector.specificity, rule.order
