"""The lines that a pen draws as the joints move, and the same as an SVG."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import IO, cast

import numpy as np

from hardware.motion.tip import tips_mm
from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.files import written_aside

_GIVES = 0.9
_MARGIN_MM = 5.0
_PEN_MM = 0.4


def drawn_lines(arm: Arm, positions: FloatArray, heights_mm: FloatArray | float = 0.0) -> list[FloatArray]:
    """Lines (n, 2) in arm millimetres that the pen leaves as the joints go through `positions` (n, n_joints).
    heights_mm: (n,), how much further its tip sticks out than that of the pen in the arm's file.

    Pens give a little: one draws from just below the clearance on. There a planned tip moves straight up or down, and a
    real one may be a little off. A tap is a line of points on one spot.
    """
    tip_mm = tips_mm(arm, positions, heights_mm)
    down = np.concatenate(([False], is_drawing(arm, tip_mm[:, 2]), [False]))
    begins, ends = np.flatnonzero(down[1:] & ~down[:-1]), np.flatnonzero(down[:-1] & ~down[1:])
    return [tip_mm[begin:end, :2] for begin, end in zip(begins, ends, strict=True)]


def is_drawing(arm: Arm, heights_mm: FloatArray) -> BoolArray:
    """(n,) whether the pen leaves ink with its tip at `heights_mm` (n,) above the paper."""
    drawing: BoolArray = heights_mm <= _GIVES * arm.pen.clearance_mm
    return drawing


def write_svg(lines: Sequence[FloatArray], target: Path) -> None:
    """The lines at their true size, as seen from behind the base of the arm. Errors: OutputError."""
    seen = [-line[:, ::-1] for line in lines]  # arm x goes up the page and arm y to the left
    everything = np.concatenate([*seen, np.zeros((0 if seen else 1, 2))])
    (left, top), (width, height) = everything.min(axis=0) - _MARGIN_MM, np.ptp(everything, axis=0) + 2 * _MARGIN_MM
    with written_aside(target) as opened:
        file = cast("IO[str]", opened)
        file.write(
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.3f}mm" height="{height:.3f}mm" '
            f'viewBox="{left:.3f} {top:.3f} {width:.3f} {height:.3f}">\n'
            f'<g fill="none" stroke="black" stroke-width="{_PEN_MM}" stroke-linecap="round" '
            'stroke-linejoin="round">\n'
        )
        for line in seen:
            points = " ".join(f"{x:.4f},{y:.4f}" for x, y in line.tolist())
            file.write(f'<polyline points="{points}"/>\n')
        file.write("</g>\n</svg>\n")
