"""Pens: what they are called, what they draw, and how the arm moves with them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from planner.checked import number_in
from planner.errors import UsageError

Colour = tuple[int, int, int]
BLACK: Colour = (0, 0, 0)
_MOST_MM = 100.0
"""Of height: what is beyond is no difference between pens in one holder."""


class GroupBy(StrEnum):
    """What tells which pen draws a line."""

    LAYER = "layer"
    COLOUR = "colour"
    WIDTH = "width"


@dataclass(frozen=True, slots=True)
class Pen:
    """colour: sRGB. width_mm: of its line on paper, 0 where nobody said. layers: those that it draws, beside one of its
    own name. speed_mm_s, lift_mm, lowering_speed_mm_s: instead of those of the plan. height_mm: how much further its
    tip sticks out than that of the pen which the arm's file describes, so that it is held so much higher; negative
    where it sticks out less. Errors: UsageError."""

    name: str
    colour: Colour = BLACK
    width_mm: float = 0.0
    layers: tuple[str, ...] = ()
    speed_mm_s: float | None = None
    lift_mm: float | None = None
    lowering_speed_mm_s: float | None = None
    height_mm: float = 0.0

    def __post_init__(self) -> None:
        if not self.name or "\n" in self.name:
            raise UsageError(f"a pen has a name of one line, not {self.name!r:.40}")
        number_in(f"width of pen '{self.name}'", self.width_mm, zero=True)
        number_in(f"height_mm of pen '{self.name}'", self.height_mm, zero=True, minimum=-_MOST_MM, maximum=_MOST_MM)
        for what in ("speed_mm_s", "lift_mm", "lowering_speed_mm_s"):
            if (value := getattr(self, what)) is not None:
                number_in(f"{what} of pen '{self.name}'", value)


def hex_of(colour: Colour) -> str:
    """`#rrggbb`."""
    return "#{:02x}{:02x}{:02x}".format(*colour)


def colour_of(text: str) -> Colour:
    """`#rgb` or `#rrggbb`. Errors: UsageError."""
    digits = text.strip().removeprefix("#")
    if len(digits) == 3:
        digits = "".join(2 * digit for digit in digits)
    try:
        if len(digits) != 6 or not digits.isalnum():
            raise ValueError
        return int(digits[:2], 16), int(digits[2:4], 16), int(digits[4:], 16)
    except ValueError:
        raise UsageError(f"'{text:.20}' is no colour such as #0050c8") from None
