"""What laying out a text needs to know of its drawing, and what comes of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

from planner.drawing.options import ReadingOptions
from planner.drawing.style.style import Style, Styles
from planner.drawing.subpath import Subpath
from planner.drawing.xml_tree import Document, Element


@dataclass(frozen=True, slots=True)
class TextContext:
    """viewport: the size that percentages are of, in user units. path_of: the subpaths of an element for text along
    it, in the user units of its parent. skipped: counts what is not drawn."""

    styles: Styles
    viewport: tuple[float, float]
    document: Document
    path_of: Callable[[Element], list[Subpath]]
    options: ReadingOptions
    skipped: Counter[str]


@dataclass(frozen=True, eq=False, slots=True)
class Glyphs:
    """Glyphs that are painted alike, in the user units of their text element. is_single_line: drawn as they are,
    whatever the fill; otherwise they are closed outlines."""

    subpaths: tuple[Subpath, ...]
    style: Style
    is_single_line: bool
