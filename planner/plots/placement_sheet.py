"""A sheet to print at true size: where the base stands, where the paper lies, what the arm reaches."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.errors import PlanError
from planner.workspace.canvas import Canvas

_MM_PER_INCH = 25.4
_PAGES_MM = {
    "A4": (210.0, 297.0),
    "A3": (297.0, 420.0),
    "A2": (420.0, 594.0),
    "A1": (594.0, 841.0),
    "A0": (841.0, 1189.0),
}
_EDGE_MM = 7.0
"""What printers leave white."""
_RINGS_MM = (10.0, 20.0, 30.0, 40.0)
_LEVEL = 0.99
"""Cosine of the tilt up to which a base stands on the paper's plane."""
_WORDS_MM = 20.0
_BAR_MM = 100.0
_BAR_ROOM_MM = 6.0
_CROSS_MM = 6.0
_INK, _QUIET = "#000000", "#808080"


def plot_placement_sheet(
    canvas: Canvas,
    sheet: Canvas | None,
    ring_mm: tuple[float, float] | None,
    arm_name: str,
    words: str,
    paper: PaperPose,
) -> tuple[Figure, str]:
    """The page, seen from behind the arm with its base at the bottom, and what paper it is for.

    canvas: what is drawn on; sheet: the paper that lies there, if somebody said which; both arm mm. ring_mm: inner and
    outer radius of what the arm reaches, where that is a ring. paper: where it lies; the base is shown where it stands
    on the paper's plane, or nearly so. Errors: PlanError
    where no paper that is made holds it.
    """
    shown = sheet or canvas
    x, y, off = paper.T_paper_base[:3, 3].tolist()
    stands = paper.normal[2] > _LEVEL and abs(off) < _RINGS_MM[-1]
    corners = [shown.corners_arm_mm, canvas.corners_arm_mm]
    if stands:
        corners.append(np.array([x, y]) + np.array([[-_RINGS_MM[-1]] * 2, [_RINGS_MM[-1]] * 2]))
    lowest, highest = np.concatenate(corners).min(axis=0), np.concatenate(corners).max(axis=0)
    low = np.array([lowest[1], lowest[0] - _BAR_ROOM_MM])
    high = np.array([highest[1], highest[0] + _WORDS_MM])
    name, page = _page_for(high - low + 2 * _EDGE_MM)
    figure = Figure(figsize=(page[0] / _MM_PER_INCH, page[1] / _MM_PER_INCH))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    middle = (low[0] + high[0]) / 2
    # y of the arm grows to the left.
    axes.set_xlim(middle + page[0] / 2, middle - page[0] / 2)
    axes.set_ylim(low[1] - _EDGE_MM, low[1] - _EDGE_MM + page[1])
    axes.set_axis_off()
    if stands:
        axes.axvline(y, color=_QUIET, linewidth=0.4, dashes=(12, 4))
        _base(axes, x, y)
    if ring_mm is not None:
        _reach(axes, ring_mm, x, y)
    _rectangle(axes, canvas, dashes=(3, 2))
    if sheet is not None:
        _rectangle(axes, sheet)
    _corners(axes, shown, paper)
    _bar(axes, low, middle)
    text_left = min(middle + page[0] / 2 - _EDGE_MM, high[0])
    top = high[1] - 5.0
    axes.text(text_left, top, f"Where the paper lies before {arm_name}", fontsize=11, fontweight="bold", va="bottom")
    axes.text(text_left, top - 2.0, f"{words}. Print on {name} at 100 %.", fontsize=7, va="top", color=_QUIET)
    return figure, name


def _page_for(size: FloatArray) -> tuple[str, tuple[float, float]]:
    for name, (short, long) in _PAGES_MM.items():
        for page in ((long, short), (short, long)):
            if size[0] <= page[0] and size[1] <= page[1]:
                return name, page
    raise PlanError(f"what the arm draws on is {size[0]:.0f} x {size[1]:.0f} mm: no paper is as large as that")


def _base(axes: Axes, x: float, y: float) -> None:
    """Rings to centre the base by."""
    angles = np.linspace(0.0, 2.0 * np.pi, 181)
    for radius in _RINGS_MM:
        axes.plot(y + radius * np.cos(angles), x + radius * np.sin(angles), color=_QUIET, linewidth=0.4)
        axes.text(y - radius * 0.71, x + radius * 0.71, f"{radius:g}", fontsize=5, color=_QUIET)
    axes.plot([y - _RINGS_MM[-1], y + _RINGS_MM[-1]], [x, x], color=_QUIET, linewidth=0.4)
    axes.text(y - 1.5, x - 4.0, "axis of the base", fontsize=5.5, color=_QUIET)


def _reach(axes: Axes, reach_mm: tuple[float, float], x: float, y: float) -> None:
    angles = np.linspace(-np.pi / 2, np.pi / 2, 361)
    for radius in reach_mm:
        axes.plot(y + radius * np.sin(angles), x + radius * np.cos(angles), color=_QUIET, linewidth=0.3, dashes=(1, 3))


def _rectangle(axes: Axes, rectangle: Canvas, dashes: tuple[float, float] | None = None) -> None:
    x, y = np.concatenate((rectangle.corners_arm_mm, rectangle.corners_arm_mm[:1])).T
    (line,) = axes.plot(y, x, color=_INK, linewidth=0.5)
    if dashes:
        line.set_dashes(dashes)


def _corners(axes: Axes, shown: Canvas, paper: PaperPose) -> None:
    """Crosses, with where in the base frame they are."""
    middle = (shown.left_mm + shown.right_mm) / 2
    places = paper.to_base(np.column_stack((shown.corners_arm_mm, np.zeros(4))))[:, : 2 if paper.is_base_plane else 3]
    for (x, y), place in zip(shown.corners_arm_mm.tolist(), np.round(places) + 0.0, strict=True):
        axes.plot([y - _CROSS_MM, y + _CROSS_MM], [x, x], color=_INK, linewidth=0.8)
        axes.plot([y, y], [x - _CROSS_MM, x + _CROSS_MM], color=_INK, linewidth=0.8)
        axes.text(
            y + (-1 if y < middle else 1),
            x + 1.0,
            "(" + ", ".join(f"{value:.0f}" for value in place) + ")",
            fontsize=5.5,
            ha="left" if y < middle else "right",
        )


def _bar(axes: Axes, low: FloatArray, middle: float) -> None:
    """To check the printer's scale by."""
    bottom = low[1] + 1.5
    axes.plot([middle + _BAR_MM / 2, middle - _BAR_MM / 2], [bottom, bottom], color=_INK, linewidth=0.8)
    for end in (middle + _BAR_MM / 2, middle - _BAR_MM / 2):
        axes.plot([end, end], [bottom - 1.5, bottom + 1.5], color=_INK, linewidth=0.8)
    axes.text(middle, bottom + 0.8, f"must be {_BAR_MM:g} mm", fontsize=6, ha="center")
