"""The basic shapes of CSS, of which `clip-path` makes regions (CSS Shapes 1)."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from planner.drawing.path_data import parse_path
from planner.drawing.shapes import ellipse, rectangle
from planner.drawing.style.style import Style
from planner.drawing.style.units import Axis
from planner.drawing.subpath import Subpath, polyline
from planner.drawing.transforms import Box, translation

_FUNCTION = re.compile(r"([a-z]+)\(\s*(.*?)\s*\)(?=\s*(?:[a-z-]+box\s*)?$)", re.DOTALL | re.IGNORECASE)
_BOX = re.compile(r"\b((?:fill|stroke|view|border|padding|content|margin)-box)\b", re.IGNORECASE)
_WORD = re.compile(r"calc\((?:[^()]|\([^()]*\))*\)|[^\s,]+")
_SIDES = {"left": "0%", "top": "0%", "center": "50%", "right": "100%", "bottom": "100%"}


@dataclass(frozen=True, slots=True)
class BasicShape:
    subpaths: list[Subpath]
    is_even_odd: bool = False


def basic_shape(text: str, style: Style, viewport: tuple[float, float], bounds: Callable[[], Box]) -> BasicShape | None:
    """The shape of a `clip-path` in the user units of the element, whose box `bounds` gives; None where it is none."""
    named = _BOX.search(_FUNCTION.sub("", text) if _FUNCTION.search(text) else text)
    box = _reference_box(named[1].lower() if named else "border-box", style, viewport, bounds)
    function = _FUNCTION.search(text)
    if function is None:
        return BasicShape([rectangle(*box)]) if named else None
    return _Reader(style, box).shape(function[1].lower(), function[2])


def _reference_box(name: str, style: Style, viewport: tuple[float, float], bounds: Callable[[], Box]) -> Box:
    if name == "view-box":
        return (0.0, 0.0, *viewport)
    x, y, width, height = bounds()
    if name in ("fill-box", "content-box", "padding-box") or style["stroke"] == "none":
        return x, y, width, height
    half = (style.length("stroke-width", "diagonal") or 0.0) / 2.0
    return x - half, y - half, width + 2.0 * half, height + 2.0 * half


class _Reader:
    def __init__(self, style: Style, box: Box) -> None:
        self._style = style
        self._x, self._y, self._width, self._height = box

    def shape(self, name: str, text: str) -> BasicShape | None:
        if name == "polygon":
            rule, rest = _fill_rule(text)
            points = [self._point(*_WORD.findall(pair)) for pair in rest.split(",") if len(_WORD.findall(pair)) == 2]
            return BasicShape([polyline(np.array(points), is_closed=True)] if points else [], rule)
        if name == "path":
            rule, rest = _fill_rule(text)
            data = rest.strip()[1:-1]
            return BasicShape([path.moved(translation(self._x, self._y)) for path in parse_path(data)], rule)
        words = _WORD.findall(text)
        if name in ("circle", "ellipse"):
            at = words.index("at") if "at" in words else len(words)
            return self._round(words[:at], words[at + 1 :], is_circle=name == "circle")
        split = words.index("round") if "round" in words else len(words)
        sides, radii = words[:split], words[split + 1 :]
        if name == "inset" and 1 <= len(sides) <= 4:
            top, right, bottom, left = _four(sides)
            x0, y0 = self._length(left, "x"), self._length(top, "y")
            x1, y1 = self._width - self._length(right, "x"), self._height - self._length(bottom, "y")
            return self._rectangle(x0, y0, x1 - x0, y1 - y0, radii)
        if name == "xywh" and len(sides) == 4:
            x, width = (self._length(word, "x") for word in sides[::2])
            y, height = (self._length(word, "y") for word in sides[1::2])
            return self._rectangle(x, y, width, height, radii)
        if name == "rect" and len(sides) == 4:
            top, right, bottom, left = (
                {"auto": edge}.get(word, word) for word, edge in zip(sides, ("0%", "100%", "100%", "0%"), strict=True)
            )
            x, y = self._length(left, "x"), self._length(top, "y")
            return self._rectangle(x, y, self._length(right, "x") - x, self._length(bottom, "y") - y, radii)
        return None

    def _round(self, radii: list[str], center: list[str], is_circle: bool) -> BasicShape:
        x, y = self._position(center)
        across, down = (abs(x), abs(self._width - x)), (abs(y), abs(self._height - y))
        if is_circle:
            rx = ry = self._radius(radii[0] if radii else "closest-side", "diagonal", (*across, *down))
        else:
            words = radii if len(radii) == 2 else ["closest-side"] * 2
            rx, ry = self._radius(words[0], "x", across), self._radius(words[1], "y", down)
        if rx <= 0.0 or ry <= 0.0:
            return BasicShape([])
        return BasicShape([ellipse(self._x + x, self._y + y, rx, ry)])

    def _radius(self, word: str, axis: Axis, to_sides: tuple[float, ...]) -> float:
        if word == "closest-side":
            return min(to_sides)
        return max(to_sides) if word == "farthest-side" else self._length(word, axis)

    def _rectangle(self, x: float, y: float, width: float, height: float, radii: list[str]) -> BasicShape:
        if width <= 0.0 or height <= 0.0:
            return BasicShape([])
        radius = self._length(radii[0], "x") if radii else 0.0
        radius = min(radius, width / 2.0, height / 2.0)
        return BasicShape([rectangle(self._x + x, self._y + y, width, height, radius, radius)])

    def _position(self, words: list[str]) -> tuple[float, float]:
        words = words[:2] or ["center"]
        if len(words) == 1:
            words.append("center")
        if words[0] in ("top", "bottom") or words[1] in ("left", "right"):
            words.reverse()
        return self._length(_SIDES.get(words[0], words[0]), "x"), self._length(_SIDES.get(words[1], words[1]), "y")

    def _point(self, x: str, y: str) -> tuple[float, float]:
        return self._x + self._length(x, "x"), self._y + self._length(y, "y")

    def _length(self, text: str, axis: Axis) -> float:
        if text.endswith("%"):
            diagonal = math.hypot(self._width, self._height) / math.sqrt(2.0)
            whole = {"x": self._width, "y": self._height, "diagonal": diagonal}[axis]
            return float(text[:-1]) / 100.0 * whole
        return self._style.in_units(text, axis) or 0.0


def _fill_rule(text: str) -> tuple[bool, str]:
    match = re.match(r"(nonzero|evenodd)\s*,", text, re.IGNORECASE)
    return (match[1].lower() == "evenodd", text[match.end() :]) if match else (False, text)


def _four(words: list[str]) -> list[str]:
    """Top, right, bottom and left of one to four words."""
    return [words[index] for index in ((0, 0, 0, 0), (0, 1, 0, 1), (0, 1, 2, 1), (0, 1, 2, 3))[len(words) - 1]]
