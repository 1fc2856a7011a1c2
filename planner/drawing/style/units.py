"""Lengths: what a unit or a percentage comes to in one place of a drawing."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from planner.drawing.style.calc import Kind, NotMathematics, Quantity, evaluate

Axis = Literal["x", "y", "diagonal"]
MEDIUM_FONT_PX = 16.0
_LARGEST_PX = 2.0**25
"""What browsers take lengths beyond it for."""
_PX = {"px": 1.0, "cm": 96.0 / 2.54, "mm": 96.0 / 25.4, "q": 96.0 / 101.6, "in": 96.0, "pt": 4.0 / 3.0, "pc": 16.0}
_DEGREES = {"deg": 1.0, "grad": 0.9, "rad": 180.0 / math.pi, "turn": 360.0}
_EM = {"em": 1.0, "ic": 1.0, "ch": 0.636, "cap": 0.729}
_X_HEIGHT = 0.547
"""Of the font size. What depends on the font is that of DejaVu Sans, which takes the place of missing fonts on many
systems; of the height of an x browsers know whole pixels."""
_ASCENT, _DESCENT = 0.928, 0.236
_FONT_UNITS = frozenset({*_EM, "ex", "lh"})
_OF_PAGE: dict[str, Callable[[float, float], float]] = {
    "vw": lambda width, height: width,
    "vi": lambda width, height: width,
    "vh": lambda width, height: height,
    "vb": lambda width, height: height,
    "vmin": min,
    "vmax": max,
}
_NUMBER = r"[+-]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][+-]?\d{1,3})?"
PLAIN_LENGTH = re.compile(rf"({_NUMBER})([a-zA-Z]*|%)")
_FONT_RELATIVE = re.compile(rf"(?<![\w.#-])({_NUMBER})(r?(?:em|ex|ch|ic|cap|lh))(?![\w-])", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Units:
    """All sizes in user units. viewport: what percentages are of; page: what `vw` and `vh` are of; line_height: what
    `lh` is, that of the element."""

    font_size: float
    root_font_size: float
    line_height: float
    root_line_height: float
    viewport: tuple[float, float]
    page: tuple[float, float]

    def length(self, text: str, axis: Axis) -> float | None:
        """A length, a percentage or an expression; a plain number is in user units. None where it is none of these."""
        match = PLAIN_LENGTH.fullmatch(text)
        if match and not match[2]:
            return _bounded(float(match[1]))
        quantity = self.quantity(text, axis)
        return _bounded(quantity.value) if quantity and quantity.kind in ("length", "number") else None

    def quantity(self, text: str, axis: Axis) -> Quantity | None:
        """Anything with a unit, or a plain number; None where it is neither."""
        try:
            match = PLAIN_LENGTH.fullmatch(text)
            if match:
                found = self._resolved(float(match[1]), match[2].lower(), axis)
            elif "(" in text:
                found = self._expression(text, axis)
            else:
                return None
        except NotMathematics:
            return None
        return None if math.isnan(found.value) else found

    def without_font(self, text: str, is_percentage_of_font: bool = False) -> str:
        """The same with all that depends on the font in px, to be handed down to where the font may be another."""

        def in_px(match: re.Match[str]) -> str:
            return f"{float(match[1]) * self._font_unit(match[2].lower()):.10g}px"

        if is_percentage_of_font:
            text = re.sub(rf"({_NUMBER})%", lambda match: f"{float(match[1]) / 100.0}em", text)
        return _FONT_RELATIVE.sub(in_px, text)

    def _font_unit(self, unit: str) -> float:
        if unit == "lh":
            return self.line_height
        if unit == "rlh":
            return self.root_line_height
        size = self.font_size if unit in _FONT_UNITS else self.root_font_size
        plain = unit if unit in _FONT_UNITS else unit[1:]
        return float(math.ceil(_X_HEIGHT * size)) if plain == "ex" else _EM[plain] * size

    def _expression(self, text: str, axis: Axis) -> Quantity:
        import tinycss2

        token = tinycss2.parse_one_component_value(text, skip_comments=True)
        if token.type != "function":
            raise NotMathematics(token.type)
        return evaluate(token, lambda value, unit: self._resolved(value, unit, axis))

    def _resolved(self, value: float, unit: str, axis: Axis) -> Quantity:
        if not unit:
            return Quantity(value, "number")
        if unit in _PX:
            return Quantity(value * _PX[unit], "length")
        if unit == "%":
            return Quantity(value / 100.0 * self._reference(axis), "length")
        if unit in _DEGREES:
            return Quantity(value * _DEGREES[unit], "angle")
        if _is_of_font(unit):
            return Quantity(value * self._font_unit(unit), "length")
        if not is_length_unit(unit):
            raise NotMathematics(unit)
        return Quantity(value / 100.0 * _OF_PAGE[_plain(unit)](*self.page), "length")

    def _reference(self, axis: Axis) -> float:
        width, height = self.viewport
        if axis == "diagonal":
            return math.sqrt((width * width + height * height) / 2.0)
        return width if axis == "x" else height


def is_length_unit(unit: str) -> bool:
    """Whether it is a unit of length, in lower case."""
    return unit in _PX or _is_of_font(unit) or _plain(unit) in _OF_PAGE


def _bounded(length: float) -> float:
    return min(max(length, -_LARGEST_PX), _LARGEST_PX)


def _is_of_font(unit: str) -> bool:
    return unit in _FONT_UNITS or (unit[:1] == "r" and unit[1:] in _FONT_UNITS)


def normal_line_height(font_size: float) -> float:
    """What `line-height: normal` comes to."""
    return float(math.floor(_ASCENT * font_size + 0.5) + math.floor(_DESCENT * font_size + 0.5))


def units_of_page(page: tuple[float, float]) -> Units:
    """Those outside all elements, with initial values."""
    line_height = normal_line_height(MEDIUM_FONT_PX)
    return Units(MEDIUM_FONT_PX, MEDIUM_FONT_PX, line_height, line_height, page, page)


def _plain(unit: str) -> str:
    """`vw` for svw, lvw, dvw and cqw: the small, the large, the dynamic viewport and a container are the page here."""
    return "v" + unit[2:] if unit[:2] in ("sv", "lv", "dv", "cq") else unit


_ANYWHERE = units_of_page((100.0, 100.0))


def kind_of(text: str) -> Kind | None:
    """Whether text is a number, a length or percentage, or an angle, wherever it stands; None where it is none."""
    quantity = _ANYWHERE.quantity(text, "diagonal")
    return quantity.kind if quantity else None
