"""Texts laid out and drawn, with the styles of a real document."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np

from planner.affine import compose
from planner.arrays import FloatArray
from planner.drawing.options import ReadingOptions, TextMode
from planner.drawing.style.style import Style, Styles
from planner.drawing.subpath import Subpath, polyline
from planner.drawing.text.characters import Character, Text, read_text
from planner.drawing.text.context import Glyphs, TextContext
from planner.drawing.text.frame import cell, frame
from planner.drawing.text.layout import lay_out
from planner.drawing.text.text import text_shapes
from planner.drawing.xml_tree import Element, read_tree

VIEWPORT = (1000.0, 1000.0)
PAGE = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 1000" width="1000" height="1000"'
    ' font-family="DejaVu Sans" font-size="100">{}</svg>'
)


class Sample:
    """The first text in a page."""

    def __init__(self, svg: str, mode: TextMode = "single", font: Path | None = None) -> None:
        document = read_tree(PAGE.format(svg).encode(), "sample.svg")
        styles = Styles(document)
        options = ReadingOptions(text=mode, font=font)
        self.context = TextContext(styles, VIEWPORT, document, straight_path, options, Counter())
        self.element, self.style = _first_text(document.root, styles, styles.root(VIEWPORT))

    @property
    def skipped(self) -> Counter[str]:
        return self.context.skipped

    def laid_out(self) -> Text:
        text = read_text(self.element, self.style, self.context)
        lay_out(text, self.context.options)
        return text

    def cells(self) -> list[FloatArray | None]:
        """The box around the room of each character: x, y, width, height; None where it is beyond its path."""
        text = self.laid_out()
        return [box(character, is_vertical=text.is_vertical) for character in text.characters]

    def shapes(self) -> list[Glyphs]:
        return text_shapes(self.element, self.style, self.context)


def box(character: Character, *, is_vertical: bool) -> FloatArray | None:
    placed = frame(character, is_vertical=is_vertical)
    if placed is None:
        return None
    corners = cell(character) @ placed[:, :2].T + placed[:, 2]
    low = corners.min(axis=0)
    return np.concatenate((low, corners.max(axis=0) - low))


def ink(shapes: list[Glyphs]) -> FloatArray:
    """The points of all curves (n, 2)."""
    return np.concatenate([subpath.beziers.reshape(-1, 2) for glyphs in shapes for subpath in glyphs.subpaths])


def straight_path(element: Element) -> list[Subpath]:
    """Paths of M, L and Z, under `translate(x y) scale(k)` where there is one."""
    subpaths: list[Subpath] = []
    for piece in element.attributes["d"].split("M")[1:]:
        points = np.array([float(word) for word in piece.replace("L", " ").replace("Z", " ").split()]).reshape(-1, 2)
        subpaths.append(polyline(points, "Z" in piece))
    numbers = element.attributes.get("transform", "").replace("translate(", "").replace(") scale(", " ").rstrip(")")
    if numbers:
        x, y, scale = (float(word) for word in numbers.split())
        moved = np.array([[1.0, 0.0, x], [0.0, 1.0, y]])
        affine = compose(moved, np.array([[scale, 0.0, 0.0], [0.0, scale, 0.0]]))
        subpaths = [subpath.moved(affine) for subpath in subpaths]
    return subpaths


def _first_text(element: Element, styles: Styles, above: Style) -> tuple[Element, Style]:
    style = styles.of(element, above, VIEWPORT)
    if element.tag == "text":
        return element, style
    within = [child for child in element.children if child.tag in ("g", "text")]
    return _first_text(within[0], styles, style)
