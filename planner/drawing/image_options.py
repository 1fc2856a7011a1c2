"""How pictures of pixels become lines."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from math import inf

from planner.checked import number_in, one_of
from planner.drawing.fill_options import LEAST_SPACING_MM, USUAL_SPACING_MM
from planner.errors import UsageError

MOST_LEVELS = 12


class ImageStyle(StrEnum):
    """TRACE: the outlines of dark areas. CENTRELINE: the middle of drawn lines. HATCH: parallel lines, denser where it
    is darker. SCRIBBLE: one line that never lifts, likewise. STIPPLE: dots, likewise."""

    NONE = "none"
    TRACE = "trace"
    CENTRELINE = "centreline"
    HATCH = "hatch"
    SCRIBBLE = "scribble"
    STIPPLE = "stipple"


@dataclass(frozen=True, slots=True)
class ImageOptions:
    """line_mm: width of the pen's line. detail_mm: nothing is drawn that is finer; None: the width of the line.
    levels: tones at which TRACE follows an outline. angle_deg: of HATCH, as in `FillOptions`. ink: the share of the
    paper that ink covers where a picture is black. Errors: UsageError."""

    style: ImageStyle = ImageStyle.NONE
    line_mm: float = USUAL_SPACING_MM
    detail_mm: float | None = None
    levels: int = 1
    angle_deg: float = 45.0
    ink: float = 1.0

    def __post_init__(self) -> None:
        if isinstance(self.levels, bool) or not isinstance(self.levels, int) or not 1 <= self.levels <= MOST_LEVELS:
            raise UsageError(f"image levels is a whole number from 1 to {MOST_LEVELS}, not {self.levels!r:.40}")
        values = {
            "style": one_of("image", self.style, ImageStyle),
            "line_mm": number_in("image line", self.line_mm, minimum=LEAST_SPACING_MM),
            "detail_mm": None
            if self.detail_mm is None
            else number_in("image detail", self.detail_mm, minimum=LEAST_SPACING_MM),
            "angle_deg": number_in("image angle", self.angle_deg, zero=True, minimum=-inf),
            "ink": number_in("image ink", self.ink, maximum=1.0),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def __str__(self) -> str:
        """One line, which `image_options` reads."""
        detail = "" if self.detail_mm is None else repr(self.detail_mm)
        numbers = (repr(self.line_mm), detail, repr(self.levels), repr(self.angle_deg), repr(self.ink))
        return ",".join((self.style, *numbers))

    @property
    def is_on(self) -> bool:
        return self.style is not ImageStyle.NONE

    @property
    def least_mm(self) -> float:
        """The finest that is drawn."""
        return self.line_mm if self.detail_mm is None else self.detail_mm


NO_IMAGE = ImageOptions()


def image_options(text: str) -> ImageOptions:
    """What `str` of them wrote. Errors: UsageError."""
    try:
        style, line, detail, levels, angle, ink = (part.strip() for part in text.split(","))
        return ImageOptions(
            ImageStyle(style),
            float(line),
            float(detail) if detail else None,
            int(levels),
            float(angle),
            float(ink),
        )
    except ValueError as error:
        raise UsageError(f"'{text:.60}' does not say how pictures are drawn") from error
