"""What a few lines of SVG come to."""

from __future__ import annotations

import numpy as np

from planner.drawing.drawing import Drawing
from planner.drawing.flatten import flatten_all
from planner.drawing.options import ReadingOptions
from planner.drawing.scene.scene import read_scene
from planner.drawing.scene.shape import Scene
from planner.drawing.source import SvgInMemory
from planner.drawing.svg import read_drawing
from planner.drawing.xml_tree import read_tree

SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" {}>{}</svg>'
WHOLE = ReadingOptions(crop="none")
_IDENTITY = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
Line = list[tuple[float, float]]


def scene(body: str, root: str = 'viewBox="0 0 100 100"', options: ReadingOptions = WHOLE) -> Scene:
    return read_scene(read_tree(SVG.format(root, body).encode(), "drawing.svg"), options)


def drawing(body: str, root: str = 'viewBox="0 0 100 100"', options: ReadingOptions = WHOLE) -> Drawing:
    return read_drawing(SvgInMemory("drawing.svg", SVG.format(root, body).encode()), options=options)


def lines(body: str, root: str = 'viewBox="0 0 100 100"') -> list[Line]:
    """The polylines of all outlines in user units, rounded, corners on straight lines left out."""
    found = flatten_all(drawing(body, root).outlines, _IDENTITY, 1e-3)
    return [[(float(x), float(y)) for x, y in np.round(line, 5) + 0.0] for line in found]


def length(body: str) -> float:
    """Of all lines, in user units."""
    found = flatten_all(drawing(body).outlines, _IDENTITY, 1e-4)
    return float(sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in found))
