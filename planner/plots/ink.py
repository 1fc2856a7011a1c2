"""The sheet as it will look: ink in its colours and as wide as the pens draw, on paper with rulers along its edges."""

from __future__ import annotations

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import MultipleLocator

from planner.arrays import FloatArray, IntArray
from planner.counted import counted
from planner.pens import hex_of
from planner.plots.look import USUAL, Look
from planner.plots.paper import PAPER_BOTTOM, PAPER_LEFT, PAPER_RIGHT, round_step
from planner.plots.samples import TAP_EXTENT_MM, joined_while_drawing
from planner.plots.sheet import Sheet
from planner.trajectory import TRAVELLING, Trajectory

_USUAL_WIDTH_MM = 0.4
"""Of a pen whose width nobody said: a fineliner's."""
_MARGIN_MM = 5.0
_PAPER, _EDGE = "#FFFEFA", "#B9B4A6"
_PT_PER_IN = 72.0
_TICK_EM = 5.0


def plot_sheet(trajectory: Trajectory, tip_mm: FloatArray, look: Look = USUAL) -> Figure:
    """What will be on the paper, seen from behind the arm; mm from the left and the near edge of the paper.

    tip_mm: (n_samples, 2 or more) x, y of the tip. The paper is what the header tells, or else what the ink needs.
    """
    xy = np.asarray(tip_mm, dtype=np.float64)[:, :2]
    near, far, right, left = _paper(trajectory, xy)
    across, up = left - xy[:, 1], xy[:, 0] - near  # arm y grows to the left
    width_mm, height_mm = left - right, far - near
    with look.style():
        sheet = Sheet(look)
        width_em = sheet.width - PAPER_LEFT - PAPER_RIGHT
        mm_per_em = (width_mm + 2 * _MARGIN_MM) / width_em
        height_em = (height_mm + 2 * _MARGIN_MM) / mm_per_em
        axes = sheet.panel(PAPER_LEFT, PAPER_BOTTOM, width_em, height_em)
        axes.set_xlim(-_MARGIN_MM, width_mm + _MARGIN_MM)
        axes.set_ylim(-_MARGIN_MM, height_mm + _MARGIN_MM)
        axes.set_aspect("equal", adjustable="box")
        axes.add_patch(
            Rectangle((0, 0), width_mm, height_mm, facecolor=_PAPER, edgecolor=_EDGE, linewidth=0.8, zorder=0)
        )
        tick_mm = round_step((width_mm + 2 * _MARGIN_MM) / max(width_em / _TICK_EM, 3.5))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MultipleLocator(tick_mm))
            axis.set_minor_locator(MultipleLocator(tick_mm / 5))
        axes.set_xlabel("from the left edge (mm)")
        axes.set_ylabel("from the near edge (mm)")
        pt_per_mm = look.em_in * _PT_PER_IN / mm_per_em
        places = np.column_stack((across, up))
        legend = []
        for name, colour, pen_mm, drawn in _pens(trajectory):
            lines, taps = _lines_and_taps(trajectory, places, drawn)
            ink = LineCollection(lines, color=colour, linewidth=pen_mm * pt_per_mm, capstyle="round", zorder=2)
            axes.add_collection(ink)
            sizes = np.full(len(taps), pen_mm)
            dots = EllipseCollection(sizes, sizes, 0.0, units="xy", offsets=taps, offset_transform=axes.transData)
            dots.set(facecolor=colour, edgecolor="none", zorder=2)
            axes.add_collection(dots)
            if name:
                legend.append(Line2D([], [], color=colour, linewidth=3.0, label=name))
        n_strokes = int(trajectory.stroke.max(initial=-1)) + 1
        remark = f"{counted(n_strokes, 'stroke')} on {width_mm:.0f} x {height_mm:.0f} mm, as seen from behind the arm"
        return sheet.finish(trajectory.drawing or "trajectory", remark, legend)


def _paper(trajectory: Trajectory, xy: FloatArray) -> tuple[float, float, float, float]:
    """Near, far, right and left side."""
    if trajectory.placement.canvas_mm is not None:
        return trajectory.placement.canvas_mm
    ink = xy[trajectory.pen] if trajectory.pen.any() else xy
    (near, right), (far, left) = ink.min(axis=0) - _MARGIN_MM, ink.max(axis=0) + _MARGIN_MM
    return float(near), float(far), float(right), float(left)


def _pens(trajectory: Trajectory) -> list[tuple[str, str, float, IntArray]]:
    """Name, colour, width in mm, and the strokes of each pen."""
    which = trajectory.pen_of_stroke
    if not trajectory.pens:
        return [("", "#1A1A1A", _USUAL_WIDTH_MM, np.arange(len(which)))]
    return [
        (
            pen.name,
            hex_of(pen.colour),
            pen.width_mm or _USUAL_WIDTH_MM,
            np.flatnonzero(which == index),
        )
        for index, pen in enumerate(trajectory.pens)
    ]


def _lines_and_taps(trajectory: Trajectory, places: FloatArray, drawn: IntArray) -> tuple[list[FloatArray], FloatArray]:
    """The strokes of one pen: lines (n, 2), and the places (k, 2) where it only touches the paper."""
    stroke = trajectory.stroke
    is_own = (stroke != TRAVELLING) & np.isin(stroke, drawn)
    joined = joined_while_drawing(trajectory)
    begins = np.flatnonzero(is_own & ~np.concatenate(([False], joined)))
    ends = np.flatnonzero(is_own & ~np.concatenate((joined, [False])))
    pieces = [places[begin : end + 1] for begin, end in zip(begins.tolist(), ends.tolist(), strict=True)]
    lines = [piece for piece in pieces if np.ptp(piece, axis=0).max() > TAP_EXTENT_MM]
    taps = [piece[0] for piece in pieces if np.ptp(piece, axis=0).max() <= TAP_EXTENT_MM]
    return lines, np.reshape(taps, (-1, 2))
