"""A photo of a drawn sheet, read: where each mark came, and how high the tip was over it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.error_model.photo.assignment import assign, smooth_modes
from planner.error_model.photo.camera import Camera, fit_camera
from planner.error_model.photo.dots import find_dots
from planner.error_model.photo.errors import PhotoError
from planner.error_model.photo.ink import InkMap, ink_map
from planner.error_model.photo.picture import Picture
from planner.error_model.photo.tags import SeenTags, find_tags
from planner.error_model.photo.touch_downs import height_mm, touch_down_span
from planner.error_model.sheet.layout import BAR_MM, SheetLayout
from planner.error_model.sheet.marks import Mark, extent_mm, places_mm
from planner.error_model.sheet.modes import modes_mm

_STRAY_MM = 12.0
_LEAST_PX_PER_MM = 1.5
_DOT_PX, _DOT_MM = 0.1, 0.02  # sd of a dot's middle: of the picture, and of ink that is no perfect dot
_SMEAR = 0.25  # of what a dot is longer than wide, as the sd of its middle
_WAVY_MM = 0.15


@dataclass(frozen=True, eq=False, slots=True)
class Contact:
    """How high the tip was over the paper, and where the touch-down line that tells it begins and ends (2, 2), mm."""

    height_mm: float
    ends_mm: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class MeasuredMark:
    """Where a mark came, mm on the sheet, with the standard deviation of each coordinate; its touch-down, None where
    that was not seen."""

    mark: Mark
    place_mm: FloatArray
    sd_mm: float
    contact: Contact | None


@dataclass(frozen=True, eq=False, slots=True)
class Reading:
    """All that was read. Lengths are as a sheet printed at true size would have them, times `scale` along x and y
    (2,)."""

    layout: SheetLayout
    camera: Camera
    tags: SeenTags
    measured: tuple[MeasuredMark, ...]
    missing: tuple[Mark, ...]
    scale: FloatArray
    warnings: tuple[str, ...]


def read_sheet(
    source: str, picture: Picture, marks: Sequence[Mark], bars_mm: tuple[float, float] = (BAR_MM, BAR_MM)
) -> Reading:
    """Read a picture of the sheet for some marks.

    bars_mm: how long the printed bars are by a ruler, the one across the page and the one along it.
    Errors: PhotoError where the picture does not show the sheet, or shows it too small, or without ink.
    """
    tags = find_tags(source, picture, marks)
    camera = fit_camera(tags, picture.shape)
    layout = tags.layout
    meant = layout.to_page_mm(places_mm(marks))
    finest = float(camera.px_per_mm(meant)[..., 0].min())
    if finest < _LEAST_PX_PER_MM:
        raise PhotoError(
            source,
            f"the sheet is too small in it, {finest:.1f} pixels to a millimetre where there are "
            f"least; it takes {_LEAST_PX_PER_MM:g}: go nearer, or hold the camera more from above",
        )
    ink = _ink_of(picture, camera, layout, marks)
    dots = find_dots(ink)
    modes = modes_mm(marks)
    assignment = assign(
        places_mm(marks),
        layout.to_sheet_mm(dots.places_mm),
        dots.ink_mm2,
        smooth_modes(places_mm(marks)) if modes is None else modes,
    )
    if np.all(assignment < 0):
        raise PhotoError(source, "no marks are on the sheet; photograph it once the pattern is drawn")
    scale = np.array([bars_mm[1], bars_mm[0]]) / BAR_MM
    found = [index for index, dot in enumerate(assignment) if dot >= 0]
    chosen = dots.only(assignment[found])
    contacts = _touch_downs(ink, layout, [marks[index] for index in found], chosen.places_mm)
    sd = np.sqrt(
        camera.sd_mm(chosen.places_mm) ** 2
        + (_DOT_PX / camera.px_per_mm(chosen.places_mm)[..., 0]) ** 2
        + _DOT_MM**2
        + (_SMEAR * chosen.smear_mm) ** 2
    )
    measured = [
        MeasuredMark(marks[index], place, float(spread), contact)
        for index, place, spread, contact in zip(
            found, scale * layout.to_sheet_mm(chosen.places_mm), sd, contacts, strict=True
        )
    ]
    missing = tuple(mark for index, mark in enumerate(marks) if assignment[index] < 0)
    return Reading(layout, camera, tags, tuple(measured), missing, scale, _warnings(camera, tags, measured))


def _ink_of(picture: Picture, camera: Camera, layout: SheetLayout, marks: Sequence[Mark]) -> InkMap:
    """The ink near where marks are meant, what is printed there left out."""
    ends = layout.to_page_mm(np.array(extent_mm(marks)))
    low, high = layout.ink_page_mm
    return ink_map(
        picture,
        camera,
        np.maximum(ends.min(axis=0) - _STRAY_MM, low),
        np.minimum(ends.max(axis=0) + _STRAY_MM, high),
        np.concatenate((layout.bars_page_mm, layout.ticks_page_mm)),
    )


def _touch_downs(
    ink: InkMap, layout: SheetLayout, marks: Sequence[Mark], places_mm: FloatArray
) -> list[Contact | None]:
    """The touch-down of each mark, found at a place (n, 2) on the page; None where it has none, or none is seen."""
    moved = {}
    for index, (mark, place) in enumerate(zip(marks, places_mm, strict=True)):
        if mark.touch_down:
            meant = layout.to_page_mm(np.array([mark.place_mm, mark.touch_down.start_mm, mark.touch_down.end_mm]))
            moved[index] = meant[1:] + place - meant[0]
    found: list[Contact | None] = []
    for index, mark in enumerate(marks):
        contact = mark.touch_down
        if contact is None:
            found.append(None)
            continue
        start, end = moved[index]
        others = np.array([*places_mm, *(line[1] for number, line in moved.items() if number != index)])
        span = touch_down_span(ink, start, end, others)
        along = (end - start) / np.linalg.norm(end - start)
        found.append(
            None
            if span is None
            else Contact(height_mm(contact, span), layout.to_sheet_mm(start + np.outer(span, along)))
        )
    return found


def _warnings(camera: Camera, tags: SeenTags, measured: Sequence[MeasuredMark]) -> tuple[str, ...]:
    found = []
    per_mm = float(camera.px_per_mm(tags.page_mm.mean(axis=1)).mean())
    off = camera.residual_px / per_mm
    if off > _WAVY_MM:
        found.append(
            f"the tags are {off:.2f} mm from where they should be: the paper is not flat, or the picture is "
            "blurred; the marks are as uncertain"
        )
    return tuple(found)
