"""From a document to its scene."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from planner.arrays import frozen
from planner.drawing.options import ReadingOptions
from planner.drawing.path_data import CURVE_LIMIT, TooManyCurves
from planner.drawing.scene.boxes import box_of_subpaths
from planner.drawing.scene.expansion import check_expansion
from planner.drawing.scene.page import FALLBACK, OwnSize, Page, own_size, page_of, size_for_percentages
from planner.drawing.scene.painter import Painter
from planner.drawing.scene.place import Clipped, Inside, Leaf, Place, Work
from planner.drawing.scene.shape import Scene, Shape
from planner.drawing.scene.viewport import parse_view_box
from planner.drawing.scene.walk import Tree, leaves
from planner.drawing.style.style import Styles
from planner.drawing.transforms import IDENTITY
from planner.drawing.xml_tree import Document, Element
from planner.errors import DrawingError

MM_PER_INCH = 25.4


def read_scene(document: Document, options: ReadingOptions, folder: Path | None = None) -> Scene:
    """Everything that the document shows, on its page. folder: of the files that it may refer to. Errors: DrawingError
    for a page of no size, and for more than the limits allow."""
    check_expansion(document)
    root, styles, work = document.root, Styles(document), Work(document.source, folder)
    work.skipped.update(document.skipped)
    work.skipped.update(styles.skipped)
    size = own_size(root, styles.of(root, styles.root(FALLBACK), size_for_percentages(root)), options.dpi)
    page = _page(document, styles, size, FALLBACK)
    tree = Tree(document, styles, options, work, _root_place(root, styles, page), page.user_to_px, {})
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is found where it would be drawn
            shapes = Painter(tree).shapes(_shown(tree))
    except TooManyCurves:
        raise work.too_many(CURVE_LIMIT, "lines and curves") from None
    if not size.is_known:
        page = _page(document, styles, size, _far_corner(shapes))
    mm_per_px = MM_PER_INCH / options.dpi
    width, height = page.size_px
    return Scene(
        tuple(shapes),
        frozen(mm_per_px * page.user_to_px),
        (mm_per_px * width, mm_per_px * height),
        work.skipped,
        size.is_known or not {"width", "height", "viewBox"}.isdisjoint(root.attributes),
    )


def _page(document: Document, styles: Styles, size: OwnSize, extent: tuple[float, float]) -> Page:
    across = size.within(size.view_box[2:] if size.view_box else extent)
    style = styles.of(document.root, styles.root(across), across)
    try:
        return page_of(document.root, style, size, extent)
    except ValueError as error:
        raise DrawingError(document.source, str(error)) from None


def _root_place(root: Element, styles: Styles, page: Page) -> Place:
    """The place inside of the outermost `svg`: the user units of the drawing, which its transform is no part of."""
    style = styles.of(root, styles.root(page.size_px), page.size_px)
    view_box = parse_view_box(root.attributes.get("viewBox"))
    viewport = page.size_px if view_box is None else view_box[2:]
    place = Place(IDENTITY, style, viewport, style.number("opacity"), inside=Inside(root, None, 1))
    if style["clip-path"] != "none" or style["mask"] != "none":
        place = replace(place, clips=(Clipped(root, style, place),))
    return place


def _shown(tree: Tree) -> Iterator[Leaf]:
    root, place = tree.document.root, tree.root
    tree.work.skipped.update(place.style.unhonoured())
    if place.style["display"] != "none":
        yield from leaves(tree, root.children, place)


def _far_corner(shapes: Sequence[Shape]) -> tuple[float, float]:
    """The right and the lower end of all lines and pictures, where a page without a size ends."""
    box = box_of_subpaths(
        [path for shape in shapes for path in (*shape.lines, *(shape.outline if shape.pixels else ()))]
    )
    return (box[0] + box[2], box[1] + box[3]) if box is not None else FALLBACK
