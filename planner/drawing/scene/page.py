"""The size of a document, and the page that it is on when a browser shows it alone."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from planner.affine import compose
from planner.arrays import FloatArray
from planner.drawing.scene.viewport import fitted, parse_view_box
from planner.drawing.style.style import Style
from planner.drawing.transforms import Box, local_transform
from planner.drawing.xml_tree import Element

_ABSOLUTE = re.compile(r"\d(?:mm|cm|in|pt|pc|q)\s*$", re.IGNORECASE)
_SMALLEST, _LARGEST, _LARGEST_PX = 1e-6, 1e9, 1e7
FALLBACK = (100.0, 100.0)
"""What percentages are of where a document gives neither its size nor a view box."""


@dataclass(frozen=True, slots=True)
class OwnSize:
    """width, height: in CSS pixels as the root gives them, None where it does not, or as a percentage. view_box: its
    own, None where there is none that can be used."""

    width: float | None
    height: float | None
    view_box: Box | None

    def within(self, size: tuple[float, float]) -> tuple[float, float]:
        """The size that it takes in a box: its own, or else as large as fits in its proportions."""
        width, height = self.width, self.height
        if self.view_box is None or min(self.view_box[2:]) <= 0.0:
            return size[0] if width is None else width, size[1] if height is None else height
        ratio = self.view_box[2] / self.view_box[3]
        if width is None and height is None:
            width = min(size[0], size[1] * ratio)
        if width is None:
            return (height or 0.0) * ratio, height or 0.0
        return width, width / ratio if height is None else height

    @property
    def is_known(self) -> bool:
        """Whether width and height follow from what the document says."""
        return self.view_box is not None or (self.width is not None and self.height is not None)


def own_size(root: Element, style: Style, dpi: float = 96.0, has_percentages: bool = True) -> OwnSize:
    """The size of a document. `dpi` is how many pixels, which lengths without a unit are, go to an inch; millimetres
    and the like stay as long as they are. Percentages are of the view box; in a picture they say nothing."""
    view_box = parse_view_box(root.attributes.get("viewBox"))
    has_percentages = has_percentages and view_box is not None
    width, height = _length(style, "width", has_percentages, dpi), _length(style, "height", has_percentages, dpi)
    return OwnSize(width, height, view_box)


def size_for_percentages(root: Element) -> tuple[float, float]:
    """What percentages in the size of a document are of."""
    view_box = parse_view_box(root.attributes.get("viewBox"))
    return view_box[2:] if view_box is not None else FALLBACK


def _length(style: Style, name: Literal["width", "height"], has_percentages: bool, dpi: float) -> float | None:
    text = style[name]
    if "%" in text and not has_percentages:
        return None
    length = style.length(name, "x" if name == "width" else "y")
    if length is not None and _ABSOLUTE.search(text):
        length *= dpi / 96.0
    return length


@dataclass(frozen=True, eq=False, slots=True)
class Page:
    """size_px: in CSS pixels. user_to_px: (2, 3), from the user units of the document."""

    size_px: tuple[float, float]
    user_to_px: FloatArray


def page_of(root: Element, style: Style, size: OwnSize, extent: tuple[float, float]) -> Page:
    """The page of a document, which ends at `extent` where the document does not say how large it is. Errors:
    ValueError where a number is no size or place on a page."""
    width, height = size.within(size.view_box[2:] if size.view_box else extent)
    left, top, across, down = size.view_box or (0.0, 0.0, width, height)
    least, most = min(width, height, across, down), max(width, height)
    if not (least >= _SMALLEST and most <= _LARGEST_PX and max(across, down, abs(left), abs(top)) <= _LARGEST):
        raise ValueError("its width, height or viewBox is far too small or too large (give it the size of a page)")
    box = (0.0, 0.0, width, height)
    fit = fitted((left, top, across, down), (width, height), root.attributes.get("preserveAspectRatio"))
    return Page((width, height), compose(local_transform(style, (width, height), lambda: box), fit))
