"""The picture of what was drawn beside what was wanted, on the paper in front of the arm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.arrays import FloatArray
from planner.plots.look import USUAL, Look
from planner.plots.paper import PAPER_BOTTOM, PAPER_LEFT, PAPER_RIGHT, place_axes
from planner.plots.paper_extent import view_mm
from planner.plots.sheet import Sheet

_TAP_MM = 0.02
_LOWEST, _TITLE = 10.0, 2.0  # em


def plot_drawing_error(
    wanted: Sequence[FloatArray], drawn: Sequence[FloatArray], heading: str, remark: str, look: Look = USUAL
) -> Figure:
    """Lines (n, 2) in arm millimetres: on the left those wanted, on the right those drawn over those wanted."""
    low, high = view_mm([*wanted, *drawn], None, None)
    colours = look.colours
    layers = [
        ("wanted", [("wanted", wanted, colours.wanted, 1.0)]),
        ("drawn, over wanted", [("wanted", wanted, colours.wanted, 1.6), ("drawn", drawn, colours.drawn, 0.5)]),
    ]
    with look.style():
        sheet = Sheet(look)
        width = (sheet.width - 2 * PAPER_LEFT - 2 * PAPER_RIGHT) / 2
        height = float(np.clip((high[0] - low[0]) * width / (high[1] - low[1]), _LOWEST, 1.25 * sheet.width))
        for number, (title, lines_of) in enumerate(layers):
            axes = sheet.panel(PAPER_LEFT + number * (width + PAPER_LEFT + PAPER_RIGHT), PAPER_BOTTOM, width, height)
            place_axes(axes, low, high, width, colours, None)
            axes.set_title(title, loc="left")
            for label, lines, color, thickness in lines_of:
                draw_lines(axes, lines, label, color, thickness)
        return sheet.finish(heading, remark, room=_TITLE)


def draw_lines(axes: Axes, lines: Sequence[FloatArray], label: str, color: str, width: float) -> None:
    """Lines (n, 2) in arm millimetres, and taps as dots, on axes as seen from behind the base."""
    gap = np.full((1, 2), np.nan)
    is_tap = [np.ptp(line, axis=0).max() <= _TAP_MM for line in lines]
    joined = np.concatenate([gap, *(part for line in lines for part in (line, gap))])
    axes.plot(joined[:, 1], joined[:, 0], color=color, linewidth=width, label=label, zorder=2)
    taps = np.concatenate([gap, *(line[:1] for line, tap in zip(lines, is_tap, strict=True) if tap)])
    axes.plot(
        taps[:, 1],
        taps[:, 0],
        linestyle="none",
        marker="o",
        markersize=3 * width,
        markeredgewidth=0,
        color=color,
        zorder=2,
    )
