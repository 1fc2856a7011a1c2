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
_LENGTH_MM = 5.0
_WAYS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


def pattern(columns: int = 10, rows: int = 5, spacing_mm: float = 20.0, x_mm: float = 60.0) -> list[Mark]:
    """Marks in rows across, each the end of a stroke, which come from all sides."""
    marks: list[Mark] = []
    for x in x_mm + spacing_mm * np.arange(rows):
        for y in spacing_mm * (np.arange(columns) - (columns - 1) / 2):
            place = np.array([x, y])
            x0, y0 = place - _LENGTH_MM * np.array(_WAYS[len(marks) % len(_WAYS)])
            marks.append(Mark(len(marks), float(len(marks)), (x, y), TouchDown((x0, y0), (x, y), SLOPE)))
    return marks


@dataclass(frozen=True, eq=False)
class Drawn:
    """places_mm (n, 2), heights_mm (n,): where the marks came, and how high the tip was at them."""

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
    """Marks 4 to 8 mm off by a smooth warp, and a scatter beside it; strokes of 0.4 mm with blots of 0.6 to 1 mm, from
    which the lifted pen drags ink some way on.

    without: marks that left no ink. dirt: specks on the paper.
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
    late = np.minimum(rng.normal(0, height_sd_mm, len(marks)) / SLOPE, _LENGTH_MM - 1.0)
    ink = []
    for mark, place, each in zip(marks, meant + off, late, strict=True):
        if mark.number in without:
            continue
        if mark.touch_down:
            along = np.subtract(mark.touch_down.end_mm, mark.touch_down.start_mm) / _LENGTH_MM
            begin = place - (_LENGTH_MM - each) * along
            ink.append(Ink(np.array([begin, place, place + rng.uniform(0.3, 2.0) * along]), 0.4, colour))
        ink.append(Ink(place[None], rng.uniform(0.6, 1.0), colour))
    low, high = meant.min(axis=0) - 8, meant.max(axis=0) + 8
    ink += [Ink(rng.uniform(low, high)[None], rng.uniform(0.1, 0.3), (0.4, 0.35, 0.3)) for _ in range(dirt)]
    return Drawn(marks, layout, meant + off, -SLOPE * (_LENGTH_MM - late), ink, pdf)
