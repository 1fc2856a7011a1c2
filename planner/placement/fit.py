"""Where on the paper a drawing goes: from SVG user units to arm millimetres."""

from __future__ import annotations

import numpy as np

from planner.affine import compose
from planner.arrays import FloatArray
from planner.errors import DoesNotFit, UsageError
from planner.workspace.canvas import Canvas


def fit_to_canvas(
    low_mm: FloatArray, high_mm: FloatArray, canvas: Canvas, *, margin_mm: float, scale: bool, may_exceed: bool = False
) -> FloatArray:
    """(2, 3) affine from the page, turned as it will be drawn, to arm millimetres.

    low_mm, high_mm: corners of the drawing's extent on that page. Centred on the canvas; scaled uniformly
    to fill it but for the margin, or kept at its size. Errors: UsageError where the margin leaves no
    room, DoesNotFit where a drawing kept at its size is too large, unless it may exceed the canvas.
    """
    size = high_mm - low_mm
    room = np.array([canvas.width_mm, canvas.height_mm]) - 2 * margin_mm
    if (room <= 0).any():
        raise UsageError(
            f"a margin of {margin_mm:g} mm leaves nothing of the canvas of"
            f" {canvas.width_mm:.1f} x {canvas.height_mm:.1f} mm"
        )
    factor = 1.0
    if scale:
        with np.errstate(divide="ignore", over="ignore"):
            factor = float(np.min(room / size))
        if not np.isfinite(factor):
            factor = 1.0  # a single dot has no size to scale
    elif not may_exceed and (size > room + 1e-9).any():
        raise DoesNotFit(
            f"the drawing is {size[0]:.1f} x {size[1]:.1f} mm, the canvas within its margin"
            f" {room[0]:.1f} x {room[1]:.1f} mm: use --fit, a smaller --margin, --rotate or"
            " --skip-unreachable"
        )
    centre = (low_mm + high_mm) / 2
    to_canvas = np.array(
        [
            [factor, 0.0, canvas.width_mm / 2 - factor * centre[0]],
            [0.0, factor, canvas.height_mm / 2 - factor * centre[1]],
        ]
    )
    to_arm = np.array([[0.0, -1.0, canvas.far_mm], [-1.0, 0.0, canvas.left_mm]])
    return compose(to_arm, to_canvas)
