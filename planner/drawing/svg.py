"""From an SVG file to a Drawing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from planner.arrays import FloatArray, frozen
from planner.drawing.drawing import Drawing
from planner.drawing.normalised import LARGEST_COORDINATE, read_normalised
from planner.drawing.rewrite import rewrite
from planner.drawing.source import Survey, read_source, survey
from planner.drawing.usvg import NormalisationFailed, normalise
from planner.errors import DrawingError

MM_PER_PX = 25.4 / 96.0
_SMALLEST_PAGE, _LARGEST_PAGE = 1e-6, LARGEST_COORDINATE


def read_drawing(path: Path) -> Drawing:
    """All visible outlines of the SVG file `path`, gzipped or not, with the page they are on.

    Only that one file is ever read. Raises DrawingError for a file that is missing, not an SVG, unsafe or beyond the
    limits of size, and for a drawing in which there is nothing to draw.
    """
    source = path.name
    data = read_source(path)
    found = survey(data, source)
    rewritten, unusable = rewrite(data, found, source)
    try:
        normalised = read_normalised(normalise(rewritten), source)
    except NormalisationFailed as failure:
        raise DrawingError(source, failure.reason) from None
    skipped = dict(sorted((unusable + normalised.skipped).items()))
    if not normalised.outlines:
        raise DrawingError(source, _nothing_drawable(found, skipped))
    try:
        user_to_page, page_mm = _page(normalised.root, found.root)
    except ValueError as error:
        raise DrawingError(source, str(error)) from None
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
        raise ValueError(f"its width, height or viewBox is beyond {_SMALLEST_PAGE:g} to {_LARGEST_PAGE:g}"
                         " (give it the size of a page)")
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
    shapes = "no shapes" if found.n_shapes == 0 else "1 shape" if found.n_shapes == 1 else f"{found.n_shapes} shapes"
    seen = shapes if found.n_shapes == 0 else f"{shapes}, none of them visible and of any size"
    counts = Counter(skipped)
    if not counts:
        return f"nothing to draw: it has {seen}"
    return f"nothing to draw: it has {seen}; skipped: " + ", ".join(f"{n} {kind}" for kind, n in counts.items())
