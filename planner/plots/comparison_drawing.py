"""The picture of methods along a drawing: where on the paper each breaks limits, and its error and its configurations
along the way."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.comparison.compare import Comparison, MethodResult
from planner.comparison.figures import LIMIT_SLACK, beyond_limits
from planner.comparison.measured import Measured
from planner.comparison.targets import Targets
from planner.counted import counted
from planner.plots.comparison_look import line_of, method_handles, shown
from planner.plots.look import LIMIT_DASHES, USUAL, Look
from planner.plots.paper import place_axes
from planner.plots.paper_extent import base_of, view_mm
from planner.plots.sheet import Sheet

_LEFT, _BOTTOM, _RIGHT, _BETWEEN, _TITLE = 6.2, 4.2, 1.8, 4.0, 1.6  # em
_ERROR, _JOINT, _ROW_GAP, _LOWEST_MAP = 10.0, 7.0, 1.2, 7.0
_FLOOR_MM = 1e-9
"""Errors are drawn no smaller: there they are the rounding of numbers."""
_FEW_TARGETS = 2000


def plot_along_drawing(comparison: Comparison, look: Look = USUAL) -> Figure:
    """A map of the targets for each method, those in red with a joint beyond its limits and crossed those that are not
    solved; under them, over the way drawn, the tip's error and every joint with its limits. Errors: UsageError
    where no method solves a target."""
    arm, targets = comparison.arm, comparison.targets
    able = shown(comparison)
    low, high = view_mm([targets.tips_mm[:, :2]], None, base_of(arm.paper))
    along = _way_drawn_mm(targets)
    with look.style():
        sheet = Sheet(look)
        rows = [_ERROR, *[_JOINT] * arm.n_joints]
        bottom = 2 * _BOTTOM + sum(rows) + len(rows) * _ROW_GAP
        width = (sheet.width - _LEFT - _RIGHT - (len(able) - 1) * _BETWEEN) / len(able)
        height = max(width * float((high[0] - low[0]) / (high[1] - low[1])), _LOWEST_MAP)
        for place, (result, measured) in enumerate(able):
            axes = sheet.panel(_LEFT + place * (width + _BETWEEN), bottom, width, height)
            _draw_map(axes, arm, targets, result, measured, look)
            place_axes(axes, low, high, width, look.colours, base_of(arm.paper))
            if place:
                axes.set_ylabel("")
        bottom -= _BOTTOM
        panels = []
        for row in rows:
            bottom -= row + _ROW_GAP
            panels.append(sheet.panel(_LEFT, bottom, sheet.width - _LEFT - _RIGHT, row))
        _draw_errors(panels[0], along, able, targets)
        _draw_joints(panels[1:], arm, along, able, targets, look)
        for panel in panels:
            panel.set_xlim(0.0, max(float(along[-1]), 1.0))
            panel.tick_params(labelbottom=panel is panels[-1])
        panels[-1].set_xlabel("way drawn, strokes one after the other (mm)")
        sheet.figure.align_ylabels(panels)
        remark = (
            f"{counted(len(targets.tips_mm), 'target')} along {counted(len(targets.firsts), 'stroke')}, "
            "seen from behind the base"
        )
        return sheet.finish(
            f"methods along a drawing on {arm.name}",
            remark,
            [*method_handles([result for result, _ in able]), *_marks(look)],
            _TITLE,
        )


def _way_drawn_mm(targets: Targets) -> FloatArray:
    """(n,) the way to each target, strokes laid end to end."""
    ends = np.append(targets.firsts[1:], len(targets.tips_mm)) - 1
    before = np.concatenate(([0.0], np.cumsum(targets.along_mm[ends])[:-1]))
    way: FloatArray = targets.along_mm + np.repeat(before, np.diff(np.append(targets.firsts, len(targets.tips_mm))))
    return way


def _draw_map(axes: Axes, arm: Arm, targets: Targets, result: MethodResult, measured: Measured, look: Look) -> None:
    outside = measured.solved & (beyond_limits(arm, measured.joints) > LIMIT_SLACK).any(axis=1)
    size = 2.0 if len(targets.tips_mm) < _FEW_TARGETS else 1.0
    kinds = (
        (measured.solved & ~outside, ".", look.colours.travel, "within"),
        (outside, ".", look.colours.limit, "outside"),
        (~measured.solved, "x", look.colours.ink, "unsolved"),
    )
    for chosen, marker, colour, label in kinds:
        y, x = targets.tips_mm[chosen, 1], targets.tips_mm[chosen, 0]
        axes.plot(
            y,
            x,
            linestyle="none",
            marker=marker,
            markersize=size * (1 if marker == "." else 2),
            markeredgewidth=0 if marker == "." else 0.5,
            color=colour,
            label=label,
        )
    share = float(outside.sum() / len(outside))
    axes.set_title(
        f"{result.method.title}: {100 * share:.1f} % outside",
        loc="left",
        size=look.letter_pt,
        color=look.colours.limit if share else look.colours.ink,
    )


def _draw_errors(axes: Axes, along: FloatArray, able: list[tuple[MethodResult, Measured]], targets: Targets) -> None:
    for result, measured in able:
        error = np.where(measured.solved, np.maximum(measured.error_mm, _FLOOR_MM), np.nan)
        _draw_positions(axes, along, error, result, targets)
    axes.set_yscale("log")
    axes.set_ylabel("tip's error (mm)")


def _draw_joints(
    panels: list[Axes],
    arm: Arm,
    along: FloatArray,
    able: list[tuple[MethodResult, Measured]],
    targets: Targets,
    look: Look,
) -> None:
    """A panel a joint: its positions by every method, and what is beyond its limits tinted."""
    lowest, highest = arm.to_file_units(arm.minimum), arm.to_file_units(arm.maximum)
    for index, (axes, joint) in enumerate(zip(panels, arm.joints, strict=True)):
        joint_positions = [
            (result, np.where(measured.solved, arm.to_file_units(measured.joints)[:, index], np.nan))
            for result, measured in able
        ]
        for result, positions in joint_positions:
            _draw_positions(axes, along, positions, result, targets)
        least = min(float(np.nanmin(positions)) for _, positions in joint_positions)
        most = max(float(np.nanmax(positions)) for _, positions in joint_positions)
        room = 0.08 * max(most - least, 1.0)
        low, high = float(lowest[index]), float(highest[index])
        bottom, top = least - room, most + room
        for limit, near, far in ((low, min(bottom, low), low), (high, high, max(top, high))):
            if bottom <= limit <= top:
                axes.axhline(limit, color=look.colours.limit, linewidth=0.9, linestyle=LIMIT_DASHES)
            axes.axhspan(near, far, color=look.colours.limit, alpha=0.13, linewidth=0)
        axes.set_ylim(bottom, top)
        axes.ticklabel_format(axis="y", useOffset=False)
        axes.set_ylabel(f"{joint.name} ({joint.file_unit})")
        axes.yaxis.label.set_parse_math(False)


def _draw_positions(axes: Axes, along: FloatArray, values: FloatArray, result: MethodResult, targets: Targets) -> None:
    """A line that is broken between strokes."""
    breaks, line = targets.firsts[1:], line_of(result)
    axes.plot(
        np.insert(along, breaks, np.nan),
        np.insert(values, breaks, np.nan),
        color=line.colour,
        linestyle=line.dashes,
        linewidth=0.6 * line.width,
        zorder=line.zorder,
        label=result.method.title,
    )


def _marks(look: Look) -> list[Line2D]:
    """What the legend says of the maps and limits."""
    colours = look.colours
    return [
        Line2D([], [], color=colours.travel, marker=".", linestyle="none", label="within the joint limits"),
        Line2D([], [], color=colours.limit, marker=".", linestyle="none", label="a joint outside"),
        Line2D([], [], color=colours.ink, marker="x", markersize=4, linestyle="none", label="not solved"),
        Line2D([], [], color=colours.limit, linewidth=0.9, linestyle=LIMIT_DASHES, label="limit of the joint"),
    ]
