"""Pictures made by formulas, and the lines and the ink that come of them."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.spatial import cKDTree

from planner.arrays import FloatArray
from planner.drawing.flatten import flatten_all
from planner.drawing.image.lines import with_images
from planner.drawing.image_options import ImageOptions
from planner.drawing.options import ReadingOptions
from planner.drawing.source import SvgInMemory
from planner.drawing.svg import read_drawing

DPI = 127.0
PX_MM = 0.2

Grey = NDArray[np.uint8]


def file_of(picture: Image.Image | Grey, kind: str = "PNG", **how: object) -> bytes:
    file = io.BytesIO()
    (picture if isinstance(picture, Image.Image) else Image.fromarray(picture)).save(file, kind, **how)
    return file.getvalue()


def lines_of(picture: Image.Image | Grey, options: ImageOptions) -> list[FloatArray]:
    """(n, 2), mm on a page with five pixels to a mm; dots have one point."""
    source = SvgInMemory("picture.png", file_of(picture, dpi=(DPI, DPI)))
    drawing = read_drawing(source, options=ReadingOptions(image=options))
    return flatten_all(with_images(drawing, drawing.user_to_page).outlines, drawing.user_to_page, 0.002)


def covered(lines: list[FloatArray], places_mm: FloatArray, width_mm: float) -> NDArray[np.bool_]:
    """(n,) which places a pen of that width leaves ink on."""
    points = [line if len(line) == 1 else _dense(line, 0.03) for line in lines]
    distance, _ = cKDTree(np.concatenate(points)).query(places_mm, distance_upper_bound=width_mm)
    found: NDArray[np.bool_] = distance <= width_mm / 2.0
    return found


def _dense(line: FloatArray, step: float) -> FloatArray:
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    at = np.linspace(0.0, along[-1], int(along[-1] / step) + 2)
    return np.stack([np.interp(at, along, column) for column in line.T], axis=1)
