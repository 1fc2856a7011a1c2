"""Whether an element matches a selector (Selectors 4).

cssselect2 parses; matching is done here, on the tree itself and from what is remembered of it, so that no selector
takes more than a few steps an element, whatever the depth of the tree and the number of siblings.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

import tinycss2.nth
from cssselect2 import parser
from cssselect2.parser import SelectorError
from tinycss2.ast import Node

from planner.drawing.xml_tree import SVG_NAMESPACE, Element

_LONGEST = 100
"""Elements that a selector may name one within another."""
Matches = Callable[[Element], bool]
_DYNAMIC = re.compile(
    "active|autofill|blank|buffering|checked|current|default|disabled|focus|focus-visible|focus-within|fullscreen|"
    "future|host|hover|in-range|indeterminate|invalid|local-link|modal|muted|optional|out-of-range|past|paused|"
    "picture-in-picture|placeholder-shown|playing|popover-open|read-only|read-write|required|seeking|stalled|target|"
    "target-within|user-invalid|user-valid|valid|visited|volume-locked|enabled"
)
"""What depends on a user or a form: never so in a drawing."""
_ENDS: dict[str, tuple[tuple[bool, ...], bool]] = {
    "first-child": ((False,), False),
    "last-child": ((True,), False),
    "only-child": ((False, True), False),
    "first-of-type": ((False,), True),
    "last-of-type": ((True,), True),
    "only-of-type": ((False, True), True),
}
"""Whether the place is counted from the end, and among elements of the same name."""
_KNOWN_PREFIXES = {
    "http://www.w3.org/1999/xlink": "xlink:",
    "http://www.w3.org/XML/1998/namespace": "xml:",
    "http://www.inkscape.org/namespaces/inkscape": "inkscape:",
    "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd": "sodipodi:",
    "http://www.serif.com/": "serif:",
    "": "",
}


@dataclass(frozen=True, eq=False, slots=True)
class Siblings:
    """The children of an element: where each stands among all, and among those of its type."""

    elements: list[Element]
    index: dict[Element, int]
    index_of_type: dict[Element, int]
    n_of_type: dict[str, int]


class Tree:
    """What is remembered of a document's elements while selectors are tried on them."""

    def __init__(self, root: Element) -> None:
        self._alone = _siblings([root])
        self._by_parent: dict[Element, Siblings] = {}

    def siblings(self, element: Element) -> Siblings:
        parent = element.parent
        if parent is None:
            return self._alone
        if parent not in self._by_parent:
            self._by_parent[parent] = _siblings(parent.children)
        return self._by_parent[parent]

    def previous(self, element: Element) -> Element | None:
        siblings = self.siblings(element)
        index = siblings.index[element]
        return siblings.elements[index - 1] if index else None


def _siblings(elements: list[Element]) -> Siblings:
    n_of_type: dict[str, int] = {}
    index_of_type = {}
    for element in elements:
        index_of_type[element] = n_of_type.get(element.tag, 0)
        n_of_type[element.tag] = index_of_type[element] + 1
    return Siblings(elements, {element: index for index, element in enumerate(elements)}, index_of_type, n_of_type)


def parsed(text: str, namespaces: Mapping[str | None, str]) -> list[parser.Selector]:
    """The selectors of a list. Errors: SelectorError where one of them is none that browsers understand: then the list
    as a whole is none."""
    try:
        selectors = list(parser.parse(text, namespaces))
        for selector in selectors:
            compiled(selector, _NO_TREE)
    except (AttributeError, RecursionError) as error:  # one that breaks off, or has no end
        raise SelectorError(text, str(error)) from None
    return selectors


def compiled(selector: parser.Selector, tree: Tree) -> Matches:
    """Errors: SelectorError for what no browser understands, and for very long ones."""
    node, n = selector.parsed_tree, 1
    while isinstance(node, parser.CombinedSelector):
        node, n = node.left, n + 1
    if n > _LONGEST:
        raise SelectorError("a selector that is too long")
    return _compiled(selector.parsed_tree, tree)


def subject(selector: parser.Selector) -> tuple[str, str]:
    """What an element must have to match at all: ("id", its id), ("class", a class), ("tag", its name), ("", "")."""
    node = selector.parsed_tree
    compound = node.right if isinstance(node, parser.CombinedSelector) else node
    found = {"id": "", "class": "", "tag": ""}
    for simple in compound.simple_selectors:
        if isinstance(simple, parser.IDSelector):
            found["id"] = simple.ident
        elif isinstance(simple, parser.ClassSelector):
            found["class"] = simple.class_name
        elif isinstance(simple, parser.LocalNameSelector):
            found["tag"] = simple.local_name
    return next(((kind, name) for kind, name in found.items() if name), ("", ""))


