"""The cascade: which declarations of an element win (CSS Cascading 5, section 6).

From the weakest to the strongest: the browser's own sheet, presentation attributes, rules by layer, specificity and
order, the style attribute; then what is `!important`, with layers the other way round.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from planner.drawing.style import media
from planner.drawing.style.declarations import Declaration, in_attribute, parse_style_attribute
from planner.drawing.style.properties import ATTRIBUTES
from planner.drawing.style.selectors import Matches, SelectorError, Tree, compiled, subject
from planner.drawing.style.sheet import UNLAYERED, Layer, Rule
from planner.drawing.xml_tree import Element


class Declared(NamedTuple):
    """A declaration that applies to an element, and the one that it wins over, if any. layer: None for what is no
    author's rule: the browser's own."""

    value: str
    shorthand: str
    layer: Layer | None
    below: Declared | None


_HIDDEN = {"overflow": Declared("hidden", "", None, None)}
_BY_BROWSER: dict[str, dict[str, Declared]] = {
    **dict.fromkeys(("svg", "symbol", "image", "marker", "pattern", "foreignObject"), _HIDDEN)
}
"""The browser's own sheet, where it bears on drawings."""
_OUTERMOST = {"transform-origin": Declared("50% 50%", "", None, None)}
_TRANSFORMS = {"gradientTransform": "transform", "patternTransform": "transform"}
_TRANSFORMED = frozenset({"linearGradient", "radialGradient", "pattern"})
# An attribute of geometry that is no length counts as zero, not as if it had not been there.
_NOUGHT_WHERE_INVALID = frozenset({"x", "y", "width", "height", "cx", "cy", "r", "rx", "ry"})
ATTRIBUTE_LAYER: Layer = (-1.0,)
_STYLE_LAYER: Layer = (*UNLAYERED, 1.0)


class Cascade:
    """The rules that are in force on a page of one size."""

    def __init__(self, root: Element, rules: Sequence[Rule], page: tuple[float, float]) -> None:
        self._buckets: dict[tuple[str, str], list[tuple[Matches, Rule]]] = {}
        tree = Tree(root)
        for rule in rules:
            if all(media.matches(query, page) for query in rule.conditions):
                try:
                    entry = compiled(rule.selector, tree), rule
                except SelectorError:
                    continue
                self._buckets.setdefault(subject(rule.selector), []).append(entry)
        self._known: dict[Element, dict[str, Declared]] = {}

    def declared(self, element: Element) -> dict[str, Declared]:
        """The winner for each property that is said of an element."""
        found = self._known.get(element)
        if found is None:
            found = self._known[element] = self._cascaded(element)
        return found

    def _cascaded(self, element: Element) -> dict[str, Declared]:
        tag, attributes = element.tag, element.attributes
        winners = dict((_BY_BROWSER if element.parent is not None else {"svg": _OUTERMOST}).get(tag, ()))
        for key, text in attributes.items():
            name = _TRANSFORMS.get(key, key) if tag in _TRANSFORMED else key
            row = ATTRIBUTES.get(name)
            if row is None or not row.is_attribute_of(tag) or (tag in _TRANSFORMED and key == "transform"):
                continue
            said = in_attribute(name, text)
            if said is not None:
                winners[name] = Declared(said.value, said.shorthand, ATTRIBUTE_LAYER, winners.get(name))
            elif name in _NOUGHT_WHERE_INVALID:
                winners[name] = Declared("0", "", ATTRIBUTE_LAYER, winners.get(name))
        rules = sorted(self._matching(element), key=_strength) if self._buckets else []
        own = parse_style_attribute(attributes["style"]) if "style" in attributes else ()
        for rule in rules:
            _add(winners, rule.declarations, rule.layer, is_important=False)
        _add(winners, own, _STYLE_LAYER, is_important=False)
        rules.sort(key=_strength_of_important)
        for rule in rules:
            _add(winners, rule.declarations, rule.layer, is_important=True)
        _add(winners, own, _STYLE_LAYER, is_important=True)
        return winners

    def _matching(self, element: Element) -> Iterator[Rule]:
        """The rules of all selectors that match."""
        attributes = element.attributes
        keys = [("", ""), ("tag", element.tag)]
        if "id" in attributes:
            keys.append(("id", attributes["id"]))
        if "class" in attributes:
            keys.extend(("class", name) for name in set(attributes["class"].split()))
        for key in keys:
            for matches, rule in self._buckets.get(key, ()):
                if matches(element):
                    yield rule


def _add(winners: dict[str, Declared], given: Sequence[Declaration], layer: Layer, *, is_important: bool) -> None:
    for name, value, important, shorthand in given:
        if important is is_important:
            winners[name] = Declared(value, shorthand, layer, winners.get(name))


def _strength(rule: Rule) -> tuple[Layer, tuple[int, int, int], int]:
    return rule.layer, rule.selector.specificity, rule.order


def _strength_of_important(rule: Rule) -> tuple[Layer, tuple[int, int, int], int]:
    return tuple(-number for number in rule.layer), rule.selector.specificity, rule.order
