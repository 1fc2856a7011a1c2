"""What an element is filled and stroked with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

import numpy as np

from planner.drawing.scene.patterns import Tiles, tiles_of
from planner.drawing.scene.place import Place
from planner.drawing.scene.references import by_url, chain, inherited_attribute
from planner.drawing.scene.shape import Paint
from planner.drawing.scene.walk import Tree, box_of
from planner.drawing.style.colour import PaintValue, Rgba
from planner.drawing.style.style import Style
from planner.drawing.transforms import Box, parse_transform
from planner.drawing.xml_tree import Element

_GRADIENTS = frozenset({"linearGradient", "radialGradient"})
AnyPaint = Paint | Tiles | None


def paint_of(
    tree: Tree, kind: Literal["fill", "stroke"], style: Style, place: Place, box: Callable[[], Box | None]
) -> AnyPaint:
    """The paint of an element that can be seen, or None. `box` gives the box around the element."""
    opacity = place.opacity * style.number(f"{kind}-opacity")
    return _Mixer(tree, style, place, box, opacity).paint(style.paint(kind)) if opacity > 0.0 else None


class _Mixer:
    def __init__(self, tree: Tree, style: Style, place: Place, box: Callable[[], Box | None], opacity: float) -> None:
        self._tree, self._style, self._place, self._box, self._opacity = tree, style, place, box, opacity

    def paint(self, value: PaintValue) -> AnyPaint:
        if value.kind == "colour" and value.colour is not None:
            return self._seen([value.colour])
        if value.kind in ("context-fill", "context-stroke"):
            return self._of_context("fill" if value.kind == "context-fill" else "stroke")
        if value.kind == "reference":
            return self._referenced(value)
        return None

    def _of_context(self, kind: Literal["fill", "stroke"]) -> AnyPaint:
        context = self._place.context
        if context is None:
            return None
        element, style, place = context.element, context.style, context.place
        return _Mixer(self._tree, style, place, lambda: box_of(self._tree, element, style, place), self._opacity).paint(
            style.paint(kind)
        )

    def _seen(self, colours: list[Rgba]) -> Paint | None:
        """A paint of one or more colours, in the mean of them; None where all of them are transparent."""
        if not any(colour.alpha > 0.0 for colour in colours):
            return None
        if len(colours) == 1:
            (colour,) = colours
            return Paint((colour.red, colour.green, colour.blue), self._opacity >= 1.0 and colour.alpha >= 1.0)
        red, green, blue = (
            round(sum(values) / len(colours))
            for values in zip(*((one.red, one.green, one.blue) for one in colours), strict=True)
        )
        return Paint((red, green, blue), self._opacity >= 1.0 and all(colour.alpha >= 1.0 for colour in colours))

    def _referenced(self, value: PaintValue) -> AnyPaint:
        target = by_url(self._tree.document, value.url, "pattern", *_GRADIENTS)
        if target is None and not value.url.startswith("#"):
            self._tree.work.skipped["external reference"] += 1
        fallback = self.paint(value.fallback) if value.fallback is not None else None
        if target is None or not self._tree.is_rendered(target):
            return fallback
        box = self._box()
        if target.tag == "pattern":
            inside = self._place.inside
            if inside is not None and inside.holds(target):
                self._tree.work.skipped["reference to itself"] += 1
                return fallback
            tiles = tiles_of(self._tree, target, self._style, self._place, box) if box is not None else None
            return fallback if tiles is None else tiles
        if self._is_boundless(target, box):
            return fallback
        return self._gradient(target)

    def _is_boundless(self, gradient: Element, box: Box | None) -> bool:
        """Whether a gradient is measured by a box that has no width or no height."""
        units = inherited_attribute(self._chain(gradient), "gradientUnits")
        return units != "userSpaceOnUse" and (box is None or min(box[2:]) <= 0.0)

    def _gradient(self, gradient: Element) -> Paint | None:
        stops = next((stops for one in self._chain(gradient) if (stops := _stops(one))), [])
        transform = inherited_attribute(self._chain(gradient), "gradientTransform")
        matrix = parse_transform(transform or "none", self._style, (0.0, 0.0, 1.0, 1.0))
        if np.linalg.det(matrix[:, :2]) == 0.0:
            return None
        return self._seen([self._stop_colour(stop) for stop in stops])

    def _chain(self, gradient: Element) -> list[Element]:
        return chain(self._tree.document, gradient, *_GRADIENTS)

    def _stop_colour(self, stop: Element) -> Rgba:
        style = self._tree.style_of(stop)
        colour = style.colour("stop-color")
        return replace(colour, alpha=colour.alpha * style.number("stop-opacity"))


def _stops(gradient: Element) -> list[Element]:
    return [child for child in gradient.children if child.tag == "stop"]
