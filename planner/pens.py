"""Pens: what they are called, what they draw, and how the arm moves with them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from planner.checked import number_in
from planner.errors import UsageError

Colour = tuple[int, int, int]
BLACK: Colour = (0, 0, 0)


class GroupBy(StrEnum):
    """What tells which pen draws a line."""

    LAYER = "layer"
    COLOUR = "colour"
    WIDTH = "width"


@dataclass(frozen=True, slots=True)
class Pen:
    """colour: sRGB. width_mm: of its line on paper, 0 where nobody said. layers: those that it draws, beside one of its
    own name. speed_mm_s, lift_mm, lowering_speed_mm_s: instead of those of the plan. Errors: UsageError."""

    name: str
    colour: Colour = BLACK
    width_mm: float = 0.0
    layers: tuple[str, ...] = ()
    speed_mm_s: float | None = None
    lift_mm: float | None = None
    lowering_speed_mm_s: float | None = None

    def __post_init__(self) -> None:
        if not self.name or "\n" in self.name:
            raise UsageError(f"a pen has a name of one line, not {self.name!r:.40}")
        number_in(f"width of pen '{self.name}'", self.width_mm, zero=True)
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
