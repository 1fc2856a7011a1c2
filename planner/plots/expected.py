"""The picture of what an arm is expected to make of a drawing: a band round the lines, a map over the paper, causes."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from scipy.spatial import cKDTree

from planner.arrays import BoolArray, FloatArray
from planner.error_model.cause import Cause
from planner.error_model.prediction import Along, Prediction
from planner.plots.coloured_path import N_LEVELS
from planner.plots.look import USUAL, Look
from planner.plots.paper import BASE, PAPER_BOTTOM, PAPER_LEFT, PAPER_RIGHT, pieces, place_axes
from planner.plots.paper_extent import view_mm
from planner.plots.sheet import Sheet

_95_OF_100 = 1.96
_MAY_BE_MISSING = 0.1
"""Where so many of the arms leave no ink it is marked."""
_LOWEST, _TITLE = 10.0, 2.0  # em
_BAR, _BAR_GAP, _BAR_LABELS = 1.2, 1.2, 4.6
_ROW, _CAUSES_BOTTOM, _CAUSES_GAP = 1.9, 1.0, 3.2
_MOST_CAUSES, _LEAST_MM = 5, 0.005
_LONGEST = 0.2
"""Of the width of the causes' panel, of the dearest of them."""
_WIDTHS = 24
"""Widths of the band that are told apart."""
_CELLS = 180
_SMOOTH = 0.025
"""Of the longer side of the map: how far places speak for their neighbours, and half of how far the map goes."""
_AT_ONCE = 2_000


def plot_expected(prediction: Prediction, heading: str, remark: str, look: Look = USUAL) -> Figure:
    """On the left the lines with the band that 95 of 100 arms stay in, one arm's lines, and where ink may be missing;
    on the right the expected error near the lines; below what it comes from."""
    along, colours = prediction.along, look.colours
    band_mm = _95_OF_100 * along.off_mm
    around = [along.meant_mm + band_mm[:, None], along.meant_mm - band_mm[:, None], along.one_mm[along.one_inks]]
    low, high = view_mm(around, None, None)
    causes = [cause for cause in prediction.causes if cause.mm >= _LEAST_MM][:_MOST_CAUSES]
    with look.style():
        sheet = Sheet(look)
        bottom = PAPER_BOTTOM + (_CAUSES_BOTTOM + _ROW * len(causes) + _CAUSES_GAP if causes else 0.0)
        bar = _BAR_GAP + _BAR + _BAR_LABELS
        width = (sheet.width - 2 * PAPER_LEFT - PAPER_RIGHT - bar) / 2
        height = float(np.clip((high[0] - low[0]) * width / (high[1] - low[1]), _LOWEST, 1.25 * sheet.width))
        lines = sheet.panel(PAPER_LEFT, bottom, width, height)
        paper = sheet.panel(2 * PAPER_LEFT + PAPER_RIGHT + width, bottom, width, height)
        for axes, title in ((lines, "expected lines"), (paper, "expected error over the paper")):
            place_axes(axes, low, high, width, colours, None)
            axes.set_title(title, loc="left")
        pt_per_mm = width * look.letter_pt / float(high[1] - low[1])
        legend = _lines(lines, along, band_mm, pt_per_mm, look)
        _map(sheet, paper, along, low, high, look)
        if causes:
            below = sheet.panel(PAPER_LEFT, _CAUSES_BOTTOM, sheet.width - PAPER_LEFT - PAPER_RIGHT, _ROW * len(causes))
            _causes(below, causes, look)
        return sheet.finish(heading, remark, legend, room=_TITLE)


