"""The paper in front of an arm, as seen by a person sitting behind it, on the side of its base: the base at the
bottom, arm x up the picture and arm y to the left. So seated, a drawing reads as it does on a screen.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon, Rectangle, Wedge
from matplotlib.ticker import MultipleLocator

from planner.arms.paper_pose import PaperPose
from planner.arrays import BoolArray, FloatArray
from planner.plots.look import Colours
from planner.plots.paper_extent import base_of, view_mm
from planner.plots.sheet import Sheet

PAPER_LEFT, PAPER_BOTTOM, PAPER_RIGHT = 5.4, 4.2, 1.8
"""Em around the axes of a paper, for the numbers on them."""
BASE = "base of the arm"
_TICK_EM = 5.5  # a label such as -120, with room beside it


def paper_panel(
    sheet: Sheet,
    lines_mm: Sequence[FloatArray],
    canvas_corners_mm: FloatArray | None,
    reach_mm: tuple[float, float] | None,
    *,
    paper: PaperPose,
    bottom: float = 0.0,
    right: float = 0.0,
) -> Axes:
    """A panel that shows the paper with all of some lines (n, 2), as wide as the sheet and as high as it needs to be,
    with the ring and the canvas in it where they are known. paper: where it lies. bottom, right: em left free beside
    it."""
    base_mm = base_of(paper)
    canvas = np.empty((0, 2)) if canvas_corners_mm is None else np.asarray(canvas_corners_mm, dtype=np.float64)
    low, high = view_mm([*lines_mm, canvas], reach_mm, base_mm)
    width = sheet.width - PAPER_LEFT - PAPER_RIGHT - right
    height = float(np.clip((high[0] - low[0]) * width / (high[1] - low[1]), 18.0, 1.25 * sheet.width))
    axes = sheet.panel(PAPER_LEFT, bottom + PAPER_BOTTOM, width, height)
    place_axes(axes, low, high, width, sheet.look.colours, base_mm)
    if reach_mm is not None:
        axes.add_patch(half_ring(reach_mm, sheet.look.colours, base_mm))
    if len(canvas):
        axes.add_patch(canvas_outline(canvas, sheet.look.colours))
    return axes


def place_axes(
    axes: Axes,
    low: FloatArray,
    high: FloatArray,
    width_em: float,
    colours: Colours,
    base_mm: tuple[float, float] | None,
) -> None:
    """Axes as seen from behind the base, the base marked, if it is to be: arm y grows to the left, arm x upwards.

    width_em: of the axes, so that the ticks get room. base_mm: where the base stands in the paper's frame.
    """
    axes.set_xlim(high[1], low[1])
    axes.set_ylim(low[0], high[0])
    axes.set_aspect("equal", adjustable="box")
    tick_mm = round_step(float(high[1] - low[1]) / max(width_em / _TICK_EM, 3.5))
    axes.xaxis.set_major_locator(MultipleLocator(tick_mm))
    axes.yaxis.set_major_locator(MultipleLocator(tick_mm))
    axes.set_xlabel("arm y (mm)")
    axes.set_ylabel("arm x (mm)")
    if base_mm is None:
        return
    axes.plot(
        base_mm[1],
        base_mm[0],
        linestyle="none",
        marker="^",
        markersize=float(np.clip(0.12 * width_em, 4, 8)),
        color=colours.ink,
        markeredgewidth=0,
        zorder=4,
        label=BASE,
    )


def half_ring(
    reach_mm: tuple[float, float], colours: Colours, base_mm: tuple[float, float], *, face: str | None = None
) -> Wedge:
    """What the pen reaches in front of the base, between two radii."""
    inner, outer = reach_mm
    return Wedge(
        base_mm[::-1],
        outer,
        0.0,
        180.0,
        width=outer - inner,
        facecolor=face or colours.ring,
        edgecolor=colours.ring_edge,
        linewidth=0.6,
        zorder=0,
        label="reach of the pen",
    )


def canvas_outline(
    corners_mm: FloatArray, colours: Colours, *, face: str | None = None, edge: str | None = None
) -> Polygon:
    """The canvas from its corners (4, 2) in arm coordinates."""
    return Polygon(
        corners_mm[:, ::-1],
        closed=True,
        facecolor=face or colours.surface,
        edgecolor=edge or colours.edge,
        linewidth=0.7,
        zorder=1,
        label="canvas",
    )


def pt_per_mm_of(sheet: Sheet, axes: Axes) -> float:
    """Points to a millimetre on axes of that sheet, across."""
    width_em = sheet.width_of(axes)
    across = axes.get_xlim()
    return width_em * sheet.look.letter_pt / abs(across[1] - across[0])


def paper_patch(sides_mm: tuple[float, float, float, float], colours: Colours) -> Rectangle:
    """The paper from its sides, in arm coordinates."""
    near, far, right, left = sides_mm
    return Rectangle(
        (right, near),
        left - right,
        far - near,
        facecolor=colours.paper,
        edgecolor=colours.paper_edge,
        linewidth=0.8,
        zorder=1.1,
        label="paper",
    )


def pieces(xy: FloatArray, joined: BoolArray) -> FloatArray:
    """The points (n, 2) that are joined to a neighbour, in order, with a row of NaN after each piece.

    joined: (n - 1,) whether a line goes from each point to the next.
    """
    after = np.concatenate((joined, [False]))
    before = np.concatenate(([False], joined))
    used = after | before
    found: FloatArray = np.insert(xy[used], np.flatnonzero(~after[used]) + 1, np.nan, axis=0)
    return found


def round_step(least: float) -> float:
    """The least of 1, 2 or 5 times a power of ten that is no less than that."""
    decade: float = 10.0 ** np.floor(np.log10(least))
    return next(step * decade for step in (1, 2, 5, 10) if step * decade >= least * (1 - 1e-9))
