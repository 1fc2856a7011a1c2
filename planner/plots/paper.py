"""The paper in front of an arm, as seen by a person sitting behind it, on the side of its base: the base at the
bottom, arm x up the picture and arm y to the left. So seated, a drawing reads as it does on a screen.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon, Wedge
from matplotlib.ticker import MultipleLocator

from planner.arrays import FloatArray
from planner.plots.look import INK


def view_mm(points: Sequence[FloatArray], reach_mm: tuple[float, float] | None) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest arm x and y (2,) to show: all points (n, 2), the base and the half ring, and a margin."""
    ring = [] if reach_mm is None else [np.array([[0.0, -reach_mm[1]], [reach_mm[1], reach_mm[1]]])]
    everything = np.concatenate([*points, *ring, np.zeros((1, 2))])
    low, high = np.nanmin(everything, axis=0), np.nanmax(everything, axis=0)
    margin = max(0.03 * float((high - low).max()), 5.0)
    return low - margin, high + margin


def place_axes(axes: Axes, low: FloatArray, high: FloatArray) -> None:
    """Axes as seen from behind the base, with the base marked: arm y grows to the left, arm x upwards."""
    axes.set_xlim(high[1], low[1])
    axes.set_ylim(low[0], high[0])
    axes.set_aspect("equal", adjustable="box")
    tick_mm = _tick_mm(float(high[1] - low[1]))
    axes.xaxis.set_major_locator(MultipleLocator(tick_mm))
    axes.yaxis.set_major_locator(MultipleLocator(tick_mm))
    axes.set_xlabel("arm y (mm)")
    axes.set_ylabel("arm x (mm)")
    axes.plot(0.0, 0.0, linestyle="none", marker="^", markersize=8, color=INK, zorder=4, label="base of the arm")


def half_ring(reach_mm: tuple[float, float], *, face: str = "#F1F1EE") -> Wedge:
    """What the pen reaches in front of the base, between two radii."""
    inner, outer = reach_mm
    return Wedge((0.0, 0.0), outer, 0.0, 180.0, width=outer - inner, facecolor=face, edgecolor="#B5B5AE",
                 linewidth=0.6, zorder=0, label="reach of the pen")


def canvas_outline(corners_mm: FloatArray, *, face: str = "white", edge: str = "#777777") -> Polygon:
    """The canvas from its corners (4, 2) in arm coordinates."""
    return Polygon(corners_mm[:, ::-1], closed=True, facecolor=face, edgecolor=edge, linewidth=0.7, zorder=1,
                   label="canvas")


def _tick_mm(width_mm: float) -> float:
    """1, 2 or 5 times a power of ten that divides the width into about ten."""
    decade: float = 10.0 ** np.floor(np.log10(width_mm / 10))
    return decade * min((1, 2, 5, 10), key=lambda step: abs(np.log(step * decade * 10 / width_mm)))
