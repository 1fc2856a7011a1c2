"""Transforms of elements: the functions of the attribute and those of CSS, with their origins.

Functions in space are seen from the front: what they do to x and y is what they do.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import reduce

import numpy as np

from planner.affine import compose, rotation
from planner.arrays import FloatArray, frozen
from planner.drawing.style.style import Style
from planner.drawing.style.units import Axis

Box = tuple[float, float, float, float]
"""x, y, width, height."""
IDENTITY = frozen([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
_NUMBER = r"(?>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
_CALL = r"\((?:[^()]|\((?:[^()]|\([^()]*\))*\))*\)"
_FUNCTION = re.compile(rf"\s*,?\s*([a-zA-Z0-9]+)\s*({_CALL})\s*")
_ARGUMENT = re.compile(rf"\s*({_NUMBER}[a-zA-Z%]*|[a-z]+{_CALL})\s*,?\s*")
_ANGLE = re.compile(rf"({_NUMBER})(deg|grad|rad|turn)?", re.IGNORECASE)
_RAD_PER_UNIT = {"": math.pi / 180.0, "deg": math.pi / 180.0, "grad": math.pi / 200.0, "rad": 1.0, "turn": math.tau}
_SIDES = {"left": "0%", "top": "0%", "center": "50%", "right": "100%", "bottom": "100%"}


def local_transform(style: Style, viewport: tuple[float, float], bounds: Callable[[], Box]) -> FloatArray:
    """(2, 3), from the user units of an element to those around it: the properties `translate`, `rotate`, `scale` and
    `transform` about the origin of transforms. `bounds` gives the box of the element; it is asked only where the
    style refers to it."""
    translate, rotate, scale, functions = (style[name] for name in ("translate", "rotate", "scale", "transform"))
    if translate == rotate == scale == functions == "none":
        return IDENTITY
    refers_to_bounds = style["transform-box"] in ("fill-box", "stroke-box", "content-box", "border-box")
    box = bounds() if refers_to_bounds else (0.0, 0.0, *viewport)
    reader = _Reader(style, box)
    steps = [
        reader.functions(f"translate({translate})" if translate != "none" else "none"),
        reader.functions(_rotation_function(rotate)),
        reader.functions(f"scale({scale})" if scale != "none" else "none"),
        reader.functions(functions),
    ]
    return about(reduce(compose, steps), *reader.origin(style["transform-origin"]))


def parse_transform(text: str, style: Style, box: Box) -> FloatArray:
    """A list of transform functions as (2, 3): the identity for `none`, and for a list with an error anywhere in it.
    Percentages are of the box."""
    return _Reader(style, box).functions(text)


def about(matrix: FloatArray, x: float, y: float) -> FloatArray:
    """The same with (x, y) in the place of the origin."""
    if x == 0.0 and y == 0.0:
        return matrix
    return compose(compose(translation(x, y), matrix), translation(-x, -y))


def translation(x: float, y: float) -> FloatArray:
    return np.array([[1.0, 0.0, x], [0.0, 1.0, y]])


def scaling(x: float, y: float) -> FloatArray:
    return np.array([[x, 0.0, 0.0], [0.0, y, 0.0]])


def parse_angle(text: str) -> float | None:
    """An angle in radians, degrees where no unit is given; None where it is none."""
    match = _ANGLE.fullmatch(text.strip())
    return float(match[1]) * _RAD_PER_UNIT[(match[2] or "").lower()] if match else None


class _Invalid(ValueError):
    """A function that does not exist, or not with these arguments."""


class _Reader:
    def __init__(self, style: Style, box: Box) -> None:
        self._style, self._box = style, box

    def functions(self, text: str) -> FloatArray:
        at, matrices = 0, []
        text = text.strip()
        while match := _FUNCTION.match(text, at):
            at = match.end()
            try:
                matrices.append(self._matrix(match[1].lower(), _arguments(match[2][1:-1])))
            except _Invalid:
                return IDENTITY
        if at < len(text) or not matrices:
            return IDENTITY
        return reduce(compose, matrices)

    def origin(self, text: str) -> tuple[float, float]:
        """`transform-origin`: one or two of a length, a percentage or a side; the third would be a depth."""
        words = [match[0].strip() for match in re.finditer(rf"[^\s(]+{_CALL}|\S+", text)][:2]
        if not words:
            return 0.0, 0.0
        if len(words) == 1:
            words.append("center")
        if words[0] in ("top", "bottom") or words[1] in ("left", "right"):
            words.reverse()
        x, y, width, height = self._box
        return (
            x + self._length(_SIDES.get(words[0], words[0]), "x", width),
            y + self._length(_SIDES.get(words[1], words[1]), "y", height),
        )

    def _length(self, text: str, axis: Axis, whole: float) -> float:
        if text.endswith("%"):
            return float(text[:-1]) / 100.0 * whole if re.fullmatch(_NUMBER, text[:-1]) else 0.0
        return self._style.in_units(text, axis) or 0.0

    def _matrix(self, name: str, arguments: list[str]) -> FloatArray:
        n_arguments = len(arguments)
        if name in _NUMBERS_OF and n_arguments not in _NUMBERS_OF[name]:
            raise _Invalid
        if name in ("translate", "translate3d", "translatex", "translatey"):
            x = self._length(arguments[0], "x", self._box[2]) if name != "translatey" else 0.0
            y_text = arguments[0] if name == "translatey" else arguments[1] if n_arguments > 1 else "0"
            return translation(x, self._length(y_text, "y", self._box[3]))
        if name in ("scale", "scale3d", "scalex", "scaley"):
            values = [_number(text) for text in arguments]
            x = values[0] if name != "scaley" else 1.0
            y = values[1] if n_arguments > 1 else 1.0 if name == "scalex" else values[0]
            return scaling(x, y)
        if name == "rotate" and n_arguments == 3:
            return about(_turn(_angle(arguments[0])), _number(arguments[1]), _number(arguments[2]))
        if name in ("rotate", "rotatez"):
            return _turn(_angle(arguments[0]))
        if name in ("rotatex", "rotatey"):
            across = math.cos(_angle(arguments[0]))
            return scaling(1.0, across) if name == "rotatex" else scaling(across, 1.0)
        if name == "rotate3d":
            return _turn_about([_number(text) for text in arguments[:3]], _angle(arguments[3]))
        if name in ("skewx", "skewy", "skew"):
            first = math.tan(_angle(arguments[0]))
            second = math.tan(_angle(arguments[1])) if n_arguments > 1 else 0.0
            x, y = (0.0, first) if name == "skewy" else (first, second)
            return np.array([[1.0, x, 0.0], [y, 1.0, 0.0]])
        if name in ("matrix", "matrix3d"):
            values = [_number(text) for text in arguments]
            a, b, c, d, e, f = values if name == "matrix" else [values[index] for index in (0, 1, 4, 5, 12, 13)]
            return np.array([[a, c, e], [b, d, f]])
        if name in ("translatez", "scalez", "perspective"):
            return IDENTITY
        raise _Invalid


_NUMBERS_OF = {
    "translate": (1, 2),
    "translatex": (1,),
    "translatey": (1,),
    "translatez": (1,),
    "translate3d": (3,),
    "scale": (1, 2),
    "scalex": (1,),
    "scaley": (1,),
    "scalez": (1,),
    "scale3d": (3,),
    "rotate": (1, 3),
    "rotatex": (1,),
    "rotatey": (1,),
    "rotatez": (1,),
    "rotate3d": (4,),
    "skew": (1, 2),
    "skewx": (1,),
    "skewy": (1,),
    "matrix": (6,),
    "matrix3d": (16,),
}


def _arguments(text: str) -> list[str]:
    at, arguments = 0, []
    while match := _ARGUMENT.match(text, at):
        arguments.append(match[1])
        at = match.end()
    if at < len(text) or text.rstrip().endswith(","):
        raise _Invalid
    return arguments


def _number(text: str) -> float:
    """A plain number, a percentage of one, or pixels."""
    match = re.fullmatch(rf"({_NUMBER})(%|px)?", text)
    if match is None:
        raise _Invalid
    return float(match[1]) / (100.0 if match[2] == "%" else 1.0)


def _angle(text: str) -> float:
    angle = parse_angle(text)
    if angle is None:
        raise _Invalid
    return angle


def _turn(angle_rad: float) -> FloatArray:
    return rotation(math.degrees(angle_rad))


def _turn_about(axis: list[float], angle_rad: float) -> FloatArray:
    """What a turn about an axis in space does to x and y (Rodrigues)."""
    length = math.hypot(*axis)
    if length == 0.0:
        return IDENTITY
    x, y, z = (value / length for value in axis)
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    rest = 1.0 - cosine
    return np.array(
        [[cosine + x * x * rest, x * y * rest - z * sine, 0.0], [x * y * rest + z * sine, cosine + y * y * rest, 0.0]]
    )


def _rotation_function(text: str) -> str:
    """The property `rotate` as a function: an angle alone, or with an axis before or after it."""
    if text == "none":
        return "none"
    words = text.split()
    angles = [word for word in words if _ANGLE.fullmatch(word) and word[-1].isalpha()]
    axis = " ".join(word for word in words if word not in angles)
    named = {"": "0 0 1", "x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}
    return f"rotate3d({named.get(axis, axis)} {' '.join(angles)})"
