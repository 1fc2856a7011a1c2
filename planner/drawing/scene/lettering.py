"""Text in its place in a drawing."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from planner.drawing.options import ReadingOptions
from planner.drawing.scene.boxes import box_of_subpaths
from planner.drawing.scene.place import Leaf
from planner.drawing.shapes import SHAPES, outline_of
from planner.drawing.subpath import Subpath
from planner.drawing.transforms import Box, local_transform
from planner.drawing.xml_tree import Element

if TYPE_CHECKING:
    from planner.drawing.scene.walk import Tree
    from planner.drawing.text.context import Glyphs, TextContext


def glyphs_of(tree: Tree, leaf: Leaf, is_area: bool = False) -> list[Glyphs]:
    """The glyphs of a `text`. is_area: what they cover is asked for, which the letters of a single-line face have
    not."""
    if not any(element.text.strip() for element in leaf.element.descendants()):
        return []
    from planner.drawing.text.text import text_shapes

    options = replace(tree.options, text="outline") if is_area and tree.options.text == "single" else tree.options
    return text_shapes(leaf.element, leaf.style, _context(tree, leaf, options))


def box_of_text(tree: Tree, leaf: Leaf) -> Box | None:
    """The box around the room of all characters of a `text`."""
    from planner.drawing.text.text import text_box

    return text_box(leaf.element, leaf.style, _context(tree, leaf, tree.options))


def _context(tree: Tree, leaf: Leaf, options: ReadingOptions) -> TextContext:
    from planner.drawing.text.context import TextContext

    def path_of(element: Element) -> list[Subpath]:
        if element.tag not in SHAPES:
            return []
        style = tree.style_of(element)
        outline = outline_of(element, style)
        box = box_of_subpaths(outline) or (0.0, 0.0, 0.0, 0.0)
        transform = local_transform(style, leaf.place.viewport, lambda: box)
        return [path.moved(transform) for path in outline]

    return TextContext(tree.styles, leaf.place.viewport, tree.document, path_of, options, tree.work.skipped)
