"""Ink on axes, and its legend."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.patches import Patch

from planner.plots.ink import Ink
from planner.plots.look import Look

_THINNED_DOT = 2.0
"""How wide a dot is beside a line that is shown thinned, for it to be seen."""
_MANY_POINTS = 20_000  # beyond, lines are pixels in SVG and PDF too


def draw_inks(axes: Axes, inks: Sequence[Ink], pt_per_mm: float, zorder: float = 2.0) -> None:
    """Lines and taps at their true width on axes of equal scales."""
    for ink in inks:
        many = sum(map(len, ink.lines)) > _MANY_POINTS
        lines = LineCollection(ink.lines, color=ink.colour, linewidth=ink.width_mm * pt_per_mm, capstyle="round")
        lines.set(zorder=zorder, rasterized=many)
        axes.add_collection(lines, autolim=False)
        sizes = np.full(len(ink.taps), _THINNED_DOT * ink.width_mm if ink.is_thinned else ink.width_mm)
        dots = EllipseCollection(sizes, sizes, 0.0, units="xy", offsets=ink.taps, offset_transform=axes.transData)
        dots.set(facecolor=ink.colour, edgecolor="none", zorder=zorder)
        axes.add_collection(dots, autolim=False)


def legend_of(inks: Sequence[Ink], look: Look) -> list[Artist]:
    """A patch for each pen, with an edge, as ink may have the colour of the ground."""
    return [Patch(facecolor=ink.colour, edgecolor=look.colours.edge, linewidth=0.6, label=ink.label) for ink in inks]
