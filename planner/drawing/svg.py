"""From an SVG file to a Drawing."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from planner.arrays import FloatArray, frozen
from planner.counted import counted
from planner.drawing.drawing import Drawing
from planner.drawing.normalised import LARGEST_COORDINATE, read_normalised
from planner.drawing.rewrite import rewrite
from planner.drawing.source import DrawingSource, read_source
from planner.drawing.survey import Survey, survey
from planner.drawing.usvg import NormalisationFailed, normalise
from planner.errors import DrawingError

MM_PER_PX = 25.4 / 96.0
_STEPS = 4
_ADVICE = {
    "text": "convert text to paths (in Inkscape: Path, Object to Path)",
    "foreignObject": "convert embedded pages to paths, or export the drawing as plain SVG",
    "image": "trace pictures to paths (in Inkscape: Path, Trace Bitmap)",
    "path with unusable numbers": "bring the numbers of its paths and transforms below 1e9",
    "path with unreadable data": "mend the data of its paths, or export the drawing anew",
}
"""What to do about things that cannot be drawn, where there is nothing else."""
_SMALLEST_PAGE, _LARGEST_PAGE = 1e-6, LARGEST_COORDINATE


def read_drawing(svg: DrawingSource, report: Callable[[int, int], None] = lambda done, total: None) -> Drawing:
    """All visible outlines of an SVG, a file or in memory, gzipped or not, with the page they are on.

    Only that one file is ever read. `report` is told how much of the work is done, and how much there is. Raises
    DrawingError for a file that is missing, not an SVG, unsafe or beyond the
    limits of size, and for a drawing in which there is nothing to draw.
    """
    source = svg.name
    data = read_source(svg)
    found = survey(data, source)
    report(1, _STEPS)
    rewritten, unusable = rewrite(data, found, source)
    report(2, _STEPS)
    try:
        plain = normalise(rewritten)
        report(3, _STEPS)
        normalised = read_normalised(plain, source)
    except NormalisationFailed as failure:
        raise DrawingError(source, failure.reason) from None
    skipped = dict(sorted((unusable + normalised.skipped).items()))
    if not normalised.outlines:
        raise DrawingError(source, _nothing_drawable(found, skipped))
    try:
        user_to_page, page_mm = _page(normalised.root, found.root)
    except ValueError as error:
        raise DrawingError(source, str(error)) from None
    report(_STEPS, _STEPS)
    return Drawing(source, normalised.outlines, user_to_page, page_mm, skipped)


def _page(root: Mapping[str, str], original: Mapping[str, str]) -> tuple[FloatArray, tuple[float, float]]:
    """user_to_page (2, 3) and the size of the page, from the size and viewBox of the normalised root.

    CSS pixels are 1/96 inch. Of width and height, one that is missing follows from the other by the viewBox; without
    any size the page ends where the drawing does. Errors: ValueError where a number is no size or place on a page.
    """
    size = np.array([float(root["width"]), float(root["height"])])
    left, top, width, height = (float(value) for value in root["viewBox"].split())
    sizes = np.array([*size, width, height])
    if not ((sizes >= _SMALLEST_PAGE) & (sizes <= _LARGEST_PAGE)).all() or max(abs(left), abs(top)) > _LARGEST_PAGE:
        raise ValueError(
            f"its width, height or viewBox is beyond {_SMALLEST_PAGE:g} to {_LARGEST_PAGE:g}"
            " (give it the size of a page)"
        )
    if "viewBox" in original and ("width" in original) != ("height" in original):
        known = 0 if "width" in original else 1
        size[1 - known] = size[known] * (width, height)[1 - known] / (width, height)[known]
    scale = size / (width, height)
    align, _, fit = root.get("preserveAspectRatio", "xMidYMid").strip().partition(" ")
    shift = np.zeros(2)
    if align != "none":
        scale[:] = scale.max() if fit.strip() == "slice" else scale.min()
        fractions = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
        shift = (size - scale * (width, height)) * (fractions[align[1:4]], fractions[align[5:8]])
    offset = shift - scale * (left, top)
    user_to_page = MM_PER_PX * np.array([[scale[0], 0.0, offset[0]], [0.0, scale[1], offset[1]]])
    return frozen(user_to_page), (float(size[0] * MM_PER_PX), float(size[1] * MM_PER_PX))


def _nothing_drawable(found: Survey, skipped: Mapping[str, int]) -> str:
    shapes = counted(found.n_shapes, "shape") if found.n_shapes else "no shapes"
    seen = shapes if found.n_shapes == 0 else f"{shapes}, none of them visible and of any size"
    advice = [what for kind, what in _ADVICE.items() if kind in skipped]
    if not advice:
        advice = ["draw lines or shapes" if found.n_shapes == 0 else "give its shapes a size, and a fill or a stroke"]
    left_out = "; skipped: " + ", ".join(f"{n} {kind}" for kind, n in skipped.items()) if skipped else ""
    return f"nothing to draw: it has {seen}{left_out} ({'; '.join(advice)})"
