"""The picture of the drawing: what the pen draws over what was wanted, on the paper in front of the arm."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.arrays import FloatArray
from planner.counted import counted
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import flatten_all
from planner.plots.look import USUAL, Look
from planner.plots.paper import paper_panel, pieces
from planner.plots.samples import TAP_EXTENT_MM, joined_while_drawing
from planner.plots.sheet import Sheet
from planner.trajectory import Trajectory

_FLATTEN_TOLERANCE_MM = 0.02  # well under a pixel


def plot_drawing(
    trajectory: Trajectory,
    tip_mm: FloatArray,
    drawing: Drawing | None = None,
    canvas_corners_mm: FloatArray | None = None,
    reach_mm: tuple[float, float] | None = None,
    look: Look = USUAL,
) -> Figure:
    """The tip's path over the drawing's outlines, in arm millimetres at equal scales.

    tip_mm: (n_samples, 2 or more) x, y of the tip at each sample, by whatever forward kinematics.
    drawing: its outlines are carried to the arm by the trajectory's own svg_to_arm_mm.
    canvas_corners_mm: (4, 2) in order around the canvas. reach_mm: inner and outer radius of the half
    ring in front of the base that the pen reaches.
    """
    xy = np.asarray(tip_mm, dtype=np.float64)[:, :2]
    colours = look.colours
    drawn = joined_while_drawing(trajectory)
    drawn_line, travel_line = pieces(xy, drawn), pieces(xy, ~drawn)
    wanted_line, wanted_taps = _wanted(trajectory, drawing)
    with look.style():
        sheet = Sheet(look)
        axes = paper_panel(sheet, [xy, wanted_line], canvas_corners_mm, reach_mm)
        _line(axes, wanted_line, "wanted", color=colours.wanted, linewidth=0.2 * look.letter_pt, zorder=2)
        _dots(axes, wanted_taps, "tap wanted", color=colours.wanted, size=4.5, zorder=2)
        _line(axes, travel_line, "travel, pen up", color=colours.travel, linewidth=0.35, zorder=2.5)
        _line(axes, drawn_line, "drawn", color=colours.drawn, linewidth=0.11 * look.letter_pt, zorder=3)
        _dots(axes, _taps(trajectory, xy), "tap", color=colours.drawn, size=2.2, zorder=3)
        n_strokes = int(trajectory.stroke.max(initial=-1)) + 1
        remark = (
            f"{counted(n_strokes, 'stroke')}, {_length_mm(drawn_line):.0f} mm drawn and "
            f"{_length_mm(travel_line):.0f} mm travelled in {trajectory.duration_s:.4g} s "
            f"on {trajectory.arm}, seen from behind its base"
        )
        return sheet.finish(trajectory.drawing or "trajectory", remark, axes.get_legend_handles_labels()[0])


def _taps(trajectory: Trajectory, xy: FloatArray) -> FloatArray:
    """(k, 2) where the pen touches the paper and leaves it without drawing a line."""
    down = np.flatnonzero(trajectory.pen)
    if not len(down):
        return np.empty((0, 2))
    is_first = np.concatenate(([True], ~joined_while_drawing(trajectory)[down[1:] - 1]))
    starts = np.flatnonzero(is_first)
    spread = np.maximum.reduceat(xy[down], starts) - np.minimum.reduceat(xy[down], starts)
    taps: FloatArray = xy[down[starts[spread.max(axis=1) <= TAP_EXTENT_MM]]]
    return taps


def _wanted(trajectory: Trajectory, drawing: Drawing | None) -> tuple[FloatArray, FloatArray]:
    """The outlines on the paper: lines with a row of NaN after each, and the places of pen taps."""
    if drawing is None:
        return np.empty((0, 2)), np.empty((0, 2))
    strokes = flatten_all(trajectory.all_of(drawing).outlines, trajectory.svg_to_arm, _FLATTEN_TOLERANCE_MM)
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


def _length_mm(line: FloatArray) -> float:
    return float(np.nansum(np.hypot(*np.diff(line, axis=0).T)))
