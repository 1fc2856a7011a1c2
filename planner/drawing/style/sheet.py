"""Style sheets: the rules in the `style` elements of a document."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import tinycss2
from cssselect2 import parser
from tinycss2.ast import Node

from planner.drawing.style import media
from planner.drawing.style.declarations import Declaration, declarations, declared
from planner.drawing.style.properties import PROPERTIES
from planner.drawing.style.selectors import parsed
from planner.drawing.style.tokens import by_comma, significant, text_of
from planner.drawing.xml_tree import Document
from planner.errors import DrawingError

_TEXT_LIMIT = 4 << 20
"""Characters of all style sheets together, embedded fonts and pictures aside."""
_DATA_URL = re.compile(r"""url\(\s*(["']?)data:[^"')]*+\1\s*\)""", re.IGNORECASE)
_DEPTH_LIMIT = 30
_SELECTOR_LIMIT = 10_000
"""Characters of a selector: nested rules that repeat their parents would take all memory."""
_NOT_DRAWN = {"import": "external reference", "font-face": "embedded font", "scope": "@scope rules"}
"""At-rules that are not followed, and what they are counted as."""
Layer = tuple[float, ...]
UNLAYERED: Layer = (math.inf,)


@dataclass(frozen=True, eq=False, slots=True)
class Rule:
    """layer: orders it before rules of a larger one. conditions: media queries, all of which must hold."""

    selector: parser.Selector
    declarations: tuple[Declaration, ...]
    order: int
    layer: Layer
    conditions: tuple[Sequence[Node], ...]


@dataclass(frozen=True, slots=True)
class _Context:
    """What a rule stands in."""

    conditions: tuple[Sequence[Node], ...] = ()
    layer: tuple[str, ...] = ()
    parent: str = ""
    depth: int = 0


@dataclass(slots=True)
class Sheets:
    """Rules in the order of the document. skipped: what sheets ask for that is not followed, by kind."""

    rules: list[Rule] = field(default_factory=list)
    skipped: Counter[str] = field(default_factory=Counter)
    _namespaces: dict[str | None, str] = field(default_factory=dict)
    _layers: dict[tuple[str, ...], int] = field(default_factory=dict)

    def read(self, document: Document) -> None:
        """All `style` elements of a document. Errors: DrawingError where they are too long."""
        n_characters = 0
        for element in document.root.descendants():
            if element.tag != "style" or not element.content:
                continue
            text = _DATA_URL.sub("url()", element.text)
            n_characters += len(text)
            if n_characters > _TEXT_LIMIT:
                raise DrawingError(
                    document.source, f"its style sheets are longer than {_TEXT_LIMIT} characters (save it as plain SVG)"
                )
            if element.attributes.get("type", "").strip().lower() not in ("", "text/css"):
                continue
            query = element.attributes.get("media", "")
            conditions = (tinycss2.parse_component_value_list(query),) if query.strip() else ()
            self._namespaces = {}
            try:
                self._read(tinycss2.parse_stylesheet(text), _Context(conditions))
            except RecursionError:
                self.skipped["style sheet that nests too deeply"] += 1

    def _read(self, nodes: Iterable[Node], context: _Context) -> None:
        for node in nodes:
            if node.type == "qualified-rule":
                self._rule(node, context)
            elif node.type == "at-rule":
                self._at_rule(node, context)

    def _rule(self, node: Node, context: _Context) -> None:
        prelude = text_of(node.prelude)
        if context.parent:
            prelude = _nested(prelude, context.parent)
        if len(prelude) > _SELECTOR_LIMIT or context.depth > _DEPTH_LIMIT:
            self.skipped["style rule that is too long"] += 1
            return
        self._block(prelude, tinycss2.parse_blocks_contents(node.content), context)

    def _block(self, prelude: str, content: list[Node], context: _Context) -> None:
        """The content of a style rule: its declarations, and rules nested in it."""
        found = tuple(declarations(content))
        if found:
            try:
                selectors = parsed(prelude, self._namespaces)
            except parser.SelectorError:
                return
            layer = self._layer_key(context.layer)
            for selector in selectors:
                if selector.pseudo_element is None:
                    self.rules.append(Rule(selector, found, len(self.rules), layer, context.conditions))
        self._read(content, replace(context, parent=prelude, depth=context.depth + 1))

    def _at_rule(self, node: Node, context: _Context) -> None:
        name = node.lower_at_keyword
        if name in _NOT_DRAWN:
            self.skipped[_NOT_DRAWN[name]] += 1
        elif name == "namespace":
            self._namespace(node.prelude)
        elif name == "layer":
            self._enter_layers(node, context)
        elif node.content is None or context.depth > _DEPTH_LIMIT:
            return
        elif name == "media":
            self._inside(node, replace(context, conditions=(*context.conditions, node.prelude)))
        elif name == "supports" and media.condition(node.prelude, _is_supported):
            self._inside(node, context)

    def _inside(self, node: Node, context: _Context) -> None:
        context = replace(context, depth=context.depth + 1)
        if context.parent:
            self._block(context.parent, tinycss2.parse_blocks_contents(node.content), replace(context, parent=""))
        else:
            self._read(tinycss2.parse_rule_list(node.content), context)

    def _namespace(self, prelude: Sequence[Node]) -> None:
        tokens = significant(prelude)
        if not tokens or len(tokens) > 2:
            return
        url = tokens[-1].arguments[0] if tokens[-1].type == "function" and tokens[-1].arguments else tokens[-1]
        if url.type in ("url", "string"):
            self._namespaces[tokens[0].value if len(tokens) == 2 and tokens[0].type == "ident" else None] = url.value

    def _enter_layers(self, node: Node, context: _Context) -> None:
        names = [name.strip() for name in tinycss2.serialize(node.prelude).split(",")]
        paths = [(*context.layer, *(part.strip() for part in name.split("."))) for name in names if name]
        if not paths:
            paths = [(*context.layer, f"anonymous {len(self._layers)}")]
        for path in paths:
            self._layer_key(path)
        if node.content is not None and len(paths) == 1:
            self._inside(node, replace(context, layer=paths[0]))

    def _layer_key(self, path: tuple[str, ...]) -> Layer:
        """Layers by their first appearance, each before what stands in the one around it without a layer."""
        keys = [float(self._layers.setdefault(path[: depth + 1], len(self._layers))) for depth in range(len(path))]
        return (*keys, math.inf)


def _nested(prelude: str, parent: str) -> str:
    """The selector of a rule nested in another (CSS Nesting 1)."""
    whole = f":is({parent})"
    texts = [text_of(group) for group in by_comma(tinycss2.parse_component_value_list(prelude))]
    return ", ".join(text.replace("&", whole) if "&" in text else f"{whole} {text}" for text in texts)


def _is_supported(token: Node) -> bool | None:
    """Whether `(property: value)` or `selector(...)` of `@supports` is understood here."""
    if token.type == "function" and token.lower_name == "selector":
        try:
            return bool(parsed(text_of(token.arguments), {}))
        except parser.SelectorError:
            return False
    if token.type != "() block":
        return False
    found = [node for node in tinycss2.parse_blocks_contents(token.content) if node.type == "declaration"]
    return any(_is_without_bearing(node.lower_name) or declared(node.name, text_of(node.value)) for node in found)


def _is_without_bearing(name: str) -> bool:
    return name in PROPERTIES and PROPERTIES[name].bearing == "none"
