"""Where the ink of a touch-down line begins, and what height of the tip that means.

The tip comes down evenly along the line, by `slope` mm for each mm, so a tip that is too high by h begins to leave ink
h / slope too late, and one that is too low too soon. What is measured is the line's length, from where the ink begins
to where it ends: both ends are drawn in the same movement, so that what the arm is off along the line does not matter.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.error_model.photo.ink import InkMap, Singles
from planner.error_model.sheet.marks import TouchDown
from planner.error_model.vision import cv2

_STEP_MM = 0.05
_BEFORE_MM, _AFTER_MM = 12.0, 4.0
_ASIDE_MM = 2.5
_END_MM = 3.0  # how far from its place beside the mark a line may end
_OFF_MM = 1.5  # sd of that, and of how far to the side it lies
_SKIP_MM = 1.0  # a pen may leave out that much within a line
_APART_MM = 1.5  # nearer than this, other ink may be part of what looks like one line
_ROUND = np.sqrt(3) / 4  # of the width: where a round end is half as wide as the line
_SHORTEST_MM = 1.0


def touch_down_span(
    ink: InkMap, start_page_mm: FloatArray, end_page_mm: FloatArray, others_page_mm: FloatArray
) -> tuple[float, float] | None:
    """Where the middle of the nib was along the line when ink began and ended, mm from where it should begin.

    start, end (2,): of the line as it should be, moved as its mark is. others (n, 2): where dots are and other lines
    end. None where no ink ends as the line should, or where it cannot be told from other ink.
    """
    length = float(np.linalg.norm(end_page_mm - start_page_mm))
    along = (end_page_mm - start_page_mm) / length
    aside = np.array([-along[1], along[0]])
    s = np.arange(-_BEFORE_MM, length + _AFTER_MM, _STEP_MM)
    t = np.arange(-_ASIDE_MM, _ASIDE_MM + _STEP_MM / 2, _STEP_MM)
    places = start_page_mm + s[:, None, None] * along + t[None, :, None] * aside
    strip = ink.sampled(places)
    own = _line(strip, ink.is_ink(places), s, t, length)
    if own is None:
        return None
    profile = np.where(own, strip, 0.0).sum(axis=1) * _STEP_MM
    inked = np.flatnonzero(own.any(axis=1))
    width = float(np.median(profile[inked[0] : inked[-1] + 1]))
    over = np.flatnonzero(profile > width / 2)
    first, last = int(over[0]), int(over[-1])
    if first == 0 or last + 1 == len(s) or _meets(others_page_mm - start_page_mm, along, aside, s[[first, last]]):
        return None
    start = _crossing(s[first - 1 : first + 1], profile[first - 1 : first + 1], width / 2)
    end = _crossing(s[last : last + 2], profile[last : last + 2], width / 2)
    return start + _ROUND * width, end - _ROUND * width


def _meets(others: FloatArray, along: FloatArray, aside: FloatArray, span_mm: FloatArray) -> bool:
    """Whether other ink is expected on what was taken for the line, or just before it, but for the line's own end."""
    s, t = others @ along, others @ aside
    return bool(np.any((np.abs(t) < _APART_MM) & (s > span_mm[0] - _APART_MM) & (s < span_mm[1] - _END_MM)))


def height_mm(contact: TouchDown, span_mm: tuple[float, float]) -> float:
    """Height of the tip over the paper where it should just touch it; negative: pressed."""
    meant = float(np.linalg.norm(np.subtract(contact.end_mm, contact.start_mm)))
    return contact.slope * (meant - (span_mm[1] - span_mm[0]))


def _line(strip: Singles, dark: BoolArray, s: FloatArray, t: FloatArray, length: float) -> BoolArray | None:
    """Which pixels of the strip (s, t) belong to the line and its rim: much ink that ends near where it should."""
    skip = np.ones((round(_SKIP_MM / _STEP_MM), 1), np.uint8)
    whole = cv2.morphologyEx(dark.astype(np.uint8), cv2.MORPH_CLOSE, skip)
    _, labels, boxes, middles = cv2.connectedComponentsWithStats(whole)
    best, most = 0, 0.0
    for number, (_, top, _, height, _) in enumerate(boxes[1:].tolist(), 1):
        end_off = s[top + height - 1] - length
        if abs(end_off) > _END_MM or height * _STEP_MM < _SHORTEST_MM:
            continue
        off = np.hypot(end_off, np.interp(middles[number][0], np.arange(len(t)), t))
        likely = float(strip[labels == number].sum() * np.exp(-0.5 * (off / _OFF_MM) ** 2))
        if likely > most:
            best, most = number, likely
    if not best:
        return None
    rim = round(0.3 / _STEP_MM)
    near = cv2.dilate((labels == best).astype(np.uint8), np.ones((2 * rim + 1, 2 * rim + 1), np.uint8))
    found: BoolArray = near.astype(bool) & np.isin(labels, (0, best))
    return found


def _crossing(s: FloatArray, values: FloatArray, level: float) -> float:
    """Where a line through two points is at a level."""
    return float(s[0] + (level - values[0]) / (values[1] - values[0]) * (s[1] - s[0]))
