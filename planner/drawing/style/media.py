"""Media queries and `@supports`, as a browser on a screen of the size of the page answers them."""

from __future__ import annotations

import math
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
_REVERSED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "=": "="}
_BOUND = re.compile("(?:-webkit-)?(min-|max-).*")
_RESOLUTION = re.compile(r"([0-9.]+)(dppx|x|dpi|dpcm)", re.IGNORECASE)
_PER_DPPX = {"dppx": 1.0, "x": 1.0, "dpi": 1.0 / 96.0, "dpcm": 2.54 / 96.0}
Test = Callable[[Node], bool | None]


def matches(tokens: Sequence[Node], page: Size) -> bool:
    """Whether a list of media queries holds for a page of this size in px; an empty list does."""
    queries = by_comma(significant(tokens))
    if queries == [[]]:
        return True
    try:
        return any(_query(query, page) for query in queries)
    except RecursionError:
        return False


def matches_text(text: str, page: Size) -> bool:
    """The same for the `media` attribute of a style sheet."""
    return matches(tinycss2.parse_component_value_list(text), page)


def condition(tokens: Sequence[Node], test: Test) -> bool | None:
    """`not (a)`, `(a) and (b)`, `(a) or (b)`, with `test` for each of (a) and (b). None, neither true nor false, where
    that hangs on what is unknown."""
    parts = significant(tokens)
    if not parts:
        return None
    if is_word(parts[0], "not"):
        negated = _operand(parts[1], test) if len(parts) == 2 else None
        return None if negated is None else not negated
    found = [_operand(part, test) for part in parts[::2]]
    joints = parts[1::2]
    if len(joints) != len(found) - 1:
        return None
    if all(is_word(joint, "and") for joint in joints):
        return False if False in found else None if None in found else True
    if all(is_word(joint, "or") for joint in joints):
        return True if True in found else None if None in found else False
    return None


def _operand(token: Node, test: Test) -> bool | None:
    if token.type == "() block":
        inner = significant(token.content)
        if inner and (is_word(inner[0], "not") or inner[0].type in ("() block", "function")):
            return condition(inner, test)
    return test(token)


def _query(parts: list[Node], page: Size) -> bool:
    """`not print`, `screen and (min-width: 100px)`, `(a) or (b)`."""
    if not parts:
        return False
    is_typed = parts[0].type == "ident" and not (is_word(parts[0], "not") and not _is_ident(parts[1:2]))
    if not is_typed:
        return condition(parts, lambda token: _feature(token, page)) is True
    words = parts[1:] if parts[0].lower_value in ("not", "only") else parts
    if not _is_ident(words[:1]) or (len(words) > 1 and not is_word(words[1], "and")):
        return False
    holds: bool | None = words[0].lower_value in _TYPES
    if holds and len(words) > 1:
        holds = condition(words[2:], lambda token: _feature(token, page))
    return holds is not None and holds is not is_word(parts[0], "not")


def _is_ident(tokens: Sequence[Node]) -> bool:
    return bool(tokens) and tokens[0].type == "ident"


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


def _feature(token: Node, page: Size) -> bool | None:
    """`(min-width: 100px)`, `(width >= 100px)`, `(100px < width < 200px)`, `(color)`, `(hover: hover)`; None for a
    feature that nobody knows."""
    if token.type != "() block":
        return None
    text = text_of(token.content).lower()
    numbers = _numbers(page)
    name, colon, value = (part.strip() for part in text.partition(":"))
    if colon and name in _WORDS:
        orientation = "landscape" if page[0] > page[1] else "portrait"
        return value == (orientation if name == "orientation" else _WORDS[name])
    if colon:
        match = _BOUND.fullmatch(name)
        sign = ">=" if match and "min-" in name else "<=" if match else "="
        plain = name.replace(match[1], "", 1) if match else name
        return _range([plain, sign, value], numbers, page)
    parts = [part.strip() for part in re.split(r"(<=|>=|<|>|=)", text)]
    if len(parts) > 1:
        return _range(parts, numbers, page)
    if text in _WORDS:
        return _WORDS[text] not in _NOT_SAID
    return numbers[text] != 0.0 if text in numbers else None


def _range(parts: list[str], numbers: dict[str, float], page: Size) -> bool | None:
    """`width >= 100px` either way round, or `100px < width < 200px`, cut at their signs."""
    if len(parts) == 3 and parts[0] in numbers:
        parts = [parts[2], _REVERSED[parts[1]], parts[0]]
    if len(parts) not in (3, 5) or parts[2] not in numbers:
        return None
    bounds = [(parts[0], parts[1])] + ([(parts[4], _REVERSED[parts[3]])] if len(parts) == 5 else [])
    values = [_value(text, page) for text, _ in bounds]
    number = numbers[parts[2]]
    return all(
        value is not None and _holds(value, sign, number) for value, (_, sign) in zip(values, bounds, strict=True)
    )


def _holds(value: float, sign: str, number: float) -> bool:
    if math.isclose(value, number, rel_tol=1e-9):
        return "=" in sign
    return value < number if "<" in sign else value > number if ">" in sign else False


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
