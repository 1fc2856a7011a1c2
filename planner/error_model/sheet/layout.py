"""Where a calibration sheet has its tags, and where on the page the arm's frame lies.

The page has u to the right and v up, from its lower left corner, as seen from behind the base. The sheet's frame is the
arm's: x away from the base, y to its left; so u = u_0 - y and v = v_0 + x. All in millimetres.

A layout follows from the marks and the kind of paper alone, so a photo needs no file but that of the marks.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from planner.arrays import FloatArray
from planner.error_model.sheet.marks import Mark, extent_mm
from planner.errors import PlanError

TAG_MM = 15.0
"""Side of a tag's black square."""
QUIET_MM = 2.0
"""White round a tag, more than one of its 8 modules."""
BAR_MM = 150.0
"""Length of the bars that are to be checked with a ruler."""
BASE_RING_MM = 40.0
"""Radius of the largest ring that the base is centred by; no tag comes near it."""

N_PLACES = 16
N_DIGITS = 36
"""A tag's id is 36 times its place in the ring and a digit of the sheet's identity: 576 of the family's 587 ids."""

_PRINT_MARGIN_MM = 7.0  # what printers leave white, and some
_BAND_MM = _PRINT_MARGIN_MM + TAG_MM + QUIET_MM
_STRAY_MM = 8.0  # how far from its place a mark of an arm that was never calibrated may come
_INSET_MM = _BAND_MM + _STRAY_MM
_BASE_FROM_EDGE_MM = 20.0
_BAR_FROM_BAND_MM = 0.5
_TICK_MM = 2.0
_FORMAT = "sheet 1"  # goes into the identity: another arrangement of tags makes another sheet
_LETTERS = "23456789ABCDEFGHJKLMNPQRSTUVWXYZ"  # without those that are taken for one another


class PaperSize(StrEnum):
    A4 = "a4"
    LETTER = "letter"
    A3 = "a3"


_SHORT_LONG_MM = {PaperSize.A4: (210.0, 297.0), PaperSize.LETTER: (215.9, 279.4), PaperSize.A3: (297.0, 420.0)}


@dataclass(frozen=True, slots=True)
class Page:
    """A sheet of paper as it lies before the base: width along y, height along x."""

    size: PaperSize
    landscape: bool

    @property
    def extent_mm(self) -> tuple[float, float]:
        """Width and height."""
        short, long = _SHORT_LONG_MM[self.size]
        return (long, short) if self.landscape else (short, long)

    @property
    def room_mm(self) -> tuple[float, float]:
        """How far apart marks may be, along x and along y."""
        width, height = self.extent_mm
        return height - 2 * _INSET_MM, width - 2 * _INSET_MM

    @property
    def name(self) -> str:
        return f"{self.size.upper() if self.size is not PaperSize.LETTER else 'letter'} " + (
            "landscape" if self.landscape else "portrait"
        )


def pages_of(sizes: Sequence[PaperSize]) -> list[Page]:
    return [Page(size, landscape) for size in sizes for landscape in (True, False)]


@dataclass(frozen=True, eq=False, slots=True)
class SheetLayout:
    """A page with the arm's frame and tags on it.

    origin_page_mm: page coordinates of the base. tag_places: which of the 16 places of the ring have a tag, those that
    the base would cover left out. digits: the sheet's identity, a digit for each of the 16 places. name: the identity
    for people.
    """

    page: Page
    origin_page_mm: tuple[float, float]
    tag_places: tuple[int, ...]
    digits: tuple[int, ...]
    name: str

    def to_page_mm(self, sheet_mm: FloatArray) -> FloatArray:
        """(..., 2) page coordinates of points (..., 2) in the sheet's frame."""
        u_0, v_0 = self.origin_page_mm
        page_mm: FloatArray = np.stack((u_0 - sheet_mm[..., 1], v_0 + sheet_mm[..., 0]), axis=-1)
        return page_mm

    def to_sheet_mm(self, page_mm: FloatArray) -> FloatArray:
        """(..., 2) points in the sheet's frame of page coordinates (..., 2)."""
        u_0, v_0 = self.origin_page_mm
        sheet_mm: FloatArray = np.stack((page_mm[..., 1] - v_0, u_0 - page_mm[..., 0]), axis=-1)
        return sheet_mm

    @property
    def tag_ids(self) -> tuple[int, ...]:
        """Ids, in the order of `tag_places`."""
        return tuple(N_DIGITS * place + self.digits[place] for place in self.tag_places)

    def tag_centre_page_mm(self, place: int) -> FloatArray:
        """(2,): the middle of the tag at one of the ring's places."""
        centre: FloatArray = _ring_mm(self.page)[place]
        return centre

    def tag_corners_page_mm(self, place: int) -> FloatArray:
        """(4, 2): corners of a tag's black square, from the upper left one, clockwise as seen from above."""
        half = TAG_MM / 2
        corners: FloatArray = self.tag_centre_page_mm(place) + np.array(
            [[-half, half], [half, half], [half, -half], [-half, -half]]
        )
        return corners

    @property
    def bars_page_mm(self) -> FloatArray:
        """(2, 2, 2): ends of the bar across the page, under its upper tags, and of the one along its left tags."""
        width, height = self.page.extent_mm
        off = _BAND_MM + _BAR_FROM_BAND_MM
        u, v = (width - BAR_MM) / 2, (height - BAR_MM) / 2
        return np.array([[[u, height - off], [u + BAR_MM, height - off]], [[off, v], [off, v + BAR_MM]]])

    @property
    def ticks_page_mm(self) -> FloatArray:
        """(4, 2, 2): the lines at the ends of the bars, away from the tags."""
        ends = self.bars_page_mm
        inwards = np.array([[[0.0, -_TICK_MM]], [[_TICK_MM, 0.0]]])
        return np.stack((ends, ends + inwards), axis=2).reshape(4, 2, 2)

    @property
    def ink_page_mm(self) -> tuple[FloatArray, FloatArray]:
        """Lower left and upper right corner (2,) of what the tags leave free: where ink is looked for."""
        return np.full(2, _BAND_MM), np.array(self.page.extent_mm) - _BAND_MM


