"""The pen's path with what happens along it as colour: its speed, or how far it is off the drawing."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from planner.account import Account
from planner.arrays import BoolArray, FloatArray
from planner.errors import UsageError
from planner.plots.look import LIMIT_DASHES, USUAL, Look
from planner.plots.paper import PAPER_LEFT, PAPER_RIGHT, paper_panel, pieces
from planner.plots.samples import joined_while_drawing, min_max_envelope
from planner.plots.sheet import Sheet
from planner.trajectory import Trajectory

N_LEVELS = 48
"""Levels of colour; a line is of the level that its value is in."""
_MANY_SAMPLES = 20_000  # beyond, lines are pixels in SVG and PDF too
_N_BINS = 1500
_BAR, _BAR_GAP, _BAR_LABELS = 1.2, 1.6, 5.4  # em
_BELOW, _BELOW_BOTTOM, _BELOW_GAP = 11.0, 4.0, 2.0  # em, of the panel below the paper


def plot_speed(
    trajectory: Trajectory,
    tip_mm: FloatArray,
    account: Account,
    canvas_corners_mm: FloatArray | None = None,
    reach_mm: tuple[float, float] | None = None,
    look: Look = USUAL,
) -> Figure:
    """Each line from sample to sample in the colour of the pen's mean speed along it, in mm/s.

    tip_mm: (n_samples, 2 or more). account: of the trajectory. canvas_corners_mm, reach_mm: as for `plot_drawing`.
    Errors: UsageError where the pen draws no line.
    """
    xy = np.asarray(tip_mm, dtype=np.float64)[:, :2]
    drawn = _drawn(trajectory)
    step_mm = np.linalg.norm(np.diff(xy, axis=0), axis=1)
    speed = step_mm * trajectory.rate_hz
    fastest = int(np.argmax(np.where(drawn, speed, -1.0)))
    with look.style():
        sheet = Sheet(look)
        axes = paper_panel(
            sheet,
            [xy[:1], xy[1:][drawn]],
            canvas_corners_mm,
            reach_mm,
            paper=trajectory.paper,
            right=_BAR_GAP + _BAR + _BAR_LABELS - PAPER_RIGHT,
        )
        colour_lines(sheet, axes, xy, drawn, speed, float(speed[fastest]), "speed of the pen (mm/s)")
        remark = (
            f"{account.mean_speed()}, at most {speed[fastest]:.1f} mm/s "
            f"({fastest / trajectory.rate_hz:.2f} s, stroke {trajectory.stroke[fastest]}); on {trajectory.arm}"
        )
        return sheet.finish(trajectory.title, remark, axes.get_legend_handles_labels()[0])


def plot_error(
    trajectory: Trajectory,
    tip_mm: FloatArray,
    error_mm: FloatArray,
    tolerance_mm: float,
    canvas_corners_mm: FloatArray | None = None,
    reach_mm: tuple[float, float] | None = None,
    look: Look = USUAL,
) -> Figure:
    """The distance of the pen from the wanted drawing: as colour on the paper, and over the way on it, all strokes
    one after the other, with what is beyond the tolerance tinted.

    error_mm: (n_samples,) at each sample; what it says while the pen is up does not matter.
    Errors: UsageError where the pen draws no line.
    """
    xy = np.asarray(tip_mm, dtype=np.float64)[:, :2]
    colours = look.colours
    drawn = _drawn(trajectory)
    down = np.flatnonzero(trajectory.pen)
    way_mm = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(xy, axis=0), axis=1) * drawn)))[down]
    error = np.asarray(error_mm, dtype=np.float64)[down]
    worst = int(np.argmax(error))
    top = max(float(error[worst]), tolerance_mm)
    with look.style():
        sheet = Sheet(look)
        right = _BAR_GAP + _BAR + _BAR_LABELS - PAPER_RIGHT
        axes = paper_panel(
            sheet,
            [xy[:1], xy[1:][drawn]],
            canvas_corners_mm,
            reach_mm,
            paper=trajectory.paper,
            right=right,
            bottom=_BELOW_BOTTOM + _BELOW + _BELOW_GAP,
        )
        colour_lines(
            sheet,
            axes,
            xy,
            drawn,
            np.maximum(error_mm[:-1], error_mm[1:]),
            float(error[worst]),
            "distance from the drawing (mm)",
        )
        axes.plot(
            xy[down[worst], 1],
            xy[down[worst], 0],
            "o",
            markersize=7,
            markerfacecolor="none",
            markeredgecolor=colours.limit,
            linestyle="none",
            zorder=4,
            label="farthest off",
        )
        below = sheet.panel(PAPER_LEFT, _BELOW_BOTTOM, sheet.width - PAPER_LEFT - PAPER_RIGHT, _BELOW)
        below.plot(
            *min_max_envelope(way_mm, error, _N_BINS),
            color=colours.drawn,
            linewidth=0.7,
            zorder=3,
            label="distance from the drawing",
        )
        below.axhline(
            tolerance_mm, color=colours.limit, linewidth=0.9, linestyle=LIMIT_DASHES, zorder=3.5, label="tolerance"
        )
        below.axhspan(tolerance_mm, 1.15 * top, color=colours.limit, alpha=0.13, linewidth=0)
        below.set_xlim(0, max(float(way_mm[-1]), 1e-6))
        below.set_ylim(0, 1.15 * top)
        below.set_xlabel("way of the pen on the paper (mm)")
        below.set_ylabel("distance (mm)")
        below.yaxis.set_major_locator(MaxNLocator(5, min_n_ticks=3))
        sample = int(down[worst])
        remark = (
            f"the pen is {np.sqrt(np.mean(error**2)):.4f} mm off the drawing, rms over the samples, and "
            f"{error[worst]:.4f} mm at most ({sample / trajectory.rate_hz:.2f} s, stroke "
            f"{trajectory.stroke[sample]}); tolerance {tolerance_mm:g} mm"
        )
        handles = [*axes.get_legend_handles_labels()[0], *below.get_legend_handles_labels()[0]]
        return sheet.finish(trajectory.title, remark, handles)


def colour_lines(
    sheet: Sheet, axes: Axes, xy: FloatArray, joined: BoolArray, values: FloatArray, top: float, label: str
) -> None:
    """Lines between successive points (n, 2) that are joined (n - 1,), coloured by values (n - 1,) from 0 to `top`,
    with a bar that tells the colours to the right of the axes.

    A line a level of colour: it takes no longer than a plain one per level, and shows every step however many
    there are. High levels lie on top.
    """
    edges = np.linspace(0.0, top or 1.0, N_LEVELS + 1)
    level = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, N_LEVELS - 1)
    colour_map = sheet.look.colours.colour_map(N_LEVELS)
    for one in np.unique(level[joined]).tolist():
        line = pieces(xy, joined & (level == one))
        axes.plot(
            line[:, 1],
            line[:, 0],
            color=colour_map(one),
            linewidth=1.0,
            zorder=3 + one / N_LEVELS / 2,
            rasterized=len(xy) > _MANY_SAMPLES,
        )
    bar = sheet.beside(axes, _BAR_GAP, _BAR)
    sheet.figure.colorbar(
        ScalarMappable(BoundaryNorm(edges, N_LEVELS), colour_map),
        cax=bar,
        label=label,
        spacing="proportional",
        ticks=MaxNLocator(6),
    )
    bar.minorticks_off()


def _drawn(trajectory: Trajectory) -> BoolArray:
    drawn = joined_while_drawing(trajectory)
    if not drawn.any():
        raise UsageError("the pen draws no line in this trajectory")
    return drawn
