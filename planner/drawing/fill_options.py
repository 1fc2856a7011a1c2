"""How areas are filled with lines."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from math import inf

from planner.checked import number_in, one_of
from planner.errors import UsageError

USUAL_SPACING_MM = 0.5
"""About the width of a fineliner's line: neighbouring lines touch."""
LEAST_SPACING_MM = 0.05


class FillKind(StrEnum):
    """NONE: the edges of areas alone. CONTOUR: lines along the edge. SPIRAL: these, one leading to the next."""

    NONE = "none"
    HATCH = "hatch"
    CROSS = "cross"
    ZIGZAG = "zigzag"
    CONTOUR = "contour"
    SPIRAL = "spiral"


class FillBy(StrEnum):
    """What changes from area to area. LIGHTNESS: the spacing, so that the tone is carried. COLOUR: the angle."""

    NOTHING = "nothing"
    LIGHTNESS = "lightness"
    COLOUR = "colour"


class WideStrokes(StrEnum):
    """How a stroke is drawn that is wider than the pen's line. LINE: once along its middle. PASSES: side by side."""

    LINE = "line"
    PASSES = "passes"


@dataclass(frozen=True, slots=True)
class FillOptions:
    """angle_deg: of hatches, counterclockwise from the left-right direction of the paper. spacing_mm: between lines on
    the paper, the width of the pen's line. inset_mm: between the edge of an area and its lines; None: half the spacing.
    Errors: UsageError."""

    kind: FillKind = FillKind.NONE
    angle_deg: float = 45.0
    spacing_mm: float = USUAL_SPACING_MM
    inset_mm: float | None = None
    by: FillBy = FillBy.NOTHING
    wide_strokes: WideStrokes = WideStrokes.LINE

    def __post_init__(self) -> None:
        values = {
            "kind": one_of("fill", self.kind, FillKind),
            "by": one_of("fill by", self.by, FillBy),
            "wide_strokes": one_of("stroke width", self.wide_strokes, WideStrokes),
            "angle_deg": number_in("fill angle", self.angle_deg, zero=True, minimum=-inf),
            "spacing_mm": number_in("fill spacing", self.spacing_mm, minimum=LEAST_SPACING_MM),
            "inset_mm": None if self.inset_mm is None else number_in("fill inset", self.inset_mm, zero=True),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        if self.by is FillBy.COLOUR and self.kind in (FillKind.CONTOUR, FillKind.SPIRAL):
            raise UsageError(f"fill by colour changes the angle of lines, and {self.kind} has none; use hatch or cross")

    def __str__(self) -> str:
        """One line, which `fill_options` reads."""
        inset = "" if self.inset_mm is None else repr(self.inset_mm)
        return ",".join((self.kind, repr(self.angle_deg), repr(self.spacing_mm), inset, self.by, self.wide_strokes))

    @property
    def draws_anything(self) -> bool:
        return self.kind is not FillKind.NONE or self.wide_strokes is WideStrokes.PASSES

    @property
    def from_edge_mm(self) -> float:
        return self.spacing_mm / 2 if self.inset_mm is None else self.inset_mm


NO_FILL = FillOptions()


def fill_options(text: str) -> FillOptions:
    """What `str` of them wrote. Errors: UsageError."""
    parts = text.split(",")
    try:
        kind, angle, spacing, inset, by, wide = (part.strip() for part in parts)
        return FillOptions(
            FillKind(kind),
            float(angle),
            float(spacing),
            float(inset) if inset else None,
            FillBy(by),
            WideStrokes(wide),
        )
    except ValueError as error:
        raise UsageError(f"'{text:.60}' does not say how areas are filled") from error