def drawable_mm(
    wanted_low_mm: Sequence[float], wanted_high_mm: Sequence[float], size: PaperSize = PaperSize.A4
) -> tuple[FloatArray, FloatArray]:
    """Least and greatest x and y (2,) of the largest part of a wanted box that marks may lie in on one sheet.

    Where the box is too wide for the paper its middle is kept; across, that is where the arm looks.
    """
    low, high = np.asarray(wanted_low_mm, dtype=np.float64), np.asarray(wanted_high_mm, dtype=np.float64)
    kept = max((np.minimum(high - low, page.room_mm) for page in pages_of([size])), key=lambda extent: extent.prod())
    middle = (low + high) / 2
    return middle - kept / 2, middle + kept / 2


def layout_on(page: Page, marks: Sequence[Mark]) -> SheetLayout | None:
    """The sheet for some marks on a page; None where they do not fit on it."""
    low, high = extent_mm(marks)
    width, height = page.extent_mm
    u_0 = _clamped(width / 2, _INSET_MM + high[1], width - _INSET_MM + low[1])
    v_0 = _clamped(_BASE_FROM_EDGE_MM, _INSET_MM - low[0], height - _INSET_MM - high[0])
    if u_0 is None or v_0 is None:
        return None
    clear = BASE_RING_MM + QUIET_MM + TAG_MM / math.sqrt(2)
    places = tuple(place for place, centre in enumerate(_ring_mm(page)) if math.dist(centre, (u_0, v_0)) > clear)
    digits, name = _identity(page, marks)
    return SheetLayout(page, (u_0, v_0), places, digits, name)


def sheet_for(marks: Sequence[Mark], size: PaperSize = PaperSize.A4) -> SheetLayout:
    """The sheet for some marks: the way of laying the paper that leaves them most room. Errors: PlanError."""
    layouts = [layout for page in pages_of([size]) if (layout := layout_on(page, marks))]
    if not layouts:
        low, high = extent_mm(marks)
        x, y = max((page.room_mm for page in pages_of([size])), key=lambda room: room[1])
        raise PlanError(
            f"the marks are {high[0] - low[0]:.0f} mm along x and {high[1] - low[1]:.0f} mm along y, and a "
            f"sheet of {size.upper()} has room for {x:.0f} x {y:.0f} mm or {y:.0f} x {x:.0f} mm"
        )
    low, high = extent_mm(marks)
    return max(layouts, key=lambda layout: min(np.array(layout.page.room_mm) - (high - low)))


def _clamped(wish: float, least: float, greatest: float) -> float | None:
    """The wish, or what is nearest to it within the range; None if that is empty."""
    if least > greatest + 1e-6:
        return None
    return round(float(min(max(wish, least), greatest)), 3)


def _ring_mm(page: Page) -> FloatArray:
    """(16, 2) page coordinates: middles of the tags, clockwise from the upper left corner; six along a long side and
    four along a short one."""
    width, height = page.extent_mm
    edge = _PRINT_MARGIN_MM + TAG_MM / 2
    across, along = (6, 4) if page.landscape else (4, 6)
    u = np.linspace(edge, width - edge, across)
    v = np.linspace(height - edge, edge, along)
    top = [(each, v[0]) for each in u]
    right = [(u[-1], each) for each in v[1:-1]]
    bottom = [(each, v[-1]) for each in u[::-1]]
    left = [(u[0], each) for each in v[-2:0:-1]]
    return np.array(top + right + bottom + left)


def _identity(page: Page, marks: Sequence[Mark]) -> tuple[tuple[int, ...], str]:
    """Digits for the places of the ring, and a name of six letters, from all that the sheet is for."""
    told = [_FORMAT, page.name]
    for mark in marks:
        contact = mark.touch_down
        points = (mark.place_mm,) if contact is None else (mark.place_mm, contact.start_mm, contact.end_mm)
        told.append(" ".join(f"{value:.3f}" for point in points for value in point))
    number = int.from_bytes(hashlib.blake2b("\n".join(told).encode(), digest_size=24).digest())
    number, letters = divmod(number, len(_LETTERS) ** 6)
    digits = tuple(number // N_DIGITS**place % N_DIGITS for place in range(N_PLACES))
    return digits, "".join(_LETTERS[letters // len(_LETTERS) ** place % len(_LETTERS)] for place in range(6))
