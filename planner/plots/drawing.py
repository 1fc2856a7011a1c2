"""The picture of the drawing: what the pen draws over what was wanted, on the paper in front of the arm."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.account import Account
from planner.arrays import FloatArray
from planner.counted import clock
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import flatten_all
from planner.drawing.image.lines import with_images
from planner.placement.tiling import held_by
from planner.plots.ink import inks_of
from planner.plots.inked import draw_inks, legend_of
from planner.plots.look import USUAL, Look
from planner.plots.paper import paper_panel, paper_patch, pieces, pt_per_mm_of
from planner.plots.paper_extent import paper_sides_mm
from planner.plots.samples import joined_while_drawing
from planner.plots.sheet import Sheet
from planner.trajectory import Trajectory

_FLATTEN_TOLERANCE_MM = 0.02  # well under a pixel
_HALO = 0.1
"""Of a letter: how much wider than the ink what was wanted is shown."""


def plot_drawing(
    trajectory: Trajectory,
    tip_mm: FloatArray,
    account: Account,
    drawing: Drawing | None = None,
    canvas_corners_mm: FloatArray | None = None,
    reach_mm: tuple[float, float] | None = None,
    look: Look = USUAL,
) -> Figure:
    """The tip's path over the drawing's outlines, in arm millimetres at equal scales.

    tip_mm: (n_samples, 2 or more) x, y of the tip at each sample, by whatever forward kinematics.
    account: of the trajectory. drawing: its outlines are carried to the arm by the trajectory's own svg_to_arm_mm.
    canvas_corners_mm: (4, 2) in order around the canvas. reach_mm: inner and outer radius of the half
    ring in front of the base that the pen reaches.
    """
    xy = np.asarray(tip_mm, dtype=np.float64)[:, :2]
    colours = look.colours
    travel_line = pieces(xy, ~joined_while_drawing(trajectory))
    wanted_line, wanted_taps = _wanted(trajectory, drawing)
    inks = inks_of(trajectory, xy[:, ::-1])
    with look.style():
        sheet = Sheet(look)
        axes = paper_panel(sheet, [xy, wanted_line], canvas_corners_mm, reach_mm, paper=trajectory.paper)
        axes.add_patch(paper_patch(paper_sides_mm(trajectory, xy), colours))
        pt_per_mm = pt_per_mm_of(sheet, axes)
        halo_pt = max(ink.width_mm for ink in inks) * pt_per_mm + _HALO * look.letter_pt
        _line(axes, wanted_line, "wanted", color=colours.wanted, linewidth=halo_pt, zorder=2)
        _dots(axes, wanted_taps, "tap wanted", color=colours.wanted, size=halo_pt, zorder=2)
        _line(axes, travel_line, "travel, pen up", color=colours.travel, linewidth=0.35, zorder=2.5)
        draw_inks(axes, inks, pt_per_mm, zorder=3.0)
        legend = [*axes.get_legend_handles_labels()[0], *legend_of(inks, look)]
        remark = f"{account.amount()}, in {clock(account.duration_s)} on {trajectory.arm}, seen from behind its base"
        return sheet.finish(trajectory.title, remark, legend)


def _wanted(trajectory: Trajectory, drawing: Drawing | None) -> tuple[FloatArray, FloatArray]:
    """The outlines on the paper: lines with a row of NaN after each, and the places of pen taps."""
    if drawing is None:
        return np.empty((0, 2)), np.empty((0, 2))
    tile = trajectory.placement.tile
    shift = np.zeros(2) if tile is None else np.array(tile.shift_mm)
    drawing = with_images(drawing, trajectory.svg_to_arm - np.column_stack((np.zeros((2, 2)), shift)))
    strokes = flatten_all(trajectory.all_of(drawing).outlines, trajectory.svg_to_arm, _FLATTEN_TOLERANCE_MM)
    if tile is not None:
        strokes = [*held_by(tile, strokes), *tile.mark_lines()]
    gap = np.full((1, 2), np.nan)
    lines = [part for stroke in strokes if len(stroke) > 1 for part in (stroke, gap)]
    taps = [stroke for stroke in strokes if len(stroke) == 1]
    empty = np.empty((0, 2))
    return np.concatenate([empty, *lines]), np.concatenate([empty, *taps])


def _line(axes: Axes, line: FloatArray, label: str, *, color: str, linewidth: float, zorder: float) -> None:
    if len(line):
        axes.plot(line[:, 1], line[:, 0], color=color, linewidth=linewidth, zorder=zorder, label=label)


def _dots(axes: Axes, dots: FloatArray, label: str, *, color: str, size: float, zorder: float) -> None:
    if len(dots):
        axes.plot(
            dots[:, 1],
            dots[:, 0],
            linestyle="none",
            marker="o",
            markersize=size,
            markeredgewidth=0,
            color=color,
            zorder=zorder,
            label=label,
        )
