"""The timeline of a trajectory: when it lowers, rests, draws, lifts and travels, and how long altogether."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba_array
from matplotlib.figure import Figure

from planner.arrays import FloatArray, IntArray
from planner.counted import clock, counted
from planner.phases import Phase, phases_of, seconds_in
from planner.plots.look import USUAL, Look
from planner.plots.samples import min_max_envelope, spans_where, window_s
from planner.plots.sheet import Sheet
from planner.trajectory import Trajectory

_LEFT, _BOTTOM, _GAP, _TOTALS, _RIGHT = 7.0, 4.2, 2.0, 16.0, 11.0  # em
_ROW, _HEIGHT, _BETWEEN = 2.4, 9.0, 1.8
_N_SPANS = 700
_BAR = 0.76  # of a row


def plot_timeline(
    trajectory: Trajectory,
    tip_mm: FloatArray,
    clearance_mm: float,
    look: Look = USUAL,
    *,
    from_s: float | None = None,
    to_s: float | None = None,
) -> Figure:
    """A row of bars for each phase over time with its total beside it, above the height of the tip.

    Where a phase comes more than some hundreds of times, its bars are of equal parts of the time, paler where it takes
    less of them. tip_mm: (n_samples, 3). from_s, to_s: the part of the time that is shown and counted.
    Errors: UsageError where there is nothing in that part.
    """
    window = window_s(trajectory, from_s, to_s)
    first = round(window[0] * trajectory.rate_hz)
    last = max(round(window[1] * trajectory.rate_hz), first)
    begin_s = first / trajectory.rate_hz
    phases = phases_of(trajectory, tip_mm, clearance_mm)[first:last]
    totals_s = seconds_in(phases, trajectory.rate_hz)
    with look.style():
        sheet = Sheet(look)
        width = sheet.width - _LEFT - _GAP - _TOTALS - _RIGHT
        height = sheet.panel(_LEFT, _BOTTOM, width, _HEIGHT)
        rows_height = _ROW * len(Phase)
        rows = sheet.panel(_LEFT, _BOTTOM + _HEIGHT + _BETWEEN, width, rows_height, share_x=height)
        totals = sheet.panel(_LEFT + width + _GAP, _BOTTOM + _HEIGHT + _BETWEEN, _TOTALS, rows_height)
        _draw_height(height, trajectory, tip_mm, clearance_mm, (first, last), look)
        _draw_rows(rows, phases, trajectory.rate_hz, begin_s, look)
        _draw_totals(totals, totals_s, look)
        rows.tick_params(labelbottom=False)
        height.set_xlim(begin_s, max(last, first + 1) / trajectory.rate_hz)
        n_strokes = len(np.unique(trajectory.stroke[first : last + 1][trajectory.pen[first : last + 1]]))
        remark = (
            f"{counted(n_strokes, 'stroke')} in {clock(float(totals_s.sum()))}"
            + (
                f", {begin_s:g} to {last / trajectory.rate_hz:.6g} s of {clock(trajectory.duration_s)}"
                if last - first < trajectory.n_samples - 1
                else ""
            )
            + f" on {trajectory.arm}; lifting and lowering are below the clearance of {clearance_mm:g} mm"
        )
        return sheet.finish(trajectory.title, remark, height.get_legend_handles_labels()[0], 1.2)


def _colour(phase: Phase, look: Look) -> str:
    colours = look.colours
    return {
        Phase.LOWERING: colours.lowering,
        Phase.RESTING: colours.resting,
        Phase.DRAWING: colours.drawn,
        Phase.LIFTING: colours.lifting,
        Phase.TRAVELLING: colours.travel,
    }[phase]


def _draw_rows(axes: Axes, phases: IntArray, rate_hz: float, begin_s: float, look: Look) -> None:
    for phase in Phase:
        spans = spans_where(phases == phase, rate_hz, _N_SPANS)
        start, end, share = spans[:, 0] + begin_s, spans[:, 1] + begin_s, spans[:, 2]
        corners = np.stack(
            [
                np.column_stack((x, np.full(len(spans), phase + y)))
                for x, y in ((start, -_BAR / 2), (end, -_BAR / 2), (end, _BAR / 2), (start, _BAR / 2))
            ],
            axis=1,
        )
        axes.add_collection(
            PolyCollection(
                list(corners),
                facecolors=to_rgba_array([_colour(phase, look)] * len(spans), alpha=list(share)),
                linewidths=0,
                snap=False,
                label=phase.name.lower(),
            ),
            autolim=False,
        )
    _name_rows(axes)


def _draw_totals(axes: Axes, totals_s: FloatArray, look: Look) -> None:
    whole = max(float(totals_s.sum()), 1e-9)
    axes.barh(range(len(Phase)), totals_s, height=_BAR, color=[_colour(phase, look) for phase in Phase])
    for phase in Phase:
        axes.annotate(
            f"{clock(float(totals_s[phase]))}, {100 * totals_s[phase] / whole:.0f} %",
            (totals_s[phase], phase),
            xytext=(0.4 * look.letter_pt, 0),
            textcoords="offset points",
            va="center",
        )
    axes.set_xlim(0.0, max(float(totals_s.max()), 1e-9))
    axes.set_xlabel("total (s)")
    _name_rows(axes)
    axes.tick_params(labelleft=False)


def _name_rows(axes: Axes) -> None:
    axes.set_ylim(len(Phase) - 0.5, -0.5)
    axes.set_yticks(range(len(Phase)), [phase.name.lower() for phase in Phase])
    axes.tick_params(axis="y", length=0)


def _draw_height(
    axes: Axes, trajectory: Trajectory, tip_mm: FloatArray, clearance_mm: float, part: tuple[int, int], look: Look
) -> None:
    shown = slice(part[0], part[1] + 1)
    times_s, heights_mm = np.arange(part[0], part[1] + 1) / trajectory.rate_hz, tip_mm[shown, 2]
    axes.plot(
        *min_max_envelope(times_s, heights_mm, _N_SPANS),
        color=look.colours.drawn,
        linewidth=0.8,
        zorder=3,
        label="height of the tip",
    )
    axes.axhline(
        clearance_mm, color=look.colours.quiet, linewidth=0.8, linestyle=(0, (2, 2)), zorder=2, label="clearance height"
    )
    top = max(float(heights_mm.max()), clearance_mm)
    axes.set_ylim(min(-0.05 * top, float(heights_mm.min())), 1.08 * top)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("tip height (mm)")
