"""What a user may say about how an SVG is read."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

TextMode = Literal["single", "outline", "skip"]
CropMode = Literal["page", "none"]


@dataclass(frozen=True, slots=True)
class ReadingOptions:
    """text: glyphs as single lines, as the outlines of an installed font or of `font`, or not at all. crop: whether ink
    beyond the page is cut off, as a browser does. is_occluding: whether lines under opaque fills that are painted later
    are left out. dpi: CSS pixels per inch; old programs meant 72 or 90.
    """

    text: TextMode = "single"
    font: Path | None = None
    crop: CropMode = "page"
    is_occluding: bool = False
    dpi: float = 96.0
