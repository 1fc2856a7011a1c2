"""The picture of a single target: how the documented iterations come to it, beside what the documents print, and the
configuration that each method ends in."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FormatStrFormatter, MaxNLocator

from planner.arrays import FloatArray
from planner.comparison.compare import Comparison
from planner.comparison.convergence import Convergence
from planner.counted import counted
from planner.inverse_kinematics.dls import DOCUMENTED, MM_PER_CM
from planner.kinematics.chain import Kinematics
from planner.plots.comparison_look import Line, line_of, method_handles, shown
from planner.plots.look import LIMIT_DASHES, USUAL, Look
from planner.plots.sheet import Sheet

_LEFT, _BOTTOM, _RIGHT, _BETWEEN, _HEIGHT, _TITLE = 5.4, 4.2, 1.8, 6.2, 22.0, 1.8  # em
_WIDER = 1.15  # the first panel, by the others


def plot_single(comparison: Comparison, look: Look = USUAL) -> Figure:
    """Three panels for the first target: the error by iteration; the links from the side, in the vertical plane through
    base and target; and from above, as seen from behind the base. Errors: UsageError where no method solves it."""
    found, arm = comparison.convergences[0], comparison.arm
    kinematics = Kinematics(arm)
    able = [(result, measured) for result, measured in shown(comparison) if measured.solved[0]]
    configurations = [(line_of(result), measured.joints[0]) for result, measured in able]
    start = Line(look.colours.travel, 1.5, (0, (1, 1.6)))
    with look.style():
        sheet = Sheet(look)
        width = (sheet.width - _LEFT - _RIGHT - 2 * _BETWEEN) / (2 + _WIDER)
        convergence = sheet.panel(_LEFT, _BOTTOM, _WIDER * width, _HEIGHT)
        side = sheet.beside(convergence, _BETWEEN, width)
        above = sheet.beside(side, _BETWEEN, width)
        _draw_convergence(convergence, found, look)
        azimuth = float(np.arctan2(found.target_mm[1], found.target_mm[0]))
        for line, joints in ((start, comparison.start), *configurations):
            corners = _links_mm(kinematics, joints)
            along = corners[:, :2] @ (np.cos(azimuth), np.sin(azimuth))
            for axes, across, up in ((side, along, corners[:, 2]), (above, corners[:, 1], corners[:, 0])):
                axes.plot(
                    across,
                    up,
                    color=line.colour,
                    linestyle=line.dashes,
                    linewidth=line.width,
                    marker="o",
                    markersize=1.6 + line.width,
                    zorder=line.zorder,
                    label="start" if line is start else "_links",
                )
        _finish_views(side, above, found.target_mm, look)
        more = f", the first of {len(comparison.convergences)} targets" if len(comparison.convergences) > 1 else ""
        x, y, z = found.target_mm.tolist()
        return sheet.finish(
            f"{arm.name}: ({x:g}, {y:g}, {z:g}) mm",
            f"{_told(found)}{more}; links of the arm as each method leaves them",
            method_handles([result for result, _ in able]),
            _TITLE,
        )


def _told(found: Convergence) -> str:
    count = len(found.steps) - 1
    ended = "converged" if found.converged else "not converged"
    return f"documented damped least squares {ended} after {counted(count, 'iteration')}"


def _draw_convergence(axes: Axes, found: Convergence, look: Look) -> None:
    """Errors along and across the paper, their tolerances, and the printed figures as rings."""
    errors = np.array([state.error_mm for state in found.steps])
    count = np.arange(len(errors))
    for colour, name, values, tolerance_mm in (
        (look.colours.drawn, "along the paper", np.hypot(errors[:, 0], errors[:, 1]), DOCUMENTED.tolerance_xy_mm),
        (look.colours.limit, "across it", np.abs(errors[:, 2]), DOCUMENTED.tolerance_z_mm),
    ):
        axes.plot(
            count, values, color=colour, linewidth=1.3, marker=".", markersize=4 if len(count) < 40 else 0, label=name
        )
        axes.axhline(
            tolerance_mm, color=colour, linewidth=0.8, linestyle=LIMIT_DASHES, label=f"tolerance, {tolerance_mm:g} mm"
        )
    for index, (along_cm, across_cm) in enumerate((row.error_plane_cm, row.error_height_cm) for row in found.printed):
        axes.plot(
            [index, index],
            [MM_PER_CM * along_cm, MM_PER_CM * across_cm],
            linestyle="none",
            marker="o",
            markersize=6,
            markerfacecolor="none",
            markeredgecolor=look.colours.ink,
            markeredgewidth=0.7,
            label="printed in the documents" if index == 0 else "_printed",
        )
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(FormatStrFormatter("%g"))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel("iteration")
    axes.set_ylabel("error of the tip (mm)")
    axes.set_title("Convergence", loc="left", size=1.15 * look.letter_pt, weight="bold")
    axes.legend(loc="best", fontsize=0.88 * look.letter_pt)


def _links_mm(kinematics: Kinematics, joints: FloatArray) -> FloatArray:
    """(n, 3) corners of the chain of links, from the base to the tip."""
    nodes = kinematics.nodes_mm(kinematics.independent_of(joints)[None])[0]
    corners: FloatArray = np.concatenate((np.zeros((1, 3)), nodes))
    return corners


def _finish_views(side: Axes, above: Axes, target_mm: FloatArray, look: Look) -> None:
    x, y, z = target_mm.tolist()
    side.axhline(0.0, color=look.colours.ink, linewidth=0.8, zorder=1)
    for axes, across, up in ((side, np.hypot(x, y), z), (above, y, x)):
        axes.plot(
            across, up, marker="x", markersize=7, color=look.colours.ink, linestyle="none", label="target", zorder=4
        )
    for axes, title, along, across in (
        (side, "From the side", "towards the target (mm)", "height over the paper (mm)"),
        (above, "From above", "arm y (mm)", "arm x (mm)"),
    ):
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel(along)
        axes.set_ylabel(across)
        axes.set_title(title, loc="left", size=1.15 * look.letter_pt, weight="bold")
        axes.legend(loc="best", fontsize=0.88 * look.letter_pt)
    above.invert_xaxis()
