"""The picture of what was read off a photo of a calibration sheet, over the photo itself, seen from straight above."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from planner.arrays import FloatArray
from planner.error_model.photo.ink import from_above
from planner.error_model.photo.picture import Picture
from planner.error_model.photo.reading import Reading
from planner.plots.look import USUAL, Look
from planner.plots.sheet import Sheet

_PX_PER_MM = 8.0
_LEFT, _BOTTOM, _RIGHT = 1.6, 1.6, 1.6
_PALER = 0.45  # how far the photo is lightened, for what stands over it to be seen


def plot_reading(picture: Picture, reading: Reading, source: str, look: Look = USUAL) -> Figure:
    """Where each mark was meant and where it came, its number and its height, the touch-down lines, the tags that were
    read, and what was not found, over the photo. source: what the photo is called."""
    low, high = np.zeros(2), np.array(reading.layout.page.extent_mm)
    photo = from_above(picture, reading.camera, low, high, _PX_PER_MM)[..., ::-1]
    with look.style():
        sheet = Sheet(look)
        width = sheet.width - _LEFT - _RIGHT
        axes = sheet.panel(_LEFT, _BOTTOM, width, width * high[1] / high[0])
        _photo(axes, photo, high)
        _tags(axes, reading, look)
        _marks(axes, reading, look)
        n_marks = len(reading.measured) + len(reading.missing)
        heights = sum(mark.contact is not None for mark in reading.measured)
        remark = (
            f"{len(reading.measured)} of {n_marks} marks and {heights} heights, from {len(reading.tags.page_mm)} "
            f"tags of sheet {reading.layout.name}; seen from straight above, the base below"
        )
        return sheet.finish(source, remark, axes.get_legend_handles_labels()[0])


def _photo(axes: Axes, photo: NDArray[np.uint8], extent_mm: FloatArray) -> None:
    pale = 255 - (1 - _PALER) * (255.0 - photo)
    axes.imshow(pale.astype(np.uint8), extent=(0.0, extent_mm[0], 0.0, extent_mm[1]), interpolation="antialiased")
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)


def _tags(axes: Axes, reading: Reading, look: Look) -> None:
    for index, corners in enumerate(reading.tags.page_mm):
        axes.fill(
            *corners.T,
            facecolor="none",
            edgecolor=look.colours.lifting,
            linewidth=0.15 * look.letter_pt,
            label="_" if index else "tag",
        )


def _marks(axes: Axes, reading: Reading, look: Look) -> None:
    layout, colours, letter = reading.layout, look.colours, look.letter_pt
    for index, measured in enumerate(reading.measured):
        label = "_" if index else ""
        meant = layout.to_page_mm(np.array(measured.mark.place_mm))
        found = layout.to_page_mm(measured.place_mm / reading.scale)
        axes.plot(
            *np.array([meant, found]).T,
            color=colours.wanted,
            linewidth=0.12 * letter,
            zorder=2,
            label=label or "from where a mark was meant",
        )
        axes.plot(
            *found,
            linestyle="none",
            marker="o",
            markersize=0.55 * letter,
            markerfacecolor="none",
            markeredgecolor=colours.drawn,
            markeredgewidth=0.09 * letter,
            zorder=4,
            label=label or "mark",
        )
        _note(axes, f"{measured.mark.number}", found, colours.ink, look, to_left=True)
    contacts = [measured.contact for measured in reading.measured if measured.contact]
    for index, contact in enumerate(contacts):
        ends = layout.to_page_mm(contact.ends_mm / reading.scale)
        axes.plot(
            *ends.T,
            color=colours.limit,
            linewidth=0.1 * letter,
            zorder=3,
            label="_" if index else "touch-down, and height in mm",
        )
        _note(axes, f"{contact.height_mm:+.1f}".replace("-", "\N{MINUS SIGN}"), ends[1], colours.limit, look)
    for index, mark in enumerate(reading.missing):
        place = layout.to_page_mm(np.array(mark.place_mm))
        axes.plot(
            *place,
            linestyle="none",
            marker="x",
            color=colours.limit,
            markersize=0.7 * letter,
            zorder=4,
            label="_" if index else "not found",
        )
        _note(axes, f"{mark.number}", place, colours.limit, look, to_left=True)


def _note(axes: Axes, words: str, place: FloatArray, colour: str, look: Look, *, to_left: bool = False) -> None:
    side = -1 if to_left else 1
    axes.annotate(
        words,
        (place[0], place[1]),
        (0.45 * side * look.letter_pt, 0.0),
        textcoords="offset points",
        ha="right" if to_left else "left",
        va="center",
        fontsize=0.55 * look.letter_pt,
        color=colour,
        zorder=5,
    )
