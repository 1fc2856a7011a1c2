"""A photo of a drawn sheet, read: where each mark came, and how high the tip was over it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.error_model.photo.assignment import assign, smooth_modes
from planner.error_model.photo.camera import Camera, fit_camera
from planner.error_model.photo.errors import PhotoError
from planner.error_model.photo.ink import InkMap, ink_map
from planner.error_model.photo.picture import Picture
from planner.error_model.photo.strokes import Spots, find_spots
from planner.error_model.photo.tags import SeenTags, find_tags
from planner.error_model.photo.touch_downs import ink_begins
from planner.error_model.sheet.layout import BAR_MM, SheetLayout
from planner.error_model.sheet.marks import Mark, TouchDown, extent_mm, places_mm
from planner.error_model.sheet.modes import modes_mm

_STRAY_MM = 12.0
_LEAST_PX_PER_MM = 1.5
_FEWEST = 4
_TANGLED_MM = 0.4  # sd of a mark whose stroke has run into others
_MOST = 0.8  # of all marks: with fewer a sheet does not tell enough by itself
_BLOT_PX, _BLOT_MM = 0.1, 0.08  # sd of a blot's middle: of the picture, and of ink that is no perfect one
_WAVY_MM = 0.15


@dataclass(frozen=True, eq=False, slots=True)
class Contact:
    """How high the tip was over the paper, and where ink of its stroke begins, and its mark is (2, 2), mm."""

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
    camera = fit_camera(source, tags, picture.shape)
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
    spots = find_spots(ink)
    modes = modes_mm(marks)
    assignment = assign(
        places_mm(marks),
        layout.to_sheet_mm(spots.blots_mm),
        np.array([_may_be(spots, layout, mark) for mark in marks]),
        smooth_modes(places_mm(marks)) if modes is None else modes,
    )
    if np.sum(assignment >= 0) < min(_FEWEST, len(marks)):  # so few may be specks
        raise PhotoError(
            source,
            "no marks are on the sheet; photograph it once the pattern is drawn, and if the pen never came to the "
            "paper, set its height first (plan jog)",
        )
    scale = np.array([bars_mm[1], bars_mm[0]]) / BAR_MM
    found = np.flatnonzero(assignment >= 0).tolist()
    rests = [_rest_of(spots, assignment[index], layout, marks[index]) for index in found]
    blots, smeared = (np.array(each) for each in zip(*rests, strict=True))
    sd = np.sqrt(
        camera.sd_mm(blots) ** 2 + (_BLOT_PX / camera.px_per_mm(blots)[..., 0]) ** 2 + _BLOT_MM**2 + smeared**2
    )
    measured = [
        MeasuredMark(
            marks[index],
            scale * layout.to_sheet_mm(blot),
            float(spread),
            _contact(ink, blot, spots, assignment[index], layout, marks[index], np.delete(blots, k, axis=0), scale),
        )
        for k, (index, blot, spread) in enumerate(zip(found, blots, sd, strict=True))
    ]
    missing = tuple(mark for index, mark in enumerate(marks) if assignment[index] < 0)
    return Reading(layout, camera, tags, tuple(measured), missing, scale, _warnings(camera, tags, measured, len(marks)))


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


def _may_be(spots: Spots, layout: SheetLayout, mark: Mark) -> BoolArray:
    """(m,) which spots a mark can be."""
    return spots.could_be_strokes(*_way_of(layout, mark.touch_down)) if mark.touch_down else spots.could_be_dots()


def _rest_of(spots: Spots, spot: int, layout: SheetLayout, mark: Mark) -> tuple[FloatArray, float]:
    """(2,) on the page: the mark, which is one of the spots; and the sd that its ink leaves."""
    if mark.touch_down is None:
        return spots.blots_mm[spot], 0.0
    if not spots.is_whole[spot]:
        return spots.blots_mm[spot], _TANGLED_MM
    return spots.rest_mm(spot, _way_of(layout, mark.touch_down)[0])


def _way_of(layout: SheetLayout, touch: TouchDown) -> tuple[FloatArray, float]:
    """The direction (2,) of a stroke on the page, and how long it is from where a tip without error begins it."""
    start, end = layout.to_page_mm(np.array([touch.start_mm, touch.end_mm]))
    length = float(np.linalg.norm(end - start))
    return (end - start) / length, length


def _contact(
    ink: InkMap,
    rest_mm: FloatArray,
    spots: Spots,
    spot: int,
    layout: SheetLayout,
    mark: Mark,
    others_mm: FloatArray,
    scale: FloatArray,
) -> Contact | None:
    """What the stroke of a mark tells, that is one of the spots.

    rest (2,), others (n, 2): where its pen rested, and those of other marks, on the page. None where it has none, or
    none is seen."""
    if mark.touch_down is None or not spots.is_whole[spot]:
        return None
    way, length = _way_of(layout, mark.touch_down)
    begin = ink_begins(ink, rest_mm, spots.axis(spot, way), length, others_mm)
    if begin is None:
        return None
    pressed = mark.touch_down.slope * float((scale[::-1] * (rest_mm - begin)) @ way)
    return Contact(-pressed, scale * layout.to_sheet_mm(np.array([begin, rest_mm])))


def _warnings(camera: Camera, tags: SeenTags, measured: Sequence[MeasuredMark], n_marks: int) -> tuple[str, ...]:
    found = []
    per_mm = float(camera.px_per_mm(tags.page_mm.mean(axis=1)).mean())
    off = camera.residual_px / per_mm
    if off > _WAVY_MM:
        found.append(
            f"the tags are {off:.2f} mm from where they should be: the paper is not flat, or the picture is "
            "blurred; the marks are as uncertain"
        )
    if len(measured) < _MOST * n_marks:
        found.append(
            f"only {len(measured)} of {n_marks} marks were read: the pen was too high or too low for many; "
            "calibrate with these, and draw and photograph another sheet with the calibrated arm"
        )
    return tuple(found)
