"""Colours and paints as CSS Color 4 and SVG 2, chapter 13, write them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal
from urllib.parse import unquote

import tinycss2
import tinycss2.color5
from tinycss2.ast import Node

from planner.drawing.style.tokens import by_comma, component_values, is_comma, is_word, significant


@dataclass(frozen=True, slots=True)
class Rgba:
    """sRGB from 0 to 255, alpha from 0 to 1."""

    red: int
    green: int
    blue: int
    alpha: float = 1.0


BLACK = Rgba(0, 0, 0)
PaintKind = Literal["none", "colour", "currentcolor", "context-fill", "context-stroke", "reference"]


@dataclass(frozen=True, slots=True)
class PaintValue:
    """What `fill` or `stroke` says. colour: of kind "colour". url: of kind "reference", as it is written, `#id` or
    beyond the file; fallback: what to do where it leads nowhere, None where nothing is said (then nothing is painted).
    """

    kind: PaintKind
    colour: Rgba | None = None
    url: str = ""
    fallback: PaintValue | None = None


NO_PAINT = PaintValue("none")
_SYSTEM_WHITE = frozenset({"canvas", "field", "buttonface", "highlighttext", "window", "background"})
_SYSTEM_BLACK = frozenset(
    {
        "canvastext",
        "fieldtext",
        "buttontext",
        "buttonborder",
        "windowtext",
        "graytext",
        "menutext",
        "captiontext",
        "infotext",
        "highlight",
        "linktext",
        "visitedtext",
        "activetext",
        "mark",
        "marktext",
        "accentcolor",
        "accentcolortext",
    }
)


def parse_paint(text: str) -> PaintValue | None:
    """None where it is no paint."""
    return _paint(text)


def parse_colour(text: str) -> Rgba | Literal["currentcolor"] | None:
    """None where it is no colour."""
    return _colour(text)


def parse_url(text: str) -> str | None:
    """What stands in a url(); None where text is not just that."""
    tokens = component_values(text)
    return _url(tokens[0]) if len(tokens) == 1 else None


def fragment(url: str) -> str | None:
    """The id that a reference within the document names; None where it leads out of it, or nowhere."""
    url = url.strip()
    return unquote(url[1:]) if url.startswith("#") and len(url) > 1 else None


@lru_cache(4096)
def _paint(text: str) -> PaintValue | None:
    tokens = component_values(text)
    if not tokens:
        return None
    url = _url(tokens[0])
    if url is None:
        return _plain_paint(tokens)
    if len(tokens) == 1:
        return PaintValue("reference", url=url)
    fallback = _plain_paint(tokens[1:])
    if fallback is None or fallback.kind.startswith("context"):
        return None
    return PaintValue("reference", url=url, fallback=fallback)


def _plain_paint(tokens: Sequence[Node]) -> PaintValue | None:
    if len(tokens) != 1:
        return None
    (token,) = tokens
    if token.type == "ident":
        if token.lower_value == "none":
            return NO_PAINT
        if token.lower_value == "context-fill":
            return PaintValue("context-fill")
        if token.lower_value == "context-stroke":
            return PaintValue("context-stroke")
    colour = _from_token(token)
    if colour == "currentcolor":
        return PaintValue("currentcolor")
    return PaintValue("colour", colour) if colour else None


@lru_cache(4096)
def _colour(text: str) -> Rgba | Literal["currentcolor"] | None:
    tokens = component_values(text)
    return _from_token(tokens[0]) if len(tokens) == 1 else None


def _from_token(token: Node) -> Rgba | Literal["currentcolor"] | None:
    if token.type == "ident" and token.lower_value in _SYSTEM_BLACK:
        return BLACK
    if token.type == "ident" and token.lower_value in _SYSTEM_WHITE:
        return Rgba(255, 255, 255)
    if token.type == "function":
        if token.lower_name == "color-mix":
            return _mixed(token.arguments)
        arguments = significant(token.arguments)
        if arguments and is_word(arguments[0], "from"):  # relative to another colour, which is near enough for a pen
            return _from_token(arguments[1]) if len(arguments) > 1 else None
        if token.lower_name == "device-cmyk" or _is_old_without_percentages(token.lower_name, arguments):
            return None
        if len(arguments) == 5 and is_word(arguments[4], "none"):  # no alpha is none at all
            arguments[4] = tinycss2.parse_one_component_value("0")
            token.arguments = arguments
        if token.lower_name != "light-dark" and not all(
            argument.type in ("number", "percentage", "dimension", "ident", "literal") for argument in arguments
        ):
            return None
    elif token.type not in ("ident", "hash"):
        return None
    try:
        found = tinycss2.color5.parse_color(token)
    except (ValueError, AttributeError, IndexError, TypeError):  # an empty or a strange function
        return None
    if found is None:
        return None
    return "currentcolor" if isinstance(found, str) else _srgb(found)


def _is_old_without_percentages(name: str, arguments: Sequence[Node]) -> bool:
    """Whether it is hsl(1, 2, 3), with commas, whose saturation and lightness have to be percentages."""
    return (
        name in ("hsl", "hsla")
        and any(map(is_comma, arguments))
        and any(argument.type == "number" for argument in arguments[2:5])
    )


def _mixed(arguments: Sequence[Node]) -> Rgba | Literal["currentcolor"] | None:
    """color-mix(in SPACE, COLOUR P%, COLOUR P%), mixed in sRGB whatever the space."""
    groups = by_comma(significant(arguments))
    if len(groups) != 3:
        return None
    colours: list[Rgba] = []
    shares: list[float | None] = []
    for group in groups[1:]:
        share = [token.value / 100.0 for token in group if token.type == "percentage"]
        rest = [token for token in group if token.type != "percentage"]
        colour = _from_token(rest[0]) if len(rest) == 1 else None
        if colour is None or colour == "currentcolor":
            return colour
        colours.append(colour)
        shares.append(share[0] if share else None)
    first = shares[0] if shares[0] is not None else 1.0 - (shares[1] if shares[1] is not None else 0.5)
    second = shares[1] if shares[1] is not None else 1.0 - first
    total = first + second
    if total <= 0.0:
        return None
    one, other = colours
    mix = [(first * a + second * b) / total for a, b in zip(_channels(one), _channels(other), strict=True)]
    return Rgba(round(mix[0]), round(mix[1]), round(mix[2]), mix[3] * min(total, 1.0))


def _channels(colour: Rgba) -> tuple[float, float, float, float]:
    return colour.red, colour.green, colour.blue, colour.alpha


def _srgb(colour: tinycss2.color5.Color) -> Rgba:
    """Of the wide RGB spaces the channels are taken as they are: a pen has no nearer colour."""
    if colour.space in ("hsl", "hwb"):
        channels = colour.to("srgb").coordinates
    elif colour.space in ("lab", "lch", "xyz-d50"):
        channels = _from_xyz(*colour.to("xyz-d50").coordinates)
    elif colour.space in ("oklab", "oklch", "xyz-d65"):
        channels = _from_xyz(*colour.to("xyz-d65").coordinates)
    elif colour.space == "srgb-linear":
        channels = tuple(_gamma(channel or 0.0) for channel in colour.coordinates)
    else:
        channels = tuple(channel or 0.0 for channel in colour.coordinates)
    red, green, blue = (int(255.0 * min(max(channel, 0.0), 1.0) + 0.5) for channel in channels)
    return Rgba(red, green, blue, colour.alpha)


def _from_xyz(x: float, y: float, z: float) -> tuple[float, ...]:
    """sRGB from CIE XYZ (IEC 61966-2-1)."""
    return (
        _gamma(3.2406 * x - 1.5372 * y - 0.4986 * z),
        _gamma(-0.9689 * x + 1.8758 * y + 0.0415 * z),
        _gamma(0.0557 * x - 0.2040 * y + 1.0570 * z),
    )


def _gamma(linear: float) -> float:
    return 12.92 * linear if linear <= 0.0031308 else float(1.055 * linear ** (1.0 / 2.4) - 0.055)


def _url(token: Node) -> str | None:
    if token.type == "url":
        return str(token.value)
    if token.type == "function" and token.lower_name == "url":
        arguments = significant(token.arguments)
        return str(arguments[0].value) if len(arguments) == 1 and arguments[0].type == "string" else None
    return None
