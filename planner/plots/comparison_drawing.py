"""The picture of methods along a drawing: where on the paper each breaks limits, and its error and its postures along
the way."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.comparison.compare import Comparison, MethodResult
from planner.comparison.figures import LIMIT_SLACK, beyond_limits
from planner.comparison.measured import Measured
from planner.comparison.targets import Targets
from planner.plots.comparison_look import explain_methods, line_of, shown
from planner.plots.look import GREY, INK, VERMILION, planner_style, set_title
from planner.plots.paper import place_axes, view_mm

_WIDTH_IN, _TOP_IN, _BOTTOM_IN, _LEFT_IN, _RIGHT_IN, _GAP_IN = 12.0, 1.05, 0.45, 0.7, 0.2, 0.35
_ERROR_IN, _JOINT_IN = 1.3, 0.95
_FLOOR_MM = 1e-9
"""Errors are drawn no smaller: there they are the rounding of numbers."""
_FEW_TARGETS = 2000


def plot_along_drawing(comparison: Comparison) -> Figure:
    """A map of the targets for each method, those in red with a joint beyond its limits and crossed those that are not
    solved; under them, over the way drawn, the tip's error and every joint with its limits. Errors: UsageError
    where no method solves a target."""
    arm, targets = comparison.arm, comparison.targets
    able = shown(comparison)
    low, high = view_mm([targets.tips_mm[:, :2]], None)
    map_width_in = (_WIDTH_IN - _LEFT_IN - _RIGHT_IN - (len(able) - 1) * _GAP_IN) / len(able)
    map_in = max(map_width_in * float((high[0] - low[0]) / (high[1] - low[1])), 1.0)
    rows_in = [_ERROR_IN, *([_JOINT_IN] * arm.n_joints)]
    height_in = _TOP_IN + map_in + 0.6 + sum(rows_in) + 0.15 * len(rows_in) + _BOTTOM_IN
    along = _way_drawn_mm(targets)
    with planner_style():
        figure = Figure(figsize=(_WIDTH_IN, height_in))

        def add(left_in: float, bottom_in: float, wide_in: float, high_in: float) -> Axes:
            return figure.add_axes((left_in / _WIDTH_IN, bottom_in / height_in, wide_in / _WIDTH_IN,
                                    high_in / height_in))

        bottom_in = height_in - _TOP_IN - map_in
        for place, (result, measured) in enumerate(able):
            axes = add(_LEFT_IN + place * (map_width_in + _GAP_IN), bottom_in, map_width_in, map_in)
            _draw_map(axes, arm, targets, result, measured)
            place_axes(axes, low, high)
            axes.xaxis.set_major_locator(MaxNLocator(5))
            if place:
                axes.set_ylabel("")
        bottom_in -= 0.6
        panels = []
        for high_in in rows_in:
            bottom_in -= high_in
            panels.append(add(_LEFT_IN, bottom_in, _WIDTH_IN - _LEFT_IN - _RIGHT_IN, high_in))
            bottom_in -= 0.15
        _draw_errors(panels[0], along, able, targets)
        _draw_joints(panels[1:], arm, along, able, targets)
        for panel in panels:
            panel.set_xlim(0.0, max(float(along[-1]), 1.0))
            panel.tick_params(labelbottom=panel is panels[-1])
        panels[-1].set_xlabel("way drawn, strokes one after the other (mm)")
        figure.align_ylabels(panels)
        set_title(figure, f"methods along a drawing on {arm.name}",
                  f"{len(targets.tips_mm)} targets along {len(targets.firsts)} strokes, seen from behind the base", 0.2)
        explain_methods(figure, [result for result, _ in able])
        _explain_marks(figure)
    return figure


def _way_drawn_mm(targets: Targets) -> FloatArray:
    """(n,) the way to each target, strokes laid end to end."""
    ends = np.append(targets.firsts[1:], len(targets.tips_mm)) - 1
    before = np.concatenate(([0.0], np.cumsum(targets.along_mm[ends])[:-1]))
    way: FloatArray = targets.along_mm + np.repeat(before, np.diff(np.append(targets.firsts, len(targets.tips_mm))))
    return way


def _draw_map(axes: Axes, arm: Arm, targets: Targets, result: MethodResult, measured: Measured) -> None:
    outside = measured.solved & (beyond_limits(arm, measured.joints) > LIMIT_SLACK).any(axis=1)
    size = 2.0 if len(targets.tips_mm) < _FEW_TARGETS else 1.0
    kinds = ((measured.solved & ~outside, ".", GREY, "within"), (outside, ".", VERMILION, "outside"),
             (~measured.solved, "x", INK, "unsolved"))
    for chosen, marker, colour, label in kinds:
        y, x = targets.tips_mm[chosen, 1], targets.tips_mm[chosen, 0]
        axes.plot(y, x, linestyle="none", marker=marker, markersize=size * (1 if marker == "." else 2),
                  markeredgewidth=0 if marker == "." else 0.5, color=colour, label=label)
    share = float(outside.sum() / len(outside))
    axes.set_title(f"{result.method.title}: {100 * share:.1f} % outside", loc="left", size=8,
                   color=VERMILION if share else INK)


def _draw_errors(axes: Axes, along: FloatArray, able: list[tuple[MethodResult, Measured]], targets: Targets) -> None:
    for result, measured in able:
        error = np.where(measured.solved, np.maximum(measured.error_mm, _FLOOR_MM), np.nan)
        _draw_course(axes, along, error, result, targets)
    axes.set_yscale("log")
    axes.set_ylabel("tip's error (mm)")


def _draw_joints(panels: list[Axes], arm: Arm, along: FloatArray, able: list[tuple[MethodResult, Measured]],
                 targets: Targets) -> None:
    """A panel a joint: its course by every method, and what is beyond its limits tinted."""
    lowest, highest = arm.to_file_units(arm.minimum), arm.to_file_units(arm.maximum)
    for index, (axes, joint) in enumerate(zip(panels, arm.joints, strict=True)):
        courses = [(result, np.where(measured.solved, arm.to_file_units(measured.joints)[:, index], np.nan))
                   for result, measured in able]
        for result, course in courses:
            _draw_course(axes, along, course, result, targets)
        least = min(float(np.nanmin(course)) for _, course in courses)
        most = max(float(np.nanmax(course)) for _, course in courses)
        room = 0.08 * max(most - least, 1.0)
        low, high = float(lowest[index]), float(highest[index])
        bottom, top = least - room, most + room
        for limit, near, far in ((low, min(bottom, low), low), (high, high, max(top, high))):
            if bottom <= limit <= top:
                axes.axhline(limit, color=VERMILION, linewidth=0.9, linestyle=(0, (5, 2)))
            axes.axhspan(near, far, color=VERMILION, alpha=0.10, linewidth=0)
        axes.set_ylim(bottom, top)
        axes.ticklabel_format(axis="y", useOffset=False)
        axes.set_ylabel(f"{joint.name} ({joint.file_unit})")
        axes.yaxis.label.set_parse_math(False)


def _draw_course(axes: Axes, along: FloatArray, values: FloatArray, result: MethodResult, targets: Targets) -> None:
    """A line that is broken between strokes."""
    breaks, line = targets.firsts[1:], line_of(result)
    axes.plot(np.insert(along, breaks, np.nan), np.insert(values, breaks, np.nan), color=line.colour,
              linestyle=line.dashes, linewidth=0.6 * line.width, zorder=line.zorder, label=result.method.title)


def _explain_marks(figure: Figure) -> None:
    width_in, height_in = (float(side) for side in figure.get_size_inches())
    entries = [Line2D([], [], color=GREY, marker=".", linestyle="none", label="within the joint limits"),
               Line2D([], [], color=VERMILION, marker=".", linestyle="none", label="a joint outside"),
               Line2D([], [], color=INK, marker="x", markersize=4, linestyle="none", label="not solved"),
               Line2D([], [], color=VERMILION, linewidth=0.9, linestyle=(0, (5, 2)), label="limit of the joint")]
    figure.legend(handles=entries, loc="upper right", ncols=len(entries), borderaxespad=0, columnspacing=1.4,
                  bbox_to_anchor=(1 - 0.2 / width_in, 1 - 0.2 / height_in))
