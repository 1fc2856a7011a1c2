"""Shorthand properties that say several things at once."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

import tinycss2

from planner.drawing.style.properties import INITIAL, PROPERTIES
from planner.drawing.style.tokens import significant, text_of

_FONT = ("font-style", "font-variant", "font-weight", "font-stretch", "font-size", "line-height", "font-family")
_MARKERS = ("marker-start", "marker-mid", "marker-end")
_STRETCHES = re.compile("(?:ultra-|extra-|semi-)?(?:condensed|expanded)")
_SYSTEM_FONTS = frozenset({"caption", "icon", "menu", "message-box", "small-caption", "status-bar"})
_ALL = tuple(
    name for name, row in PROPERTIES.items() if row.bearing != "none" and name not in ("direction", "unicode-bidi")
)
Longhands = Mapping[str, str]


def _font(text: str) -> Longhands:
    """`[style || variant || weight || stretch]? size[/line-height]? family`; nothing where it is not that."""
    values = {name: INITIAL[name] for name in _FONT}
    if text.lower() in _SYSTEM_FONTS:
        return {**values, "font-size": "13.3333px", "font-family": "sans-serif"}
    tokens = [token for token in tinycss2.parse_component_value_list(text) if token.type != "comment"]
    words: list[str] = []
    for index, token in enumerate(tokens):
        if token.type == "whitespace":
            continue
        word = tinycss2.serialize([token])
        if token.type in ("dimension", "percentage", "function") or _is_size(word):
            return _with_size(values, words, tinycss2.serialize(tokens[index:]))
        words.append(word.lower())
    return {}


def _is_size(word: str) -> bool:
    return not word[:1].isdigit() and PROPERTIES["font-size"].grammar(word, False) is not None


def _with_size(values: dict[str, str], words: list[str], rest: str) -> Longhands:
    for word in words:
        if word in ("italic", "oblique"):
            values["font-style"] = word
        elif word == "small-caps":
            values["font-variant"] = word
        elif _STRETCHES.fullmatch(word):
            values["font-stretch"] = word
        elif word != "normal" and PROPERTIES["font-weight"].grammar(word, False):
            values["font-weight"] = word
        elif word != "normal":
            return {}
    size, family = _cut_after_size(rest)
    size, slash, line_height = (part.strip() for part in size.partition("/"))
    values["font-size"], values["font-family"] = size, family
    if slash:
        values["line-height"] = line_height
    checked = ("font-size", "line-height")
    is_valid = family and all(PROPERTIES[name].grammar(values[name], False) for name in checked)
    return values if is_valid else {}


def _cut_after_size(rest: str) -> tuple[str, str]:
    """`20px / 1.5` and `"A B", serif`: the family begins after the first value that no slash joins to the next."""
    tokens = tinycss2.parse_component_value_list(rest)
    places = [index for index, token in enumerate(tokens) if token.type not in ("whitespace", "comment")]
    n_size = 3 if len(places) > 2 and tokens[places[1]] == "/" else 1
    end = places[n_size - 1] + 1
    return text_of(significant(tokens[:end])).replace("/**/", ""), text_of(tokens[end:])


def _marker(text: str) -> Longhands:
    value = PROPERTIES["marker-start"].grammar(text, False)
    return dict.fromkeys(_MARKERS, value) if value else {}


def _all(_: str) -> Longhands:
    return {}  # takes nothing but the keywords of every property


def expanded(name: str, text: str) -> Longhands:
    """What the longhands of a shorthand come to: none where its value is invalid."""
    try:
        return SHORTHANDS[name][1](text)
    except RecursionError:
        return {}


SHORTHANDS: dict[str, tuple[tuple[str, ...], Callable[[str], Longhands]]] = {
    "font": (_FONT, _font),
    "marker": (_MARKERS, _marker),
    "all": (_ALL, _all),
}
"""What each stands for, and how its value is written out: no values where it is invalid."""
