"""What a user may say about how an SVG is read."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from planner.checked import number_in, one_of
from planner.drawing.image_options import NO_IMAGE, ImageOptions, ImageStyle
from planner.errors import UsageError

TextMode = Literal["single", "outline", "skip"]
CropMode = Literal["page", "none"]
TEXT_MODES: tuple[TextMode, ...] = get_args(TextMode)
CROP_MODES: tuple[CropMode, ...] = get_args(CropMode)
MIN_DPI, MAX_DPI = 10.0, 10_000.0


@dataclass(frozen=True, slots=True)
class ReadingOptions:
    """How a drawing is read. Errors: UsageError for a value that means nothing.

    Attributes:
        text: What text becomes: "single" lines, the "outline" of an installed font or of `font`, or "skip".
        font: A font file for the outlines, None for those that are installed.
        crop: What is cut off: ink beyond the "page", as a browser does, or "none".
        occlude: Whether lines under opaque fills that are painted later are left out.
        dpi: Pixels of the drawing that make an inch; old programs meant 72 or 90.
        image: How pictures of pixels become lines, or the name of a style.
    """

    text: TextMode = "single"
    font: Path | None = None
    crop: CropMode = "page"
    occlude: bool = False
    dpi: float = 96.0
    image: ImageOptions = NO_IMAGE

    def __post_init__(self) -> None:
        for name, value, choices in (("text", self.text, TEXT_MODES), ("crop", self.crop, CROP_MODES)):
            if value not in choices:
                raise UsageError(f"{name} is one of {', '.join(choices)}, not {value!r:.40}")
        if not isinstance(self.occlude, bool):
            raise UsageError(f"occlude is True or False, not {self.occlude!r:.40}")
        if self.font is not None:
            if not isinstance(self.font, str | os.PathLike):
                raise UsageError(f"font is the path of a font file, not {self.font!r:.40}")
            if self.text != "outline":
                raise UsageError(f'a font file goes with text "outline" (--text outline), not "{self.text}"')
            object.__setattr__(self, "font", Path(self.font))
        image: object = self.image
        if isinstance(image, str):
            object.__setattr__(self, "image", ImageOptions(one_of("image", image, ImageStyle)))
        elif not isinstance(image, ImageOptions):
            raise UsageError(f"image is an ImageOptions or the name of a style, not {image!r:.40}")
        object.__setattr__(self, "dpi", number_in("dpi", self.dpi, minimum=MIN_DPI, maximum=MAX_DPI))


AS_A_BROWSER = ReadingOptions()
"""The usual way."""
