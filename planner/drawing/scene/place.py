"""Where in the rendering tree an element is shown, and what a walk shares."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from planner.arrays import FloatArray
from planner.drawing.path_data import CURVE_LIMIT
from planner.drawing.raster import Raster, RasterError
from planner.drawing.style.style import Style
from planner.drawing.transforms import Box
from planner.drawing.xml_tree import Element
from planner.errors import DrawingError

ELEMENT_LIMIT = 250_000
_NESTED_COST = 10
DEPTH_LIMIT = 500
SUBPATH_LIMIT = 250_000
# Of patterns in markers in masks and so on, each of which is a walk of its own.
NESTING_LIMIT = 12
"""How deep what is shown may refer to what is shown elsewhere."""


@dataclass(frozen=True, eq=False, slots=True)
class Inside:
    """The elements that something is shown inside of, through `use` and other references as well, innermost first.
    is_resource: shown only by reference, such as a marker, in a tree of its own."""

    element: Element
    outer: Inside | None
    depth: int
    is_resource: bool = False

    def holds(self, element: Element, in_this_tree: bool = False) -> bool:
        at: Inside | None = self
        while at is not None:
            if at.element is element:
                return True
            at = None if in_this_tree and at.is_resource else at.outer
        return False


@dataclass(frozen=True, eq=False, slots=True)
class Window:
    """A viewport that hides what is outside: a box in the units that `to_user` leads from."""

    box: Box
    to_user: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Clipped:
    """An element that has a clip path or a mask, with its style and its place."""

    element: Element
    style: Style
    place: Place


@dataclass(frozen=True, eq=False, slots=True)
class Place:
    """to_user: (2, 3), from where something stands to the user units of the drawing. style: what it inherits from.
    viewport: the size of the nearest one, which percentages are of. opacity: of all groups around it together.
    clips: what cuts it. layer: the name of its layer; has_layer: whether a program said that it is one. inside: what it
    is shown inside of. context: the element whose paints `context-fill` and `context-stroke` mean. nesting: how many
    walks there are around this one."""

    to_user: FloatArray
    style: Style
    viewport: tuple[float, float]
    opacity: float = 1.0
    clips: tuple[Window | Clipped, ...] = ()
    layer: str = ""
    has_layer: bool = False
    inside: Inside | None = None
    context: Leaf | None = None
    nesting: int = 0


@dataclass(frozen=True, eq=False, slots=True)
class Leaf:
    """An element that shows something itself, with its own style, and its place with its own transform applied."""

    element: Element
    style: Style
    place: Place


def resource_place(
    element: Element, style: Style, place: Place, to_user: FloatArray, viewport: tuple[float, float]
) -> Place:
    """The place of what an element shows only where another one, at `place`, refers to it."""
    depth = place.inside.depth + 1 if place.inside else 1
    return Place(
        to_user,
        style,
        viewport,
        layer=place.layer,
        has_layer=True,
        inside=Inside(element, place.inside, depth, is_resource=True),
        nesting=place.nesting + 1,
    )


@dataclass(slots=True)
class Work:
    """What has been done so far, against the limits, and what was left out, by kind. folder: where the files are that
    the drawing may refer to. rasters: the pictures that were read, by their references."""

    source: str
    folder: Path | None = None
    rasters: dict[str, Raster | RasterError] = field(default_factory=dict)
    skipped: Counter[str] = field(default_factory=Counter)
    n_elements: int = 0
    n_curves: int = 0
    n_subpaths: int = 0
    n_pictures: int = 0

    def element(self, element: Element, inside: Inside | None, nesting: int) -> None:
        """One more that is shown. What a marker shows in a marker, or a pattern in a pattern, counts for more: it
        multiplies, and costs a walk each time."""
        self.n_elements += _NESTED_COST if nesting > 1 else 1
        if self.n_elements > ELEMENT_LIMIT:
            raise DrawingError(
                self.source,
                f"its `use` elements, markers and patterns multiply to more than {ELEMENT_LIMIT} elements"
                " (simplify it, or split it into several drawings)",
            )
        if inside is not None and inside.depth > DEPTH_LIMIT:
            raise DrawingError(
                self.source, f"its elements nest more than {DEPTH_LIMIT} deep, near line {element.line} (flatten it)"
            )

    def subpaths(self, n_subpaths: int, n_curves: int) -> None:
        self.n_subpaths += n_subpaths
        self.n_curves += n_curves
        for count, limit, what in (
            (self.n_subpaths, SUBPATH_LIMIT, "subpaths"),
            (self.n_curves, CURVE_LIMIT, "lines and curves"),
        ):
            if count > limit:
                raise self.too_many(limit, what)

    def too_many(self, limit: int, what: str) -> DrawingError:
        return DrawingError(self.source, f"more than {limit} {what} (split it into several drawings)")
