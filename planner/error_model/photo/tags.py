"""Finding the tags of a sheet in a picture, and which sheet it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.arrays import FloatArray
from planner.error_model.photo.errors import PhotoError
from planner.error_model.photo.picture import LINEAR_LIGHT, Picture
from planner.error_model.sheet.layout import N_DIGITS, N_PLACES, PaperSize, SheetLayout, layout_on, pages_of
from planner.error_model.sheet.marks import Mark
from planner.error_model.sheet.tags import FAMILY, N_MODULES
from planner.error_model.vision import cv2

_WINDOW_MODULES = 0.7

LEAST_TAGS = 6
"""Fewer leave lens and tilt undecided."""


@dataclass(frozen=True, eq=False, slots=True)
class SeenTags:
    """The tags of a sheet that a picture shows: where their corners are in the picture, in px, and on the page, in mm.

    Both (n, 4, 2). Pixel coordinates count from the middle of the upper left pixel.
    """

    layout: SheetLayout
    picture_px: FloatArray
    page_mm: FloatArray


def find_tags(source: str, picture: Picture, marks: Sequence[Mark]) -> SeenTags:
    """Tags in a picture of the sheet for some marks, on whatever paper it was printed.

    Errors: PhotoError where there are none, or too few, or those of another sheet.
    """
    grey = np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), dtype=np.uint8)
    seen = _detected(grey)
    if not seen:
        if _detected(np.ascontiguousarray(grey[:, ::-1])):
            raise PhotoError(source, "the picture is mirrored; turn mirroring off in the camera, or flip it back")
        raise PhotoError(
            source, "no tags of a calibration sheet are in it; photograph the whole sheet, sharp and in even light"
        )
    layouts = [layout for page in pages_of(tuple(PaperSize)) if (layout := layout_on(page, marks))]
    matches = [_matching(layout, seen) for layout in layouts]
    best = max(range(len(layouts)), key=lambda index: len(matches[index]), default=None)
    places = [] if best is None else matches[best]
    if best is None or len(places) <= len(seen) / 2:
        raise PhotoError(
            source,
            f"it shows another sheet than the one for these marks ({len(places)} of {len(seen)} "
            "tags agree); give the photo and the marks of the same `plan pattern`",
        )
    layout = layouts[best]
    if len(places) < LEAST_TAGS:
        raise PhotoError(
            source,
            f"only {len(places)} of the sheet's {len(layout.tag_places)} tags can be read, and it "
            f"takes {LEAST_TAGS}; photograph the whole sheet, nearer, sharp and in even light",
        )
    corners = np.array([seen[N_DIGITS * place + layout.digits[place]] for place in places])
    return SeenTags(layout, corners, np.array([layout.tag_corners_page_mm(place) for place in places]))


def _matching(layout: SheetLayout, seen: dict[int, FloatArray]) -> list[int]:
    """The places of a layout's tags that were seen."""
    return [place for place, number in zip(layout.tag_places, layout.tag_ids, strict=True) if number in seen]


def _detected(grey: Picture) -> dict[int, FloatArray]:
    """Corners (4, 2) of the tags by id, those left out that are seen twice or are none of a sheet's."""
    corners, ids, _ = cv2.aruco.ArucoDetector(FAMILY, cv2.aruco.DetectorParameters()).detectMarkers(grey)
    numbers = [] if not len(corners) else [int(number) for number in np.ravel(ids)]
    light = np.asarray(cv2.LUT(grey, LINEAR_LIGHT.astype(np.float32)), dtype=np.float32)  # blur moves no edges in it
    return {
        number: _refined(light, np.asarray(corner, dtype=np.float32).reshape(4, 2))
        for number, corner in zip(numbers, corners, strict=True)
        if numbers.count(number) == 1 and number < N_PLACES * N_DIGITS
    }


def _refined(light: NDArray[np.float32], corners: NDArray[np.float32]) -> FloatArray:
    """Corners (4, 2) to a part of a pixel, from as much round them as is white or border whatever the tag."""
    module = min(np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)) / N_MODULES
    window = max(round(_WINDOW_MODULES * float(module)), 2)
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 50, 0.005)
    return np.asarray(cv2.cornerSubPix(light, corners.copy(), (window, window), (-1, -1), stop), dtype=np.float64)
