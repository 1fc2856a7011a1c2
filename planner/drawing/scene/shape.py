"""What a document shows, in the order in which it is painted."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from planner.arrays import FloatArray
from planner.drawing.raster import Darkness
from planner.drawing.subpath import Subpath

if TYPE_CHECKING:  # Trajectories know of drawings, and are played on computers that have no Shapely.
    from shapely.geometry.base import BaseGeometry

if TYPE_CHECKING:
    Colour = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Paint:
    """colour: sRGB, of a gradient the mean of its stops. is_opaque: whether it hides all that is under it."""

    colour: Colour
    is_opaque: bool


@dataclass(frozen=True, slots=True)
class Stroke:
    """width: in user units. cap, join: as SVG calls them. What they come to is seen where a stroke is an area, in
    masks."""

    paint: Paint
    width: float
    cap: str = "butt"
    join: str = "miter"
    miter_limit: float = 4.0


@dataclass(frozen=True, eq=False, slots=True)
class Pixels:
    """darkness: (rows, columns). to_user: (2, 3), from columns and rows, counted from the outer corner of the first
    pixel, to user units. opacity: of the whole."""

    darkness: Darkness
    to_user: FloatArray
    opacity: float = 1.0


@dataclass(frozen=True, eq=False, slots=True)
class Shape:
    """Something painted, in the user units of the outermost `svg`, all transforms applied.

    outline: the whole outline, what is filled. lines: what a pen would draw of it: its stroke with its dashes, or else
    the edge of its fill, with the edges that close open subpaths wherever there is a fill; empty where only its fill
    counts (to hide what is below). fill, stroke: None where there is none that can be seen. is_even_odd: the fill rule.
    clips: regions in user units, all of which cut it. layer: the name of its layer, or "". pixels: of a picture, whose
    frame is the outline; else None.
    """

    outline: tuple[Subpath, ...]
    lines: tuple[Subpath, ...]
    fill: Paint | None
    is_even_odd: bool
    stroke: Stroke | None
    clips: tuple[BaseGeometry, ...]
    layer: str
    pixels: Pixels | None = None

    @property
    def colour(self) -> Colour:
        """Of its lines: that of the stroke, or else of the fill."""
        paint = self.stroke.paint if self.stroke is not None else self.fill
        return (0, 0, 0) if paint is None else paint.colour

    @property
    def width(self) -> float:
        """Of its stroke, 0 where its lines are the edge of its fill."""
        return 0.0 if self.stroke is None else self.stroke.width

    @property
    def shows(self) -> bool:
        """Whether a pen draws anything of it."""
        return bool(self.lines) or self.pixels is not None


@dataclass(frozen=True, eq=False, slots=True)
class Scene:
    """shapes: in the order of painting. user_to_page: (2, 3), from user units to mm on the page, y down. page_mm: its
    size. skipped: what is shown but is not, or not exactly, drawn, by kind. has_page: whether the file says how large
    its page is."""

    shapes: tuple[Shape, ...]
    user_to_page: FloatArray
    page_mm: tuple[float, float]
    skipped: Counter[str]
    has_page: bool = True
