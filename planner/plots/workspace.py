"""The picture of an arm's workspace: the ring that the pen reaches with the canvases in it, and over the paper how
freely the pen moves and how far it strays where a joint is off."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Colormap
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.plots.look import LIMIT_DASHES, USUAL, Look
from planner.plots.paper import PAPER_BOTTOM, PAPER_LEFT, canvas_outline, half_ring, place_axes
from planner.plots.paper_extent import base_of, view_mm
from planner.plots.sheet import Sheet
from planner.settings import CanvasKind
from planner.workspace.paper_map import PaperMap

_BAR, _BAR_GAP, _BAR_LABELS, _BETWEEN = 1.2, 1.2, 5.6, 3.4  # em
_TITLE = 1.6
_N_COLOURS = 256


def plot_workspace(
    name: str,
    figures: PaperMap,
    canvases_mm: Mapping[CanvasKind, FloatArray],
    ring_mm: tuple[float, float] | None,
    paper: PaperPose,
    look: Look = USUAL,
) -> Figure:
    """The ring with the canvases, and beside it two maps, all in arm millimetres: manipulability in parts of its
    greatest on the paper, and the tip's error along the paper per degree (or mm) of error of the joints.

    canvases_mm: corners (4, 2) of each, in order around it; the usable one is on the maps too.
    ring_mm: inner and outer radius of the half ring, where what is reached is one. paper: where it lies.
    """
    base_mm = base_of(paper)
    is_reached = np.isfinite(figures.manipulability)
    reached = [np.column_stack((figures.x_mm[is_reached], figures.y_mm[is_reached]))] if ring_mm is None else []
    low, high = view_mm([*canvases_mm.values(), *reached], ring_mm, base_mm)
    slimness = float((high[0] - low[0]) / (high[1] - low[1]))
    greatest = float(np.nanmax(figures.manipulability))
    good_is_bright = look.colours.colour_map(_N_COLOURS)
    maps = (
        (figures.manipulability / greatest, "manipulability, of its greatest", good_is_bright),
        (figures.sideways_error_mm, "tip error (mm per degree, rms)", good_is_bright.reversed()),
    )
    with look.style():
        sheet = Sheet(look)
        # the maps are as high together as the ring is alone
        outside = 2 * PAPER_LEFT + _BETWEEN + _BAR_GAP + _BAR + _BAR_LABELS
        between = PAPER_BOTTOM + _TITLE
        map_width = (sheet.width - outside - between / slimness) / 3
        ring_width = sheet.width - outside - map_width
        map_height, ring_height = map_width * slimness, ring_width * slimness
        ring = sheet.panel(PAPER_LEFT, PAPER_BOTTOM, ring_width, ring_height)
        place_axes(ring, low, high, ring_width, look.colours, base_mm)
        _draw_canvases(ring, canvases_mm, ring_mm, base_mm, look)
        left = PAPER_LEFT + ring_width + _BETWEEN + PAPER_LEFT
        for place, (values, label, colour_map) in enumerate(maps):
            axes = sheet.panel(left, PAPER_BOTTOM + (1 - place) * (map_height + between), map_width, map_height)
            _draw_map(sheet, axes, figures, values, colour_map)
            place_axes(axes, low, high, map_width, look.colours, base_mm)
            axes.set_title(label, loc="left", size=look.letter_pt, weight="bold")
            if ring_mm is not None:
                axes.add_patch(half_ring(ring_mm, look.colours, base_mm, face="none"))
            if CanvasKind.USABLE in canvases_mm:
                canvas = canvas_outline(canvases_mm[CanvasKind.USABLE], look.colours, face="none", edge="black")
                axes.add_patch(canvas)
                canvas.set_path_effects([withStroke(linewidth=2.2, foreground="white")])  # seen on dark and light
        error = figures.sideways_error_mm
        remark = (
            ("" if ring_mm is None else f"reach {ring_mm[0]:.0f} to {ring_mm[1]:.0f} mm, ")
            + "seen from behind the base; "
            f"a degree of error in a joint is {np.nanmin(error):.2f} to {np.nanmax(error):.2f} mm, rms"
        )
        return sheet.finish(f"workspace of {name}", remark, ring.get_legend_handles_labels()[0], _TITLE)


def _draw_canvases(
    axes: Axes,
    canvases_mm: Mapping[CanvasKind, FloatArray],
    ring_mm: tuple[float, float] | None,
    base_mm: tuple[float, float],
    look: Look,
) -> None:
    colours = look.colours
    if ring_mm is not None:
        axes.add_patch(half_ring(ring_mm, colours, base_mm))
    styles = {
        CanvasKind.DOCUMENTED: (colours.limit, LIMIT_DASHES),
        CanvasKind.OPTIMAL: (colours.lifting, (0, (1, 1))),
        CanvasKind.USABLE: (colours.drawn, "solid"),
    }
    for kind, corners in canvases_mm.items():
        edge, dashes = styles[kind]
        height_mm, width_mm = np.ptp(corners, axis=0)
        canvas = canvas_outline(corners, colours, face="none", edge=edge)
        canvas.set(
            linestyle=dashes, linewidth=1.6, zorder=2, label=f"{kind} canvas, {width_mm:.0f} × {height_mm:.0f} mm"
        )
        axes.add_patch(canvas)


def _draw_map(sheet: Sheet, axes: Axes, figures: PaperMap, values: FloatArray, colour_map: Colormap) -> None:
    """A map whose cells have the mean of their corners, and none where one corner is out of reach."""
    cells = (values[:-1, :-1] + values[1:, :-1] + values[:-1, 1:] + values[1:, 1:]) / 4
    mesh = axes.pcolormesh(
        figures.y_mm,
        figures.x_mm,
        np.ma.masked_invalid(cells),
        shading="flat",
        rasterized=True,
        cmap=colour_map,
        zorder=0.5,
    )
    sheet.figure.colorbar(mesh, cax=sheet.beside(axes, _BAR_GAP, _BAR), ticks=MaxNLocator(4))
