"""What values a property accepts.

A grammar takes the text of a value, without comments and blanks around it, and whether it stands in a presentation
attribute, where lengths need no unit. It gives the text to keep, or None for what is no value of the property: that
counts as if it had not been said.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence

import tinycss2
from tinycss2.ast import Node

from planner.drawing.style.colour import parse_colour, parse_paint, parse_url
from planner.drawing.style.tokens import by_comma, component_values, is_comma, significant, text_of
from planner.drawing.style.units import PLAIN_LENGTH, is_length_unit, kind_of

Grammar = Callable[[str, bool], str | None]
_ATTRIBUTE_NUMBER = r"[+-]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][+-]?\d+)?"
_SEPARATOR = r"(?:\s*+,\s*+|\s++|(?=[+\-.]))"  # possessive: a long run of blanks is tried once


def _transform_call(names: str, counts: Sequence[int]) -> str:
    numbers = "|".join(rf"{_ATTRIBUTE_NUMBER}(?:{_SEPARATOR}{_ATTRIBUTE_NUMBER}){{{count - 1}}}" for count in counts)
    return rf"(?:{names})\s*+\(\s*+(?:{numbers})\s*+\)"


_CALL = (
    "(?:"
    + "|".join(
        [
            _transform_call("matrix", (6,)),
            _transform_call("translate|scale", (2, 1)),
            _transform_call("rotate", (3, 1)),
            _transform_call("skewX|skewY", (1,)),
        ]
    )
    + ")"
)
_TRANSFORM_ATTRIBUTE = rf"{_CALL}(?:\s*+,?\s*+{_CALL})*+"
"""Compiled where it is first asked for: it takes as long as everything else here."""
_ANGLE_ARGUMENTS = {"rotate": 1, "skewx": 1, "skewy": 1, "rotatex": 1, "rotatey": 1, "rotatez": 1}
_LENGTH_ARGUMENTS = {
    "translatex": (1,),
    "translatey": (1,),
    "translatez": (1,),
    "translate": (1, 2),
    "translate3d": (3,),
}
_NUMBER_ARGUMENTS = {
    "scalex": (1,),
    "scaley": (1,),
    "scalez": (1,),
    "scale": (1, 2),
    "scale3d": (3,),
    "matrix": (6,),
    "matrix3d": (16,),
}
_PATH_DATA = re.compile(r"\s*[Mm][MmZzLlHhVvCcSsQqTtAaeE0-9+\-.,\s]*")
_SHAPES = frozenset({"circle", "ellipse", "inset", "polygon", "path", "rect", "xywh", "shape"})
_BOXES = frozenset({"border-box", "padding-box", "content-box", "margin-box", "fill-box", "stroke-box", "view-box"})


def anything(text: str, _: bool) -> str | None:
    return text or None


def words(allowed: str) -> Grammar:
    """One of these keywords."""
    known = frozenset(allowed.split())

    def grammar(text: str, _: bool) -> str | None:
        lower = text.lower()
        return lower if lower in known else None

    return grammar


def several(allowed: str) -> Grammar:
    """One or more of these keywords."""
    known = frozenset(allowed.split())

    def grammar(text: str, _: bool) -> str | None:
        found = text.lower().split()
        return " ".join(found) if found and known.issuperset(found) else None

    return grammar


def length(
    keywords: str = "", *, is_unitless: bool = False, has_percentage: bool = True, is_signed: bool = True
) -> Grammar:
    """A length, a percentage, an expression or one of the keywords. is_unitless: plain numbers in CSS too."""
    known = frozenset(keywords.split())

    def grammar(text: str, is_attribute: bool) -> str | None:
        match = PLAIN_LENGTH.fullmatch(text)
        if match:
            unit = match[2].lower()
            if unit == "%":
                is_valid = has_percentage
            elif unit:
                is_valid = is_length_unit(unit)
            else:
                is_valid = is_attribute or is_unitless or float(text) == 0.0
            return text if is_valid and (is_signed or float(match[1]) >= 0.0) else None
        if "(" in text:
            kind = kind_of(text)
            is_number = kind == "number" and (is_attribute or is_unitless)
            return text if kind == "length" or is_number else None
        lower = text.lower()
        return lower if lower in known else None

    return grammar


def number(
    keywords: str = "", *, least: float = -math.inf, most: float = math.inf, has_percentage: bool = False
) -> Grammar:
    """A plain number as text; percentages as fractions of 1."""
    known = frozenset(keywords.split())

    def grammar(text: str, _: bool) -> str | None:
        match = PLAIN_LENGTH.fullmatch(text)
        if match and match[2] == "%" and has_percentage:
            return repr(float(match[1]) / 100.0)
        if match and not match[2]:
            return text if least <= float(text) <= most else None
        if "(" in text and kind_of(text) == "number":
            return text
        lower = text.lower()
        return lower if lower in known else None

    return grammar


def lengths(keywords: str = "") -> Grammar:
    """One or more lengths that are not negative, with blanks or single commas between them."""
    one = length(is_unitless=True, is_signed=False)
    known = frozenset(keywords.split())

    def grammar(text: str, is_attribute: bool) -> str | None:
        if text.lower() in known:
            return text.lower()
        if "(" in text:
            parts = [text_of([part]) for part in component_values(text) if not is_comma(part)]
        else:
            parts = re.split(r"\s*,\s*|\s+", text)
        return " ".join(parts) if parts and all(one(part, is_attribute) for part in parts) else None

    return grammar


def paint(text: str, _: bool) -> str | None:
    return text if parse_paint(text) else None


def colour(text: str, _: bool) -> str | None:
    return text if parse_colour(text) else None


def reference(text: str, _: bool) -> str | None:
    """`none` or a url()."""
    if text.lower() == "none":
        return "none"
    return text if "(" in text and parse_url(text) is not None else None


def clip_path(text: str, is_attribute: bool) -> str | None:
    """`none`, a url(), or a basic shape with or without its box."""
    if reference(text, is_attribute):
        return reference(text, is_attribute)
    parts = component_values(text)
    shapes = [part for part in parts if part.type == "function"]
    boxes = [part for part in parts if part.type == "ident" and part.lower_value in _BOXES]
    has_known_shape = all(shape.lower_name in _SHAPES for shape in shapes)
    fits = len(shapes) + len(boxes) == len(parts) and len(shapes) <= 1 and len(boxes) <= 1
    return text if parts and fits and has_known_shape else None


def path_data(text: str, is_attribute: bool) -> str | None:
    """The data alone: of `path("M0 0")` in CSS, and what stands in the attribute; "" for none."""
    if is_attribute:
        return text
    if text.lower() == "none":
        return ""
    token = tinycss2.parse_one_component_value(text, skip_comments=True)
    if token.type != "function" or token.lower_name != "path":
        return None
    arguments = significant(token.arguments)
    if len(arguments) != 1 or arguments[0].type != "string":
        return None
    data = str(arguments[0].value)
    return data if not data or _PATH_DATA.fullmatch(data) else None


def transform(text: str, is_attribute: bool) -> str | None:
    """In an attribute as SVG 1.1, section 7.6 has it, with plain numbers; in CSS with units. The numbers of both mean
    the same where they are plain: user units and degrees."""
    if text.lower() == "none":
        return "none"
    if is_attribute:
        return text if re.fullmatch(_TRANSFORM_ATTRIBUTE, text) else None
    calls = component_values(text)
    return text if calls and all(call.type == "function" and _is_transform(call) for call in calls) else None


def _is_transform(call: Node) -> bool:
    name = call.lower_name
    given = [text_of(group) for group in by_comma(call.arguments)]
    if name in _ANGLE_ARGUMENTS:
        return len(given) == 1 and _is_angle(given[0])
    if name == "skew":
        return len(given) in (1, 2) and all(map(_is_angle, given))
    if name in _LENGTH_ARGUMENTS:
        return len(given) in _LENGTH_ARGUMENTS[name] and all(_length(text, False) for text in given)
    if name in _NUMBER_ARGUMENTS:
        return len(given) in _NUMBER_ARGUMENTS[name] and all(_scale(text, False) for text in given)
    if name == "rotate3d":
        return len(given) == 4 and all(map(_plain, given[:3], [False] * 3)) and _is_angle(given[3])
    return bool(name == "perspective")


_length = length()
_plain = number()
_scale = number(has_percentage=True)
_place = length("left right center top bottom")
_ACROSS, _DOWN = frozenset({"left", "right"}), frozenset({"top", "bottom"})
_PLACES = _ACROSS | _DOWN | {"center"}


def _is_angle(text: str) -> bool:
    match = PLAIN_LENGTH.fullmatch(text)
    if match and not match[2]:
        return float(text) == 0.0
    return kind_of(text) == "angle"


def translate(text: str, _: bool) -> str | None:
    """`none`, or up to three lengths."""
    parts = _parts(text)
    return text.lower() if parts == ["none"] else _all_of(_length, parts, text)


def scale(text: str, _: bool) -> str | None:
    """`none`, or up to three numbers or percentages."""
    parts = _parts(text)
    return text.lower() if parts == ["none"] else _all_of(_scale, parts, text)


def rotate(text: str, _: bool) -> str | None:
    """`none`, an angle, or an axis and an angle."""
    parts = _parts(text)
    if parts == ["none"]:
        return "none"
    angles = [part for part in parts if _is_angle(part)]
    axis = [part for part in parts if part.lower() in ("x", "y", "z") or _plain(part, False)]
    return text if len(parts) in (1, 2, 4) and angles and len(axis) >= len(parts) - 1 else None


def font_style(text: str, _: bool) -> str | None:
    parts = _parts(text.lower())
    is_valid = parts in (["normal"], ["italic"], ["oblique"]) or (
        len(parts) == 2 and parts[0] == "oblique" and _is_angle(parts[1])
    )
    return " ".join(parts) if is_valid else None


_STRETCHES = re.compile("normal|(?:ultra-|extra-|semi-)?(?:condensed|expanded)")


def font_stretch(text: str, _: bool) -> str | None:
    match = PLAIN_LENGTH.fullmatch(text)
    is_valid = _STRETCHES.fullmatch(text.lower()) or (match and match[2] == "%" and float(match[1]) >= 0.0)
    return text.lower() if is_valid else None


def _parts(text: str) -> list[str]:
    return [text_of([part]) for part in component_values(text)]


def _all_of(one: Grammar, parts: list[str], text: str) -> str | None:
    return text if 1 <= len(parts) <= 3 and all(one(part, False) for part in parts) else None


def transform_origin(text: str, is_attribute: bool) -> str | None:
    """Two lengths or words, x before y, each written out; a third (z) is left out."""
    found = [_place(text_of([part]), is_attribute) for part in component_values(text)]
    if not 1 <= len(found) <= 3 or None in found:
        return None
    first, second = ([*(part for part in found if part), "center"])[:2]
    if {first, second} <= _PLACES and (first in _DOWN or second in _ACROSS):
        first, second = second, first
    if first in _DOWN or second in _ACROSS:
        return None
    percent = {"left": "0%", "top": "0%", "center": "50%", "right": "100%", "bottom": "100%"}
    return f"{percent.get(first, first)} {percent.get(second, second)}"
