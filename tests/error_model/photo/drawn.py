"""A calibration pattern, and how an arm that was never calibrated draws it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from planner.error_model.sheet.layout import PaperSize, SheetLayout
from planner.error_model.sheet.marks import Mark, TouchDown
from planner.error_model.sheet.pdf import write_sheet
from tests.error_model.photo.rendering import BLACK_INK, Floats, Ink, Sheet, drawn_sheet

SLOPE = 0.7
_LINE_MM = np.array([[-3.0, -6.0], [7.0, -6.0]])


def pattern(columns: int = 10, rows: int = 5, spacing_mm: float = 20.0, x_mm: float = 60.0) -> list[Mark]:
    """Marks in rows across, each with a touch-down line to its right."""
    marks: list[Mark] = []
    for x in x_mm + spacing_mm * np.arange(rows):
        for y in spacing_mm * (np.arange(columns) - (columns - 1) / 2):
            (x0, y0), (x1, y1) = _LINE_MM + np.array([x, y])
            marks.append(Mark(len(marks), float(len(marks)), (x, y), TouchDown((x0, y0), (x1, y1), SLOPE)))
    return marks


@dataclass(frozen=True, eq=False)
class Drawn:
    """places_mm (n, 2), heights_mm (n,): where the marks came, and how high the tip was."""

    marks: Sequence[Mark]
    layout: SheetLayout
    places_mm: Floats
    heights_mm: Floats
    ink: list[Ink]
    pdf: Path

    def sheet(self, printed_at: float = 1.0) -> Sheet:
        return drawn_sheet(self.pdf, self.layout.origin_page_mm, self.ink, printed_at=printed_at)


def draw(
    folder: Path,
    marks: Sequence[Mark],
    seed: int,
    *,
    scatter_mm: float = 0.7,
    height_sd_mm: float = 1.5,
    colour: tuple[float, float, float] = BLACK_INK,
    without: Sequence[int] = (),
    dirt: int = 0,
    size: PaperSize = PaperSize.A4,
) -> Drawn:
    """Marks 4 to 8 mm off by a smooth warp, and a scatter beside it; dots of 0.4 to 1 mm and lines of 0.4 mm.

    without: marks that left no dot. dirt: specks on the paper.
    """
    rng = np.random.default_rng(seed)
    pdf = folder / f"sheet{seed}.pdf"
    layout = write_sheet(pdf, "drawing_arm_2022", marks, size)
    meant = np.array([mark.place_mm for mark in marks])
    x, y = ((meant - meant.mean(axis=0)) / np.ptp(meant, axis=0).max() * 2).T
    angle = rng.uniform(0, 2 * np.pi)
    off = rng.uniform(3, 5) * np.array([np.cos(angle), np.sin(angle)])
    off = off + np.column_stack((x, y)) @ rng.normal(0, 1.2, (2, 2))
    off += np.column_stack((x * x, x * y, y * y)) @ rng.normal(0, 0.6, (3, 2)) + rng.normal(0, scatter_mm, meant.shape)
    off *= np.minimum(1.0, 8.0 / np.linalg.norm(off, axis=1, keepdims=True))
    heights = rng.normal(0, height_sd_mm, len(marks))
    ink = []
    for mark, away, height in zip(marks, off, heights, strict=True):
        if mark.number not in without:
            ink.append(Ink(np.array([mark.place_mm]) + away, rng.uniform(0.4, 1.0), colour))
        if mark.touch_down:
            start, end = np.array([mark.touch_down.start_mm, mark.touch_down.end_mm]) + away
            along = (end - start) / np.linalg.norm(end - start)
            late = height / mark.touch_down.slope
            if late < np.linalg.norm(end - start):
                ink.append(Ink(np.array([start + late * along, end]), 0.4, colour))
    low, high = meant.min(axis=0) - 8, meant.max(axis=0) + 8
    ink += [Ink(rng.uniform(low, high)[None], rng.uniform(0.1, 0.3), (0.4, 0.35, 0.3)) for _ in range(dirt)]
    return Drawn(marks, layout, meant + off, heights, ink, pdf)
