"""The picture of the drawing: what the pen draws over what was wanted, on the paper in front of the arm."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.arrays import BoolArray, FloatArray
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import flatten_all
from planner.plots.look import BLUE, GREY, PALE_ORANGE, planner_style, set_title
from planner.plots.paper import canvas_outline, half_ring, place_axes, view_mm
from planner.trajectory import Trajectory

_FLATTEN_TOLERANCE_MM = 0.02  # well under a pixel
_TAP_EXTENT_MM = 0.02  # a stroke that stays within this is a dot
_WIDTH_IN, _TOP_IN, _BOTTOM_IN, _LEFT_IN, _RIGHT_IN = 10.0, 0.95, 0.5, 0.6, 0.25


def plot_drawing(
    trajectory: Trajectory,
    tip_mm: FloatArray,
    drawing: Drawing | None = None,
    canvas_corners_mm: FloatArray | None = None,
    reach_mm: tuple[float, float] | None = None,
) -> Figure:
    """The tip's path over the drawing's outlines, in arm millimetres at equal scales.

    tip_mm: (n_samples, 2 or more) x, y of the tip at each sample, by whatever forward kinematics.
    drawing: its outlines are carried to the arm by the trajectory's own svg_to_arm_mm.
    canvas_corners_mm: (4, 2) in order around the canvas. reach_mm: inner and outer radius of the half
    ring in front of the base that the pen reaches.
    """
    xy = np.asarray(tip_mm, dtype=np.float64)[:, :2]
    drawn = _joined_while_drawing(trajectory)
    drawn_line, travel_line = _pieces(xy, drawn), _pieces(xy, ~drawn)
    taps = _taps(trajectory, xy)
    wanted_line, wanted_taps = _wanted(trajectory, drawing)
    canvas = np.empty((0, 2)) if canvas_corners_mm is None else np.asarray(canvas_corners_mm, dtype=np.float64)
    low, high = view_mm([xy, wanted_line, canvas], reach_mm)
    scale_in = (_WIDTH_IN - _LEFT_IN - _RIGHT_IN) / (high[1] - low[1])
    paper_in = min(max((high[0] - low[0]) * scale_in, 2.0), 12.0)
    height_in = _TOP_IN + paper_in + _BOTTOM_IN
    with planner_style():
        figure = Figure(figsize=(_WIDTH_IN, height_in))
        axes = figure.add_axes((_LEFT_IN / _WIDTH_IN, _BOTTOM_IN / height_in,
                                1 - (_LEFT_IN + _RIGHT_IN) / _WIDTH_IN, paper_in / height_in))
        place_axes(axes, low, high)
        _draw_paper(axes, canvas, reach_mm)
        _line(axes, wanted_line, "wanted", color=PALE_ORANGE, linewidth=1.4, zorder=2)
        _dots(axes, wanted_taps, "tap wanted", color=PALE_ORANGE, size=4.5, zorder=2)
        _line(axes, travel_line, "travel, pen up", color=GREY, linewidth=0.35, zorder=2.5)
        _line(axes, drawn_line, "drawn", color=BLUE, linewidth=0.6, zorder=3)
        _dots(axes, taps, "tap", color=BLUE, size=2.2, zorder=3)
        remark = (f"{int(trajectory.stroke.max(initial=-1)) + 1} strokes, {_length_mm(drawn_line):.0f} mm drawn and "
                  f"{_length_mm(travel_line):.0f} mm travelled in {trajectory.duration_s:.4g} s "
                  f"on {trajectory.arm}, seen from behind its base")
        set_title(figure, trajectory.drawing or "trajectory", remark, 0.2)
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, loc="upper left", ncols=len(handles), borderaxespad=0, handlelength=1.6,
                      columnspacing=1.4, bbox_to_anchor=(0.15 / _WIDTH_IN, 1 - 0.57 / height_in))
    return figure


def _joined_while_drawing(trajectory: Trajectory) -> BoolArray:
    """(n_samples - 1,) whether the pen draws a line from each sample to the next."""
    pen, stroke = trajectory.pen, trajectory.stroke
    joined: BoolArray = pen[:-1] & pen[1:] & (stroke[:-1] == stroke[1:])
    return joined


def _pieces(xy: FloatArray, joined: BoolArray) -> FloatArray:
    """The points (n, 2) that are joined to a neighbour, in order, with a row of NaN after each piece."""
    after = np.concatenate((joined, [False]))
    before = np.concatenate(([False], joined))
    used = after | before
    pieces: FloatArray = np.insert(xy[used], np.flatnonzero(~after[used]) + 1, np.nan, axis=0)
    return pieces


def _taps(trajectory: Trajectory, xy: FloatArray) -> FloatArray:
    """(k, 2) where the pen touches the paper and leaves it without drawing a line."""
    down = np.flatnonzero(trajectory.pen)
    if not len(down):
        return np.empty((0, 2))
    is_first = np.concatenate(([True], ~_joined_while_drawing(trajectory)[down[1:] - 1]))
    starts = np.flatnonzero(is_first)
    spread = np.maximum.reduceat(xy[down], starts) - np.minimum.reduceat(xy[down], starts)
    taps: FloatArray = xy[down[starts[spread.max(axis=1) <= _TAP_EXTENT_MM]]]
    return taps


def _wanted(trajectory: Trajectory, drawing: Drawing | None) -> tuple[FloatArray, FloatArray]:
    """The outlines on the paper: lines with a row of NaN after each, and the places of pen taps."""
    if drawing is None:
        return np.empty((0, 2)), np.empty((0, 2))
    a, b, c, d, e, f = trajectory.svg_to_arm_mm
    strokes = flatten_all(drawing.outlines, np.array([[a, c, e], [b, d, f]]), _FLATTEN_TOLERANCE_MM)
    gap = np.full((1, 2), np.nan)
    lines = [part for stroke in strokes if len(stroke) > 1 for part in (stroke, gap)]
    taps = [stroke for stroke in strokes if len(stroke) == 1]
    empty = np.empty((0, 2))
    return np.concatenate([empty, *lines]), np.concatenate([empty, *taps])


def _draw_paper(axes: Axes, canvas: FloatArray, reach_mm: tuple[float, float] | None) -> None:
    if reach_mm is not None:
        axes.add_patch(half_ring(reach_mm))
    if len(canvas):
        axes.add_patch(canvas_outline(canvas))


def _line(axes: Axes, line: FloatArray, label: str, *, color: str, linewidth: float, zorder: float) -> None:
    if len(line):
        axes.plot(line[:, 1], line[:, 0], color=color, linewidth=linewidth, zorder=zorder, label=label)


def _dots(axes: Axes, dots: FloatArray, label: str, *, color: str, size: float, zorder: float) -> None:
    if len(dots):
        axes.plot(dots[:, 1], dots[:, 0], linestyle="none", marker="o", markersize=size, markeredgewidth=0,
                  color=color, zorder=zorder, label=label)


def _length_mm(line: FloatArray) -> float:
    return float(np.nansum(np.hypot(*np.diff(line, axis=0).T)))
