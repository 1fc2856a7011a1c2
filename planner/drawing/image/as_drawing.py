"""A picture that is the drawing itself, on a page of its own."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np

from planner.arrays import frozen
from planner.drawing.image_options import ImageStyle
from planner.drawing.options import ReadingOptions
from planner.drawing.raster import RasterError, read_raster
from planner.drawing.scene.shape import Pixels, Scene, Shape
from planner.drawing.shapes import rectangle
from planner.errors import DrawingError

USUAL_STYLE = ImageStyle.HATCH
"""Of a picture that nobody says anything about."""
MM_PER_INCH = 25.4


def with_a_style(options: ReadingOptions) -> ReadingOptions:
    """The same, with the usual style where there is none."""
    return options if options.image.is_on else replace(options, image=replace(options.image, style=USUAL_STYLE))


def picture_scene(data: bytes, source: str, options: ReadingOptions) -> Scene:
    """A page as large as its picture, by the resolution that the file tells; without one, it has no size of its own.
    Errors: DrawingError."""
    try:
        raster = read_raster(data)
    except RasterError as error:
        raise DrawingError(source, f"a picture, but {error}") from None
    if raster.is_blank:
        raise DrawingError(source, "nothing to draw: the picture is all white")
    rows, columns = raster.darkness.shape
    across, down = raster.dpi or (options.dpi, options.dpi)
    page_mm = (MM_PER_INCH * raster.size_px[0] / across, MM_PER_INCH * raster.size_px[1] / down)
    to_user = np.array([[raster.size_px[0] / columns, 0.0, 0.0], [0.0, raster.size_px[1] / rows, 0.0]])
    to_page = np.array([[MM_PER_INCH / across, 0.0, 0.0], [0.0, MM_PER_INCH / down, 0.0]])
    frame = rectangle(0.0, 0.0, float(raster.size_px[0]), float(raster.size_px[1]))
    shape = Shape((frame,), (), None, False, None, (), "", Pixels(raster.darkness, to_user))
    return Scene((shape,), frozen(to_page), page_mm, Counter(), raster.dpi is not None)
