"""Sheets of paper by name or size."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import StrEnum

from planner.errors import UsageError

_PER_UNIT = {"mm": 1.0, "cm": 10.0, "in": 25.4, "": 1.0}
_ISO_A0_MM = (841, 1189)
_NAMED_MM = {"letter": (215.9, 279.4), "legal": (215.9, 355.6), "tabloid": (279.4, 431.8)}
_SIZE = re.compile(r"(\d+\.?\d*|\.\d+)(mm|cm|in)?[x×](\d+\.?\d*|\.\d+)(mm|cm|in)?")
_LEAST_MM, _MOST_MM = 1.0, 10_000.0


class Orientation(StrEnum):
    """Which way a sheet lies, as somebody sees it who stands behind the arm; AUTO: as the drawing does."""

    AUTO = "auto"
    PORTRAIT = "portrait"
    LANDSCAPE = "landscape"


@dataclass(frozen=True, slots=True)
class PaperSize:
    """name: such as "A5", or as the user said it. may_turn: whether it lies as the drawing does where nobody says how:
    sheets that go by a name do, and are given upright. Errors: UsageError for a size that no paper has."""

    name: str
    width_mm: float
    height_mm: float
    may_turn: bool = False

    def __post_init__(self) -> None:
        if not all(_LEAST_MM <= side <= _MOST_MM for side in (self.width_mm, self.height_mm)):
            raise UsageError(f"paper of {self.width_mm:g} x {self.height_mm:g} mm: sides are {_LEAST_MM:g} mm to 10 m")

    def lying(self, orientation: Orientation, drawing_is_wide: bool) -> PaperSize:
        """The same, lying as it is wanted."""
        is_wide = self.width_mm > self.height_mm
        if orientation is Orientation.AUTO:
            wanted = drawing_is_wide if self.may_turn else is_wide
        else:
            wanted = orientation is Orientation.LANDSCAPE
        if wanted == is_wide:
            return self
        return replace(self, width_mm=self.height_mm, height_mm=self.width_mm)

    def __str__(self) -> str:
        return f"{self.name} ({self.width_mm:g} x {self.height_mm:g} mm)"


def paper_size(text: str) -> PaperSize:
    """Paper by name (a0 to a10, letter, legal, tabloid) or as WIDTHxHEIGHT, plain in mm or with mm, cm, in.

    Errors: UsageError for anything else.
    """
    wanted = text.strip().lower().replace(" ", "")
    if re.fullmatch(r"a\d|a10", wanted):
        width, height = _ISO_A0_MM
        for _ in range(int(wanted[1:])):
            width, height = height // 2, width
        return PaperSize(wanted.upper(), float(width), float(height), may_turn=True)
    if wanted in _NAMED_MM:
        return PaperSize(wanted, *_NAMED_MM[wanted], may_turn=True)
    match = _SIZE.fullmatch(wanted)
    if match is None:
        known = "a0 to a10, " + ", ".join(_NAMED_MM)
        raise UsageError(f"'{text:.40}' is no paper; there are {known}, and sizes such as 100x150 or 10x15cm")
    unit, other = match[2] or match[4] or "", match[4] or match[2] or ""
    return PaperSize(text.strip(), float(match[1]) * _PER_UNIT[unit], float(match[3]) * _PER_UNIT[other])