def _lines(axes: Axes, along: Along, band_mm: FloatArray, pt_per_mm: float, look: Look) -> list[Artist]:
    """Draws them; what the legend is to tell of."""
    colours, letter = look.colours, look.letter_pt
    joined = np.diff(along.stroke) == 0
    red, green, blue = 0.28 * np.array(to_rgb(colours.drawn)) + 0.72 * np.array(to_rgb(colours.surface))
    tint = to_hex((red, green, blue))
    widest = np.maximum(band_mm[:-1], band_mm[1:])
    edges = np.linspace(0.0, float(widest.max(initial=0.0)) + 1e-9, _WIDTHS + 1)
    level = np.searchsorted(edges, widest)
    for one in np.unique(level[joined]).tolist():
        _piece(axes, along.meant_mm, joined & (level == one), tint, 2 * edges[one] * pt_per_mm, 1.5)
    _piece(axes, along.meant_mm, joined, colours.wanted, 0.2 * letter, 2, label="wanted")
    inks = along.one_inks[:-1] & along.one_inks[1:]
    _piece(axes, along.one_mm, joined & inks, colours.drawn, 0.09 * letter, 3, label="one such arm")
    missing = along.missing >= _MAY_BE_MISSING
    label = f"ink may be missing ({100 * _MAY_BE_MISSING:.0f} of 100 arms or more)"
    _piece(axes, along.meant_mm, joined & (missing[:-1] | missing[1:]), colours.limit, 0.12 * letter, 3.5, label, ":")
    named, labels = axes.get_legend_handles_labels()
    band = Patch(color=tint, label="where 95 of 100 such arms draw it")
    return [*(line for line, label in zip(named, labels, strict=True) if label != BASE), band]


def _piece(
    axes: Axes,
    xy: FloatArray,
    joined: BoolArray,
    color: str,
    width_pt: float,
    zorder: float,
    label: str | None = None,
    style: str = "-",
) -> None:
    line = pieces(xy, joined)
    if len(line):
        axes.plot(
            line[:, 1],
            line[:, 0],
            color=color,
            linewidth=width_pt,
            zorder=zorder,
            label=label,
            linestyle=style,
            dash_capstyle="butt",
        )


def _map(sheet: Sheet, axes: Axes, along: Along, low: FloatArray, high: FloatArray, look: Look) -> None:
    """Error by place, as far from the lines as they tell of it."""
    colours = look.colours
    smooth_mm = _SMOOTH * float((high - low).max())
    size = np.maximum(np.rint(_CELLS * (high - low) / (high - low).max()), 1).astype(np.int64)
    places = [low[k] + (np.arange(size[k]) + 0.5) * (high[k] - low[k]) / size[k] for k in (0, 1)]
    weight, total = np.zeros(tuple(size)), np.zeros(tuple(size))
    for begin in range(0, len(along.meant_mm), _AT_ONCE):
        some = slice(begin, begin + _AT_ONCE)
        near = [np.exp(-(((places[k][:, None] - along.meant_mm[some, k]) / smooth_mm) ** 2) / 2) for k in (0, 1)]
        weight += near[0] @ near[1].T
        total += (near[0] * along.off_mm[some] ** 2) @ near[1].T
    grid = np.stack(np.meshgrid(*places, indexing="ij"), axis=-1)
    told = cKDTree(along.meant_mm).query(grid)[0] <= 2 * smooth_mm
    error = np.where(told, np.sqrt(total / np.maximum(weight, 1e-12)), np.nan)
    image = axes.imshow(
        error[:, ::-1],
        extent=(high[1], low[1], low[0], high[0]),
        origin="lower",
        cmap=colours.colour_map(N_LEVELS),
        vmin=0.0,
        vmax=float(np.nanmax(error)) or 1.0,
        interpolation="bilinear",
        zorder=1,
    )
    axes.set_xlim(high[1], low[1])
    axes.set_ylim(low[0], high[0])
    _piece(axes, along.meant_mm, np.diff(along.stroke) == 0, colours.surface, 0.05 * look.letter_pt, 3)
    bar = sheet.beside(axes, _BAR_GAP, _BAR)
    sheet.figure.colorbar(image, cax=bar, label="rms over such arms (mm)", ticks=MaxNLocator(6))


def _causes(axes: Axes, causes: list[Cause], look: Look) -> None:
    rows = -np.arange(len(causes))
    axes.barh(rows, [cause.mm for cause in causes], height=0.62, color=look.colours.drawn)
    longest = causes[0].mm
    axes.set_xlim(0.0, longest / _LONGEST)
    axes.set_ylim(-len(causes) + 0.5, 0.5)
    axes.axis("off")
    axes.set_title("what it comes from", loc="left")
    for row, cause in zip(rows.tolist(), causes, strict=True):
        axes.annotate(
            cause.text(),
            (cause.mm, row),
            (0.6 * look.letter_pt, 0.0),
            textcoords="offset points",
            va="center_baseline",
            fontsize=0.92 * look.letter_pt,
        )
