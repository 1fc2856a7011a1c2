"""Declarations, `stroke-width: 2px`, from style attributes, style sheets and presentation attributes.

Shorthands are written out, values that are none are dropped, and so is what bears on nothing that is drawn.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

import tinycss2
from tinycss2.ast import Node

from planner.drawing.style.properties import ALIASES, PROPERTIES
from planner.drawing.style.shorthands import SHORTHANDS, expanded
from planner.drawing.style.tokens import text_of

WIDE_KEYWORDS = frozenset({"inherit", "initial", "unset", "revert", "revert-layer"})
_LONGEST_KEYWORD = max(map(len, WIDE_KEYWORDS))
UNITLESS_IN_STYLE = frozenset({"font-size", "letter-spacing", "word-spacing", "width", "height"})
"""What takes plain numbers in style attributes, which browsers read with the quirks of old pages, but not in sheets."""
# What is plain enough to be cut at its semicolons and colons; the rest goes to the parser of CSS.
_STRING = r"""(?:'[^'\\;\n]*'|"[^"\\;\n]*")"""
_PLAIN = re.compile(
    rf"""(?:[^'"\\{{}}\[\]!@/()]|/(?!\*)|{_STRING}|\((?:[^'"\\{{}}\[\]!@/();]|/(?!\*)|{_STRING})*\))*+"""
)
_COMMENT = re.compile(r"/\*.*?(?:\*/|\Z)", re.DOTALL)
_SUBSTITUTED = re.compile(r"\b(?:var|env|attr)\(", re.IGNORECASE)


class Declaration(NamedTuple):
    """value: the text to keep of a valid value, a keyword such as `inherit`, or text with `var()` yet to be
    substituted. shorthand: what to expand then, "" for the property itself."""

    name: str
    value: str
    is_important: bool = False
    shorthand: str = ""


@lru_cache(4096)
def parse_style_attribute(text: str) -> Sequence[Declaration]:
    """The declarations of a `style` attribute in their order."""
    if not is_plain(text):
        return declarations(tinycss2.parse_blocks_contents(text), is_sheet=False)
    found: list[Declaration] = []
    for part in text.split(";"):
        name, colon, value = part.partition(":")
        if colon:
            found.extend(declared(name.strip(), value.strip(), is_sheet=False))
    return found


def is_plain(text: str) -> bool:
    """Whether a style attribute can be cut at its semicolons and colons, which is fast."""
    return _PLAIN.fullmatch(text) is not None


def declarations(content: Iterable[Node], *, is_sheet: bool = True) -> list[Declaration]:
    """Those among the nodes of a block, in their order."""
    found: list[Declaration] = []
    for node in content:
        if node.type == "declaration":
            found.extend(declared(node.name, text_of(node.value), bool(node.important), is_sheet))
    return found


def has_substitution(value: str) -> bool:
    return _SUBSTITUTED.search(value) is not None


@lru_cache(16384)
def declared(name: str, text: str, is_important: bool = False, is_sheet: bool = True) -> tuple[Declaration, ...]:
    """What one declaration in CSS comes to: none where it is invalid or without bearing, several for a shorthand."""
    if name.startswith("--"):
        return (Declaration(name, text, is_important),)
    name = name.lower()
    name = ALIASES.get(name, name)
    if name in SHORTHANDS:
        return tuple(_expanded(name, text, is_important))
    if has_substitution(text) and name in PROPERTIES:
        return (Declaration(name, text, is_important),)
    value = valid(name, text, is_attribute=not is_sheet and name in UNITLESS_IN_STYLE)
    return () if value is None else (Declaration(name, value, is_important),)


def _expanded(name: str, text: str, is_important: bool) -> Iterable[Declaration]:
    longhands = SHORTHANDS[name][0]
    if text.lower() in WIDE_KEYWORDS:
        values: Mapping[str, str] = dict.fromkeys(longhands, text.lower())
    elif has_substitution(text):
        return [Declaration(longhand, text, is_important, name) for longhand in longhands]
    else:
        values = expanded(name, text)
    return [Declaration(longhand, value, is_important) for longhand, value in values.items()]


def valid(name: str, text: str, is_attribute: bool = False) -> str | None:
    """The text to keep of a value, None where it is invalid or bears on nothing."""
    row = PROPERTIES.get(name)
    if row is None or row.bearing == "none":
        return None
    if len(text) <= _LONGEST_KEYWORD and text.lower() in WIDE_KEYWORDS:
        return text.lower()
    try:
        return row.grammar(text, is_attribute)
    except RecursionError:  # functions within functions without end
        return None


def in_attribute(name: str, text: str) -> str | None:
    """What a presentation attribute declares; None where that is invalid."""
    text = text.strip()
    if name == "d":
        return text
    if "/*" in text:
        text = _COMMENT.sub(" ", text).strip()
    if "(" in text and has_substitution(text):
        return text
    return valid(name, text, is_attribute=True)


in_common_attribute = lru_cache(16384)(in_attribute)
"""The same for properties whose values repeat."""
