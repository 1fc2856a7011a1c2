"""Media queries and `@supports`, as a browser on a screen of the size of the page answers them."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Sequence

import tinycss2
from tinycss2.ast import Node

from planner.drawing.style.tokens import by_comma, is_word, significant, text_of
from planner.drawing.style.units import units_of_page

Size = tuple[float, float]
_TYPES = frozenset({"all", "screen"})
_WORDS = {
    "orientation": None,
    "prefers-color-scheme": "light",
    "prefers-reduced-motion": "no-preference",
    "prefers-reduced-data": "no-preference",
    "prefers-reduced-transparency": "no-preference",
    "prefers-contrast": "no-preference",
    "forced-colors": "none",
    "inverted-colors": "none",
    "hover": "hover",
    "any-hover": "hover",
    "pointer": "fine",
    "any-pointer": "fine",
    "scripting": "enabled",
    "update": "fast",
    "display-mode": "browser",
    "overflow-block": "scroll",
    "overflow-inline": "scroll",
    "color-gamut": "srgb",
    "dynamic-range": "standard",
    "scan": "progressive",
}
"""Features that are words, and which of them holds: that of a desktop computer."""
_NOT_SAID = frozenset({"none", "no-preference", None})
_COMPARISONS: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "=": operator.eq,
}
_REVERSED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "=": "="}
_RESOLUTION = re.compile(r"([0-9.]+)(dppx|x|dpi|dpcm)", re.IGNORECASE)
_PER_DPPX = {"dppx": 1.0, "x": 1.0, "dpi": 1.0 / 96.0, "dpcm": 2.54 / 96.0}
Test = Callable[[Node], bool]


def matches(tokens: Sequence[Node], page: Size) -> bool:
    """Whether a list of media queries holds for a page of this size in px; an empty list does."""
    queries = by_comma(significant(tokens))
    if queries == [[]]:
        return True
    return any(_query(query, page) for query in queries)


def matches_text(text: str, page: Size) -> bool:
    """The same for the `media` attribute of a style sheet."""
    return matches(tinycss2.parse_component_value_list(text), page)


def condition(tokens: Sequence[Node], test: Test) -> bool:
    """`not (a)`, `(a) and (b)`, `(a) or (b)`, with `test` for each of (a) and (b)."""
    parts = significant(tokens)
    if not parts:
        return False
    if is_word(parts[0], "not"):
        return len(parts) == 2 and not _operand(parts[1], test)
    result = _operand(parts[0], test)
    for joint, part in zip(parts[1::2], parts[2::2], strict=False):
        if is_word(joint, "and"):
            result = _operand(part, test) and result
        elif is_word(joint, "or"):
            result = _operand(part, test) or result
        else:
            return False
    return result


def _operand(token: Node, test: Test) -> bool:
    if token.type == "() block":
        inner = significant(token.content)
        if inner and (is_word(inner[0], "not") or inner[0].type == "() block" or inner[0].type == "function"):
            return condition(inner, test)
    return test(token)


def _query(parts: list[Node], page: Size) -> bool:
    """`not print`, `screen and (min-width: 100px)`, `(a) or (b)`."""
    if not parts:
        return False
    if parts[0].type == "ident" and (parts[0].lower_value != "not" or (parts[1:2] and parts[1].type == "ident")):
        is_not = parts[0].lower_value == "not"
        words = parts[1:] if parts[0].lower_value in ("not", "only") else parts
        if not words or words[0].type != "ident" or (len(words) > 1 and not is_word(words[1], "and")):
            return False
        holds = words[0].lower_value in _TYPES
        if len(words) > 1:
            holds = condition(words[2:], lambda token: _feature(token, page)) and holds
        return holds is not is_not
    if any(_is_unknown(part) for part in parts):
        return False
    return condition(parts, lambda token: _feature(token, page))


def _is_unknown(token: Node) -> bool:
    """Whether it names a feature that nobody knows: then its negation does not hold either."""
    if token.type != "() block":
        return False
    inner = significant(token.content)
    if len(inner) != 1 or inner[0].type != "ident":
        return False
    name = inner[0].lower_value
    return name not in _WORDS and name not in _numbers((1.0, 1.0)) and name not in ("grid", "monochrome")


def _numbers(page: Size) -> dict[str, float]:
    width, height = page
    ratio = width / height if height else 0.0
    return {
        "width": width,
        "height": height,
        "device-width": width,
        "device-height": height,
        "aspect-ratio": ratio,
        "device-aspect-ratio": ratio,
        "resolution": 1.0,
        "-webkit-device-pixel-ratio": 1.0,
        "color": 8.0,
        "color-index": 0.0,
        "monochrome": 0.0,
        "grid": 0.0,
    }


def _feature(token: Node, page: Size) -> bool:
    """`(min-width: 100px)`, `(width >= 100px)`, `(100px < width < 200px)`, `(color)`, `(hover: hover)`."""
    if token.type != "() block":
        return False
    text = text_of(token.content).lower()
    numbers = _numbers(page)
    name, colon, value = (part.strip() for part in text.partition(":"))
    if colon:
        if name in _WORDS:
            holds = "landscape" if page[0] > page[1] else "portrait"
            return value == (holds if name == "orientation" else _WORDS[name])
        bound, plain = name[:4], name.replace("min-", "", 1).replace("max-", "", 1)
        number = _value(value, page)
        if plain not in numbers or number is None:
            return False
        compare = (
            operator.ge if "min-" in (bound, name[8:12]) else operator.le if "max-" in (bound, name[8:12]) else None
        )
        return compare(numbers[plain], number) if compare else abs(numbers[plain] - number) < 1e-9
    parts = [part.strip() for part in re.split(r"(<=|>=|<|>|=)", text)]
    if len(parts) == 1:
        return numbers.get(text, 0.0) != 0.0 or (text in _WORDS and _WORDS[text] not in _NOT_SAID)
    return _range(parts, numbers, page)


def _range(parts: list[str], numbers: dict[str, float], page: Size) -> bool:
    if len(parts) == 3 and parts[0] in numbers:
        parts = [parts[2], _REVERSED[parts[1]], parts[0]]
    name = parts[2]
    bounds = [(parts[0], parts[1])] + ([(parts[4], _REVERSED[parts[3]])] if len(parts) == 5 else [])
    if name not in numbers or len(parts) not in (3, 5):
        return False
    found = [(_value(text, page), sign) for text, sign in bounds]
    return all(value is not None and _COMPARISONS[sign](value, numbers[name]) for value, sign in found)


def _value(text: str, page: Size) -> float | None:
    """A length in px, a ratio, a resolution in dppx, or a plain number."""
    top, slash, bottom = (part.strip() for part in text.partition("/"))
    if slash:
        over, under = _value(top, page), _value(bottom, page)
        return over / under if over is not None and under else None
    match = _RESOLUTION.fullmatch(text)
    if match:
        return float(match[1]) * _PER_DPPX[match[2].lower()]
    return units_of_page(page).length(text, "x")
