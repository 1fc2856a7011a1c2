"""The ink that each pen leaves: in its colour, and as wide as it draws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.counted import metres
from planner.pens import hex_of
from planner.plots.samples import joined_while_drawing
from planner.stroke_figures import TAP_EXTENT_MM, stroke_figures
from planner.trajectory import TRAVELLING, Trajectory

USUAL_WIDTH_MM = 0.4
"""Of a pen whose width nobody said: a fineliner's."""
_UNNAMED_COLOUR = "#1A1A1A"
_CELL_MM = 2.0
_APART = 0.5
"""How much of the distance between lines a line fills at most, where its width is not known."""


@dataclass(frozen=True, eq=False, slots=True)
class Ink:
    """What one pen draws. name: "" where nobody speaks of pens. lines: (n, 2) each, taps: (k, 2) where it only touches
    the paper, in the coordinates of the places that they are made of. drawn_mm: of both. is_thinned: shown thinner than
    a usual pen draws, so that lines can be told apart."""

    name: str
    colour: str
    width_mm: float
    lines: Sequence[FloatArray]
    taps: FloatArray
    drawn_mm: float
    is_thinned: bool

    @property
    def label(self) -> str:
        """For a legend."""
        return f"{self.name}, {metres(self.drawn_mm)}" if self.name else "drawn"


def inks_of(trajectory: Trajectory, places: FloatArray) -> list[Ink]:
    """The ink of each pen, in their order. places: (n_samples, 2) of the tip, mm."""
    which, usual_mm = trajectory.pen_of_stroke, usual_width_mm(trajectory, places)
    strokes = stroke_figures(trajectory, places)
    pens = [(pen.name, hex_of(pen.colour), pen.width_mm) for pen in trajectory.pens] or [("", _UNNAMED_COLOUR, 0.0)]
    return [
        Ink(
            name,
            colour,
            width_mm or usual_mm,
            *_lines_and_taps(trajectory, places, np.flatnonzero(which == index)),
            drawn_mm=float(strokes.length_mm[which[strokes.index] == index].sum()),
            is_thinned=not width_mm and usual_mm < USUAL_WIDTH_MM,
        )
        for index, (name, colour, width_mm) in enumerate(pens)
    ]


def thinned(inks: Sequence[Ink]) -> str:
    """What is to be said of lines that are shown thinner than a pen draws them, or nothing."""
    widths = [ink.width_mm for ink in inks if ink.is_thinned]
    if not widths:
        return ""
    return f"; lines {widths[0]:.2f} mm wide, to tell them apart: a pen of {USUAL_WIDTH_MM:g} mm fills the gaps"


def usual_width_mm(trajectory: Trajectory, places: FloatArray) -> float:
    """How wide lines are shown whose width nobody said: as a usual pen draws them, or half as wide as they lie apart
    where half of their length lies closer than that, so that a dense drawing shows its tones."""
    steps_mm = np.linalg.norm(np.diff(places, axis=0), axis=1)[joined_while_drawing(trajectory)]
    if not len(steps_mm):
        return USUAL_WIDTH_MM
    ends = places[1:][joined_while_drawing(trajectory)]
    cells = np.floor((ends - ends.min(axis=0)) / _CELL_MM).astype(np.int64)
    cell = np.unique(cells[:, 0] * (cells[:, 1].max() + 1) + cells[:, 1], return_inverse=True)[1]
    length_mm = np.bincount(cell, weights=steps_mm)
    apart_mm = _CELL_MM**2 / np.maximum(length_mm, 1e-9)
    closest = np.argsort(apart_mm)
    half = np.searchsorted(np.cumsum(length_mm[closest]), length_mm.sum() / 2)
    return min(USUAL_WIDTH_MM, _APART * float(apart_mm[closest][min(int(half), len(closest) - 1)]))


def _lines_and_taps(trajectory: Trajectory, places: FloatArray, drawn: IntArray) -> tuple[list[FloatArray], FloatArray]:
    """The strokes of one pen."""
    stroke = trajectory.stroke
    is_own = (stroke != TRAVELLING) & np.isin(stroke, drawn)
    joined = joined_while_drawing(trajectory)
    begins = np.flatnonzero(is_own & ~np.concatenate(([False], joined)))
    ends = np.flatnonzero(is_own & ~np.concatenate((joined, [False])))
    pieces = [places[begin : end + 1] for begin, end in zip(begins.tolist(), ends.tolist(), strict=True)]
    is_line = [float(np.ptp(piece, axis=0).max()) > TAP_EXTENT_MM for piece in pieces]
    lines = [piece for piece, line in zip(pieces, is_line, strict=True) if line]
    taps = [piece[0] for piece, line in zip(pieces, is_line, strict=True) if not line]
    return lines, np.reshape(taps, (-1, 2))