_NO_TREE = Tree(Element("svg", {}, 0))


def _compiled(node: object, tree: Tree) -> Matches:
    if isinstance(node, parser.CombinedSelector):
        return _combined(node, tree)
    if isinstance(node, parser.CompoundSelector):
        tests = [_simple(simple, tree) for simple in node.simple_selectors]
        if len(tests) == 1:
            return tests[0]
        return lambda element: all(test(element) for test in tests)
    raise SelectorError("unknown selector")


def _combined(node: parser.CombinedSelector, tree: Tree) -> Matches:
    left, right = _compiled(node.left, tree), _compiled(node.right, tree)
    combinator = node.combinator
    if combinator == ">":
        return lambda element: right(element) and element.parent is not None and left(element.parent)
    if combinator == "+":

        def next_to(element: Element) -> bool:
            if not right(element):
                return False
            previous = tree.previous(element)
            return previous is not None and left(previous)

        return next_to
    if combinator not in (" ", "~"):
        raise SelectorError("unknown combinator")
    step: Callable[[Element], Element | None] = (lambda element: element.parent) if combinator == " " else tree.previous
    known: dict[Element, bool] = {}

    def has_left(element: Element) -> bool:
        """Whether one of those before it matches, remembered for all of them."""
        passed = []
        other = step(element)
        result = False
        while other is not None:
            if other in known:
                result = known[other]
                break
            passed.append(other)
            other = step(other)
        for item in reversed(passed):
            result = result or left(item)
            known[item] = result
        return result

    return lambda element: right(element) and has_left(element)


def _simple(node: object, tree: Tree) -> Matches:
    if isinstance(node, parser.LocalNameSelector):
        tag = node.local_name
        return lambda element: element.tag == tag
    if isinstance(node, parser.NamespaceSelector):
        is_svg = node.namespace == SVG_NAMESPACE
        return lambda element: (element.tag != "") is is_svg
    if isinstance(node, parser.ClassSelector):
        name = node.class_name
        return lambda element: name in element.attributes.get("class", "").split()
    if isinstance(node, parser.IDSelector):
        ident = node.ident
        return lambda element: element.attributes.get("id") == ident
    if isinstance(node, parser.AttributeSelector):
        return _attribute(node)
    if isinstance(node, parser.PseudoClassSelector):
        return _pseudo_class(node.name, tree)
    if isinstance(node, parser.FunctionalPseudoClassSelector):
        return _function(node, tree)
    if isinstance(node, parser.RelationalSelector):
        return _has(node, tree)
    if isinstance(node, parser.NegationSelector):
        negated = [_compiled(selector.parsed_tree, tree) for selector in node.selector_list]
        return lambda element: not any(test(element) for test in negated)
    if isinstance(node, parser.MatchesAnySelector | parser.SpecificityAdjustmentSelector):
        tests = list(_understood(node.selector_list, tree))
        return lambda element: any(test(element) for test in tests)
    raise SelectorError("unknown selector")


def _understood(selectors: Iterable[parser.Selector], tree: Tree) -> Iterator[Matches]:
    """Those of `:is()`, which passes over what it does not understand."""
    for selector in selectors:
        with suppress(SelectorError):
            yield _compiled(selector.parsed_tree, tree)


def _attribute(node: parser.AttributeSelector) -> Matches:
    name, expected, sign = node.name, node.value, node.operator
    if node.namespace is None:
        keys = [prefix + name for prefix in _KNOWN_PREFIXES.values()]
    else:
        keys = [_KNOWN_PREFIXES[node.namespace] + name] if node.namespace in _KNOWN_PREFIXES and ":" not in name else []
    ignores_case = node.case_sensitive is False
    if ignores_case and expected is not None:
        expected = expected.lower()
    test = _comparison(sign, expected or "")

    def matches(element: Element) -> bool:
        for key in keys:
            value = element.attributes.get(key)
            if value is not None and test(value.lower() if ignores_case else value):
                return True
        return False

    return matches


def _comparison(sign: str | None, expected: str) -> Callable[[str], bool]:
    if sign is None:
        return lambda value: True
    if sign == "=":
        return lambda value: value == expected
    if sign == "~=":
        return lambda value: expected in value.split()
    if sign == "|=":
        return lambda value: value == expected or value.startswith(expected + "-")
    if not expected:
        return lambda value: False
    if sign == "^=":
        return lambda value: value.startswith(expected)
    if sign == "$=":
        return lambda value: value.endswith(expected)
    return lambda value: expected in value


