"""What a property of an element comes to: cascade, inheritance, custom properties, units."""

from __future__ import annotations

from typing import Literal, Protocol

from planner.drawing.xml_tree import Element

Axis = Literal["x", "y", "diagonal"]


class Style(Protocol):
    """The computed style of one element in one place of the rendering tree (`use` shows an element in several)."""

    @property
    def font_size(self) -> float:
        """In user units."""

    def __getitem__(self, name: str) -> str:
        """The computed value of a property as text: cascade by origin, importance, specificity and order, `var()`,
        `inherit`, `initial`, `unset` and `revert` resolved, inherited where that is the rule, invalid values dropped.
        Presentation attributes and geometry properties (`x`, `r`, `d`, `transform`, ...) included; `auto`, `none`
        where nothing was said."""

    def length(self, name: str, axis: Axis) -> float | None:
        """A property that is a length, in user units; None for `auto` and the like."""

    def in_units(self, text: str, axis: Axis) -> float | None:
        """Any length or percentage by the units of this place; None where it is none."""


class Styles(Protocol):
    """All styles of a document."""

    def root(self, viewport: tuple[float, float]) -> Style:
        """That of what the outermost `svg` inherits from: initial values, with the page as the viewport."""

    def of(self, element: Element, parent: Style, viewport: tuple[float, float]) -> Style:
        """That of an element that is shown under something with the style `parent`; `viewport` is the size of the
        nearest viewport in user units, which percentages are of."""
