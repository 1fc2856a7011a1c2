"""From an SVG file, or a picture, to a Drawing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from planner.counted import counted
from planner.drawing.drawing import Drawing
from planner.drawing.image.as_drawing import picture_scene, with_a_style
from planner.drawing.image_options import NO_IMAGE
from planner.drawing.options import AS_A_BROWSER, ReadingOptions
from planner.drawing.outlines import BEYOND_THE_PAGE, outlines
from planner.drawing.raster import is_raster
from planner.drawing.scene.linked import folder_of
from planner.drawing.scene.scene import read_scene
from planner.drawing.shapes import SHAPES
from planner.drawing.source import DrawingSource, read_source
from planner.drawing.xml_tree import Document, read_tree
from planner.errors import DrawingError

_STEPS = 4
_ADVICE = {
    "text": "draw text with --text single or outline",
    "foreignObject": "convert embedded pages to paths, or export the drawing as plain SVG",
    "image": "draw pictures with --image hatch, or another style",
    "path with unusable numbers": "bring the numbers of its paths and transforms below 1e9",
    "path with unreadable data": "mend the data of its paths, or export the drawing anew",
}
"""What to do about things that cannot be drawn, where there is nothing else."""
_OTHER_IMAGES = "put pictures into the drawing itself, or whole beside it in its folder"


def read_drawing(
    svg: DrawingSource,
    report: Callable[[int, int], None] = lambda done, total: None,
    *,
    options: ReadingOptions = AS_A_BROWSER,
) -> Drawing:
    """All visible outlines of an SVG, a file or in memory, gzipped or not, with the page they are on; or a picture of
    pixels, which has none before it is placed.

    Only that one file is ever read, and, where pictures are drawn, those beside it. `report` is told how much of
    the work is done, and how much there is. Raises DrawingError for a file that is missing, not an SVG, unsafe or
    beyond the limits of size, and for a drawing in which there is nothing to draw.
    """
    source = svg.name
    data = read_source(svg)
    report(1, _STEPS)
    if is_raster(data):
        options = with_a_style(options)
        scene = picture_scene(data, source, options)
        report(_STEPS, _STEPS)
        return Drawing(source, (), scene.user_to_page, scene.page_mm, {}, scene, options, scene.has_page)
    if not options.image.is_on:
        options = replace(options, image=NO_IMAGE)
    document = read_tree(data, source)
    report(2, _STEPS)
    scene = read_scene(document, options, folder_of(svg) if isinstance(svg, Path) else None)
    report(3, _STEPS)
    drawn, left_out = outlines(scene, options)
    skipped = dict(sorted((scene.skipped + left_out).items()))
    if not drawn and not any(shape.pixels for shape in scene.shapes):
        raise DrawingError(source, _nothing_drawable(document, skipped))
    report(_STEPS, _STEPS)
    return Drawing(source, drawn, scene.user_to_page, scene.page_mm, skipped, scene, options, scene.has_page)


def _nothing_drawable(document: Document, skipped: Mapping[str, int]) -> str:
    n_shapes = sum(element.tag in SHAPES for element in document.root.descendants())
    shapes = counted(n_shapes, "shape") if n_shapes else "no shapes"
    seen = shapes if n_shapes == 0 else f"{shapes}, none of them visible and of any size"
    advice = [what for kind, what in _ADVICE.items() if kind in skipped]
    advice += [_OTHER_IMAGES] if any(kind.startswith("image ") for kind in skipped) else []
    if BEYOND_THE_PAGE in skipped:
        advice.append("all of it is beyond the page: draw it with --crop none, or give the page another viewBox")
    if not advice:
        advice = ["draw lines or shapes" if n_shapes == 0 else "give its shapes a size, and a fill or a stroke"]
    left_out = "; skipped: " + ", ".join(f"{n} {kind}" for kind, n in skipped.items()) if skipped else ""
    return f"nothing to draw: it has {seen}{left_out} ({'; '.join(advice)})"