def _pseudo_class(name: str, tree: Tree) -> Matches:
    if name in ("root", "scope"):
        return lambda element: element.parent is None
    if name in ("link", "any-link"):
        return lambda element: (
            element.tag == "a" and ("href" in element.attributes or "xlink:href" in element.attributes)
        )
    if name == "empty":
        return lambda element: not any(element.content)
    if _DYNAMIC.fullmatch(name):
        return lambda element: False
    if name == "defined":
        return lambda element: True
    if name not in _ENDS:
        raise SelectorError("unknown pseudo-class")
    sides, is_of_type = _ENDS[name]
    tests = [_nth(tree, (0, 1), is_from_end, is_of_type) for is_from_end in sides]
    return lambda element: all(test(element) for test in tests)


def _function(node: parser.FunctionalPseudoClassSelector, tree: Tree) -> Matches:
    if node.name == "lang":
        return _lang(node.arguments)
    kinds = {
        "nth-child": (False, False),
        "nth-last-child": (True, False),
        "nth-of-type": (False, True),
        "nth-last-of-type": (True, True),
    }
    if node.name not in kinds:
        raise SelectorError("unknown pseudo-class")
    is_from_end, is_of_type = kinds[node.name]
    words = [index for index, token in enumerate(node.arguments) if token.type == "ident" and token.value == "of"]
    of = node.arguments[words[0] + 1 :] if words else []
    step = tinycss2.nth.parse_nth(node.arguments[: words[0]] if words else node.arguments)
    if step is None or (words and is_of_type):
        raise SelectorError("not a step")
    if of:
        return _nth_of(tree, step, is_from_end, list(parser.parse(of)))
    return _nth(tree, step, is_from_end, is_of_type)


def _nth(tree: Tree, step: tuple[int, int], is_from_end: bool, is_of_type: bool) -> Matches:
    def matches(element: Element) -> bool:
        siblings = tree.siblings(element)
        index = (siblings.index_of_type if is_of_type else siblings.index)[element]
        if is_from_end:
            n = siblings.n_of_type[element.tag] if is_of_type else len(siblings.elements)
            index = n - 1 - index
        return _is_step(index + 1, *step)

    return matches


def _nth_of(tree: Tree, step: tuple[int, int], is_from_end: bool, selectors: Sequence[parser.Selector]) -> Matches:
    tests = [_compiled(selector.parsed_tree, tree) for selector in selectors]
    positions: dict[int, dict[Element, int]] = {}

    def matches(element: Element) -> bool:
        siblings = tree.siblings(element)
        found = positions.get(id(siblings))
        if found is None:
            order = reversed(siblings.elements) if is_from_end else siblings.elements
            chosen = [other for other in order if any(test(other) for test in tests)]
            found = positions[id(siblings)] = {other: index + 1 for index, other in enumerate(chosen)}
        return element in found and _is_step(found[element], *step)

    return matches


def _is_step(position: int, a: int, b: int) -> bool:
    """Whether a position from 1 is a n + b for some n from 0."""
    if a == 0:
        return position == b
    n, rest = divmod(position - b, a)
    return rest == 0 and n >= 0


def _lang(arguments: Sequence[Node]) -> Matches:
    languages = [str(token.value).lower() for token in arguments if token.type in ("ident", "string")]

    def matches(element: Element) -> bool:
        place: Element | None = element
        while place is not None:
            language = place.attributes.get("xml:lang", place.attributes.get("lang"))
            if language is not None:
                language = language.lower()
                return any(language == known or language.startswith(known + "-") for known in languages)
            place = place.parent
        return False

    return matches


def _has(node: parser.RelationalSelector, tree: Tree) -> Matches:
    """`:has(> a)`: remembered for each element, in one pass over the tree from its end."""
    tests = [_has_one(item.combinator, _compiled(item.selector.parsed_tree, tree), tree) for item in node.selector_list]
    return lambda element: any(test(element) for test in tests)


def _has_one(combinator: str, inner: Matches, tree: Tree) -> Matches:
    known: dict[Element, bool] = {}

    def within(element: Element) -> bool:
        """Whether a descendant matches."""
        if element not in known:
            for other in reversed(list(element.descendants())):
                if other not in known:
                    known[other] = any(inner(child) or known[child] for child in other.children)
        return known[element]

    def later(element: Element) -> bool:
        """Whether a sibling after it matches."""
        if element not in known:
            result = False
            for other in reversed(tree.siblings(element).elements):
                known[other] = result
                result = result or inner(other)
        return known[element]

    def following(element: Element) -> bool:
        siblings = tree.siblings(element)
        index = siblings.index[element] + 1
        return index < len(siblings.elements) and inner(siblings.elements[index])

    if combinator == " ":
        return within
    if combinator == "+":
        return following
    if combinator == ">":
        return lambda element: any(inner(child) for child in element.children)
    return later
