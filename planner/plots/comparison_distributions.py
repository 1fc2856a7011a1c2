"""The picture of methods over random targets: what share of the targets has at most so large a figure."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.comparison.compare import Comparison, MethodResult
from planner.comparison.figures import beyond_limits
from planner.comparison.measured import Measured
from planner.kinematics.sensitivity import sideways_error
from planner.kinematics.singularity import manipulability
from planner.plots.comparison_look import line_of, method_handles, shown
from planner.plots.look import LIMIT_DASHES, USUAL, Look
from planner.plots.sheet import Sheet

_ROWS, _COLUMNS = 2, 3
_LEFT, _BOTTOM, _RIGHT, _BETWEEN, _BELOW, _HEIGHT, _TITLE = 5.4, 4.2, 1.8, 3.0, 6.4, 17.0, 1.8  # em
_FLOOR_MM = 1e-9
"""Errors are drawn no smaller: there they are the rounding of numbers."""


def plot_distributions(comparison: Comparison, look: Look = USUAL) -> Figure:
    """Cumulative shares of all targets, those that are not solved counted as never reached: position error, iterations,
    distance to the limits, change of configuration on another visit, manipulability, and the tip's sensitivity.
    Errors: UsageError where no method solves a target."""
    arm = comparison.arm
    able = shown(comparison)
    with look.style():
        sheet = Sheet(look)
        width = (sheet.width - _LEFT - _RIGHT - (_COLUMNS - 1) * _BETWEEN) / _COLUMNS
        panels = [
            sheet.panel(
                _LEFT + column * (width + _BETWEEN), _BOTTOM + (_ROWS - 1 - row) * (_HEIGHT + _BELOW), width, _HEIGHT
            )
            for row in range(_ROWS)
            for column in range(_COLUMNS)
        ]
        for axes, (title, label, scale) in zip(panels, _PANELS, strict=True):
            axes.set_title(title, loc="left", size=1.15 * look.letter_pt, weight="bold")
            axes.set_xlabel(label)
            axes.set_xscale(scale)
            axes.set_ylim(0.0, 102.0)
            if scale == "linear":
                axes.ticklabel_format(axis="x", scilimits=(-2, 4), useMathText=True)
        for result, measured in able:
            for axes, values in zip(panels, _values(arm, result, measured), strict=True):
                _draw_shares(axes, values, len(measured.solved), result)
        limits = panels[2]
        limits.axvline(0.0, color=look.colours.limit, linewidth=0.9, linestyle=LIMIT_DASHES)
        left, right = limits.get_xlim()
        right = max(right, 10.0)
        limits.axvspan(0.0, right, color=look.colours.limit, alpha=0.13, linewidth=0)
        limits.set_xlim(left, right)
        for place, axes in enumerate(panels):
            if place % _COLUMNS:
                axes.tick_params(labelleft=False)
            else:
                axes.set_ylabel("share of the targets (%)")
        count = len(comparison.targets.tips_mm)
        remark = (
            f"{count} random targets on the paper, each from the start; a curve that ends below 100 % leaves the "
            "rest unsolved"
        )
        return sheet.finish(f"methods on {arm.name}", remark, method_handles([result for result, _ in able]), _TITLE)


_PANELS = (
    ("Position error", "at most (mm)", "log"),
    ("Iterations", "at most", "log"),
    ("Beyond a limit", "at most, in parts of the joint's range (%); < 0 inside", "linear"),
    ("Same target again", "largest change of a joint, at most (deg or mm)", "log"),
    ("Manipulability", "at most (mm, rad)", "linear"),
    ("Tip sensitivity", "error along the paper, at most (mm per degree, rms)", "linear"),
)


def _values(arm: Arm, result: MethodResult, measured: Measured) -> list[FloatArray]:
    """For each panel the figures of the solved targets; none of iterations where a method has none."""
    solved = measured.solved
    joints = measured.joints[solved]
    again = arm.to_file_units(np.abs(measured.joints - measured.again)[solved & measured.solved_again])
    return [
        np.maximum(measured.error_mm[solved], _FLOOR_MM),
        np.maximum(measured.iterations[solved], 1.0) if result.method.iterates else np.empty(0),
        100 * (beyond_limits(arm, joints) / (arm.maximum - arm.minimum)).max(axis=1),
        np.maximum(again.max(axis=1), _FLOOR_MM),
        manipulability(arm, joints),
        sideways_error(arm, joints),
    ]


def _draw_shares(axes: Axes, values: FloatArray, count: int, result: MethodResult) -> None:
    """A step for each value."""
    if not len(values):
        return
    line = line_of(result)
    axes.step(
        np.sort(values),
        100 * np.arange(1, len(values) + 1) / count,
        where="post",
        color=line.colour,
        linestyle=line.dashes,
        linewidth=line.width,
        zorder=line.zorder,
        label=result.method.title,
    )
