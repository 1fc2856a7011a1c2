"""Numbers on the command line: lengths and speeds with their units, and the ranges that mean something."""

from __future__ import annotations

import argparse
import dataclasses
import math
import re
from collections.abc import Callable
from pathlib import Path

from planner.errors import UsageError
from planner.paper_size import PaperSize, paper_size
from planner.pens import Pen
from planner.pens_file import read_pens
from planner.settings import ConfigurationWeights

MM_PER_UNIT = {"mm": 1.0, "cm": 10.0, "in": 25.4, "px": 25.4 / 96}
"""Suffixes of lengths; a plain number is in millimetres, and a pixel is CSS's 1/96 inch."""

_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-z]*)(/s)?\s*", re.ASCII)


def length_mm(*, zero: bool = False, minimum_mm: float = 0.0) -> Callable[[str], float]:
    """A reader of lengths such as `5`, `5mm` or `0.2in` that are positive (or `zero`) and at least the minimum."""

    def read(text: str) -> float:
        return _in_range(_in_mm(text, per_second=False), text, zero=zero, minimum=minimum_mm, unit=" mm")

    return read


def coordinate_mm(text: str) -> float:
    """A place along an axis such as `-5`, `5mm` or `0.2in`."""
    return _in_mm(text, per_second=False)


def speed_mm_s(text: str) -> float:
    """A positive speed such as `80`, `80mm/s` or `8cm/s`."""
    return _in_range(_in_mm(text, per_second=True), text)


def number(*, zero: bool = False, minimum: float = 0.0, maximum: float = math.inf) -> Callable[[str], float]:
    """A reader of plain numbers that are positive (or `zero`) and within the range."""

    def read(text: str) -> float:
        return _in_range(_finite(text, text), text, zero=zero, minimum=minimum, maximum=maximum)

    return read


def configuration_weights(text: str) -> ConfigurationWeights:
    """Weights such as `time=2,reversals=0.5`; those that are not named keep their defaults."""
    names = [field.name for field in dataclasses.fields(ConfigurationWeights)]
    weights: dict[str, float] = {}
    for part in text.split(","):
        name, separator, value = part.partition("=")
        if not separator or name.strip() not in names:
            raise argparse.ArgumentTypeError(f"'{part}' is not NAME=NUMBER with a name out of {', '.join(names)}")
        weights[name.strip()] = _in_range(_finite(value, text), text, zero=True)
    try:
        return ConfigurationWeights(**weights)
    except UsageError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def angle_deg(text: str) -> float:
    """Any finite angle in degrees."""
    return _finite(text, text)


def paper(text: str) -> PaperSize:
    """Paper such as `a5`, `letter` or `100x150mm`."""
    try:
        return paper_size(text)
    except UsageError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def names(text: str) -> tuple[str, ...]:
    """Names such as `sky,sea`."""
    found = tuple(name.strip() for name in text.split(","))
    if not all(found):
        raise argparse.ArgumentTypeError(f"'{text}' is not a list of names such as sky,sea")
    return found


def pens_file(text: str) -> tuple[Pen, ...]:
    """The pens of a file."""
    try:
        return read_pens(Path(text))
    except UsageError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def whole_number(text: str) -> int:
    """A whole number from 0 on."""
    if not (text.isascii() and text.isdecimal() and len(text) < 10):
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number")
    return int(text)


def scale(text: str) -> float:
    """A factor such as `0.5` or `50%`."""
    share = text.strip().removesuffix("%")
    return _in_range(_finite(share, text), text) / (100.0 if share != text.strip() else 1.0)


def grid(text: str) -> tuple[int, int]:
    """Columns and rows such as `2x3`."""
    match = re.fullmatch(r"\s*(\d{1,6})\s*[x×]\s*(\d{1,6})\s*", text, re.ASCII)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' is not COLUMNSxROWS, such as 2x3")
    return int(match[1]), int(match[2])


def _finite(digits: str, text: str) -> float:
    try:
        value = float(digits)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number") from None
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is not a finite number")
    return value


def _in_mm(text: str, *, per_second: bool) -> float:
    match = _QUANTITY.fullmatch(text)
    kind, ending = ("speed", "/s") if per_second else ("length", "")
    units = ", ".join(f"{unit}{ending}" for unit in MM_PER_UNIT)
    # A bare number of either kind, a length with a length's suffix, a speed with a speed's.
    if (
        match is None
        or (match[2] not in MM_PER_UNIT and match[2] != "")
        or bool(match[3]) != (per_second and match[2] != "")
    ):
        raise argparse.ArgumentTypeError(f"'{text}' is not a {kind}; wanted a number, plain or with {units}")
    return _finite(match[1], text) * MM_PER_UNIT.get(match[2], 1.0)


def _in_range(
    value: float, text: str, *, zero: bool = False, minimum: float = 0.0, maximum: float = math.inf, unit: str = ""
) -> float:
    if value < 0 or (value == 0 and not zero):
        raise argparse.ArgumentTypeError(f"'{text}' has to be {'zero or more' if zero else 'positive'}")
    if value < minimum:
        raise argparse.ArgumentTypeError(f"'{text}' is less than {minimum:g}{unit}")
    if value > maximum:
        raise argparse.ArgumentTypeError(f"'{text}' is more than {maximum:g}{unit}")
    return value
