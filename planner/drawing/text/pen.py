"""The contours of a glyph."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from fontTools.pens.basePen import BasePen

from planner.arrays import frozen
from planner.drawing.subpath import Subpath

if TYPE_CHECKING:
    import uharfbuzz as hb

Point = tuple[float, float]


class _ContourPen(BasePen):  # type: ignore[misc]  # has no types
    """Gathers curves; BasePen makes cubics of quadratics."""

    def __init__(self) -> None:
        super().__init__(None)
        self.contours: list[Subpath] = []
        self._start: Point = (0.0, 0.0)
        self._here: Point = (0.0, 0.0)
        self._curves: list[tuple[Point, Point, Point, Point]] = []

    def _moveTo(self, pt: Point) -> None:
        self._start = self._here = pt

    def _lineTo(self, pt: Point) -> None:
        (x, y), (u, v) = self._here, pt
        first, second = (x + (u - x) / 3.0, y + (v - y) / 3.0), (u - (u - x) / 3.0, v - (v - y) / 3.0)
        self._curveToOne(first, second, pt)

    def _curveToOne(self, pt1: Point, pt2: Point, pt3: Point) -> None:
        self._curves.append((self._here, pt1, pt2, pt3))
        self._here = pt3

    def _closePath(self) -> None:
        if self._here != self._start:
            self._lineTo(self._start)
        if self._curves:
            beziers = np.array(self._curves, dtype=np.float64)
            self.contours.append(Subpath(frozen(beziers), True, np.ones(len(beziers), dtype=np.bool_)))
        self._curves = []


def contours(font: hb.Font, glyph: int) -> list[Subpath]:
    """Closed, in units of the font, y up."""
    pen = _ContourPen()
    font.draw_glyph_with_pen(glyph, pen)
    return pen.contours
