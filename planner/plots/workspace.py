"""The picture of an arm's workspace: over the paper, how freely the pen moves and how far it strays where
a joint is off, with the ring that it reaches and the canvas."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from planner.arms.paper_map import PaperMap
from planner.arrays import FloatArray
from planner.plots.look import planner_style, set_title
from planner.plots.paper import canvas_outline, half_ring, place_axes, view_mm

_WIDTH_IN, _TOP_IN, _BOTTOM_IN, _LEFT_IN, _GAP_IN, _BAR_IN = 8.0, 1.0, 0.5, 0.6, 0.75, 1.0


def plot_workspace(name: str, figures: PaperMap, canvas_corners_mm: FloatArray, reach_mm: tuple[float, float]
                   ) -> Figure:
    """Two maps in arm millimetres, one above the other: manipulability in parts of its greatest on the paper, and
    the tip's error along the paper per degree (or mm) of error of the joints.

    canvas_corners_mm: (4, 2) in order around the canvas. reach_mm: inner and outer radius of the half ring.
    """
    low, high = view_mm([canvas_corners_mm], reach_mm)
    map_width_in = _WIDTH_IN - _LEFT_IN - _BAR_IN
    map_in = (high[0] - low[0]) / (high[1] - low[1]) * map_width_in
    height_in = _TOP_IN + 2 * map_in + _GAP_IN + _BOTTOM_IN
    greatest = float(np.nanmax(figures.manipulability))
    maps = ((figures.manipulability / greatest, "manipulability, of its greatest", "viridis"),
            (figures.sideways_error_mm, "error along the paper (mm per degree, rms)", "cividis_r"))
    with planner_style():
        figure = Figure(figsize=(_WIDTH_IN, height_in))
        for place, (values, label, colours) in enumerate(maps):
            bottom_in = _BOTTOM_IN + (1 - place) * (map_in + _GAP_IN)
            axes = figure.add_axes((_LEFT_IN / _WIDTH_IN, bottom_in / height_in, map_width_in / _WIDTH_IN,
                                    map_in / height_in))
            bar = figure.add_axes(((_WIDTH_IN - _BAR_IN + 0.15) / _WIDTH_IN, bottom_in / height_in,
                                   0.16 / _WIDTH_IN, map_in / height_in))
            _draw_map(figure, axes, bar, figures, values, label, colours)
            place_axes(axes, low, high)
            axes.add_patch(half_ring(reach_mm, face="none"))
            canvas = axes.add_patch(canvas_outline(canvas_corners_mm, face="none", edge="black"))
            canvas.set_path_effects([withStroke(linewidth=2.2, foreground="white")])  # seen on dark and light alike
        width_mm, height_mm = np.ptp(canvas_corners_mm[:, 1]), np.ptp(canvas_corners_mm[:, 0])
        error = figures.sideways_error_mm
        set_title(figure, f"workspace of {name}",
                  f"reach {reach_mm[0]:.0f} to {reach_mm[1]:.0f} mm, canvas {width_mm:.0f} x {height_mm:.0f} mm; "
                  f"a degree of error in a joint is {np.nanmin(error):.2f} to {np.nanmax(error):.2f} mm, rms", 0.2)
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="upper left", ncols=len(handles), borderaxespad=0, handlelength=1.6,
                      columnspacing=1.4, bbox_to_anchor=(0.15 / _WIDTH_IN, 1 - 0.57 / height_in))
    return figure


def _draw_map(figure: Figure, axes: Axes, bar: Axes, figures: PaperMap, values: FloatArray, label: str, colours: str
              ) -> None:
    """A map whose cells have the mean of their corners, and none where one corner is out of reach."""
    cells = (values[:-1, :-1] + values[1:, :-1] + values[:-1, 1:] + values[1:, 1:]) / 4
    mesh = axes.pcolormesh(figures.y_mm, figures.x_mm, np.ma.masked_invalid(cells), cmap=colours, shading="flat",
                           rasterized=True, zorder=0.5)
    figure.colorbar(mesh, cax=bar, label=label)
