"""The sheet as it will look: ink in its colours and as wide as the pens draw, on paper with rulers along its edges."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MultipleLocator

from planner.arrays import FloatArray
from planner.counted import counted
from planner.plots.ink import inks_of, thinned
from planner.plots.inked import draw_inks, legend_of
from planner.plots.look import USUAL, Look
from planner.plots.paper import PAPER_BOTTOM, PAPER_LEFT, PAPER_RIGHT, round_step
from planner.plots.paper_extent import paper_sides_mm
from planner.plots.sheet import Sheet
from planner.trajectory import Trajectory

_MARGIN_MM = 5.0
_PT_PER_IN = 72.0
_TICK_EM = 5.0
_HIGHEST = 1.1
"""Of the width of the figure."""


def plot_sheet(trajectory: Trajectory, tip_mm: FloatArray, look: Look = USUAL) -> Figure:
    """What will be on the paper, seen from behind the arm; mm from the left and the near edge of the paper.

    tip_mm: (n_samples, 2 or more) x, y of the tip. The paper is what the header tells, or else what the ink needs.
    """
    xy = np.asarray(tip_mm, dtype=np.float64)[:, :2]
    near, far, right, left = paper_sides_mm(trajectory, xy)
    width_mm, height_mm = left - right, far - near
    inks = inks_of(trajectory, np.column_stack((left - xy[:, 1], xy[:, 0] - near)))  # arm y grows to the left
    with look.style():
        sheet = Sheet(look)
        widest_em = sheet.width - PAPER_LEFT - PAPER_RIGHT
        mm_per_em = max(
            (width_mm + 2 * _MARGIN_MM) / widest_em, (height_mm + 2 * _MARGIN_MM) / (_HIGHEST * sheet.width)
        )
        width_em, height_em = ((side + 2 * _MARGIN_MM) / mm_per_em for side in (width_mm, height_mm))
        axes = sheet.panel(PAPER_LEFT, PAPER_BOTTOM, width_em, height_em)
        axes.set_xlim(-_MARGIN_MM, width_mm + _MARGIN_MM)
        axes.set_ylim(-_MARGIN_MM, height_mm + _MARGIN_MM)
        axes.set_aspect("equal", adjustable="box")
        colours = look.colours
        axes.add_patch(
            Rectangle(
                (0, 0),
                width_mm,
                height_mm,
                facecolor=colours.paper,
                edgecolor=colours.paper_edge,
                linewidth=0.8,
                zorder=0,
            )
        )
        tick_mm = round_step((width_mm + 2 * _MARGIN_MM) / max(width_em / _TICK_EM, 3.5))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MultipleLocator(tick_mm))
            axis.set_minor_locator(MultipleLocator(tick_mm / 5))
        axes.set_xlabel("mm from the left edge of the paper")
        axes.set_ylabel("mm from its near edge")
        draw_inks(axes, inks, look.em_in * _PT_PER_IN / mm_per_em)
        n_strokes = int(trajectory.stroke.max(initial=-1)) + 1
        remark = (
            f"{counted(n_strokes, 'stroke')} on {width_mm:.0f} x {height_mm:.0f} mm, as seen from behind the arm"
            + thinned(inks)
        )
        legend = legend_of(inks, look) if trajectory.pens else []
        return sheet.finish(trajectory.title, remark, legend)
