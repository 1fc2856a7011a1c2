"""The picture of what was drawn beside what was wanted, on the paper in front of the arm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.arrays import FloatArray
from planner.plots.look import BLUE, PALE_ORANGE, planner_style, set_title
from planner.plots.paper import place_axes, view_mm

_WIDTH_IN, _TOP_IN, _BOTTOM_IN, _LEFT_IN, _GAP_IN, _RIGHT_IN = 14.0, 0.95, 0.5, 0.6, 0.55, 0.25
_TAP_MM = 0.02


def plot_likeness(wanted: Sequence[FloatArray], drawn: Sequence[FloatArray], heading: str, remark: str) -> Figure:
    """Lines (n, 2) in arm millimetres: on the left those wanted, on the right those drawn over those wanted."""
    low, high = view_mm([*wanted, *drawn], None)
    panel_in = (_WIDTH_IN - _LEFT_IN - _GAP_IN - _RIGHT_IN) / 2
    paper_in = min(max((high[0] - low[0]) * panel_in / (high[1] - low[1]), 1.5), 12.0)
    height_in = _TOP_IN + paper_in + _BOTTOM_IN
    with planner_style():
        figure = Figure(figsize=(_WIDTH_IN, height_in))
        for number, (title, layers) in enumerate((
                ("wanted", [("wanted", wanted, PALE_ORANGE, 1.0)]),
                ("drawn, over wanted", [("wanted", wanted, PALE_ORANGE, 1.6), ("drawn", drawn, BLUE, 0.5)]))):
            axes = figure.add_axes(((_LEFT_IN + number * (panel_in + _GAP_IN)) / _WIDTH_IN, _BOTTOM_IN / height_in,
                                    panel_in / _WIDTH_IN, paper_in / height_in))
            place_axes(axes, low, high)
            axes.set_title(title, loc="left", fontsize=8.5)
            for label, lines, color, width in layers:
                _lines(axes, lines, label, color, width)
        set_title(figure, heading, remark, 0.2)
    return figure


def _lines(axes: Axes, lines: Sequence[FloatArray], label: str, color: str, width: float) -> None:
    gap = np.full((1, 2), np.nan)
    is_tap = [np.ptp(line, axis=0).max() <= _TAP_MM for line in lines]
    joined = np.concatenate([gap, *(part for line in lines for part in (line, gap))])
    axes.plot(joined[:, 1], joined[:, 0], color=color, linewidth=width, label=label, zorder=2)
    taps = np.concatenate([gap, *(line[:1] for line, tap in zip(lines, is_tap, strict=True) if tap)])
    axes.plot(taps[:, 1], taps[:, 0], linestyle="none", marker="o", markersize=3 * width, markeredgewidth=0,
              color=color, zorder=2)
