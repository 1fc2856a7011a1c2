"""Where the ink of a stroke begins, to a fraction of its width.

The tip comes down evenly along it, by `slope` mm for each mm, so a tip that is too high by h begins to leave ink
h / slope too late, and one that is too low too soon.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.error_model.photo.ink import InkMap
from planner.error_model.vision import cv2

_STEP_MM = 0.05
_BEFORE_MM, _AFTER_MM = 5.0, 2.0
_ASIDE_MM = 2.5
_SKIP_MM = 1.0  # a pen may leave out that much within a line
_APART_MM = 1.5  # nearer than this, other ink may be part of what looks like one line
_ROUND = np.sqrt(3) / 4  # of the width: where a round end is half as wide as the line
_NEAR_MM = 0.4


def ink_begins(
    ink: InkMap, mark_page_mm: FloatArray, way: FloatArray, length_mm: float, others_page_mm: FloatArray
) -> FloatArray | None:
    """(2,) where the middle of the nib came to the paper, on the page.

    mark (2,): where the stroke's pen rested; way (2,): the direction that it was drawn in; length: how long before the
    mark it may begin. others (n, 2): other marks. None where the beginning cannot be told from other ink.
    """
    aside = np.array([-way[1], way[0]])
    s = np.arange(-length_mm - _BEFORE_MM, _AFTER_MM, _STEP_MM)
    t = np.arange(-_ASIDE_MM, _ASIDE_MM + _STEP_MM / 2, _STEP_MM)
    places = mark_page_mm + s[:, None, None] * way + t[None, :, None] * aside
    own = _line(ink.is_ink(places), s, t)
    if own is None:
        return None
    strip = np.where(own, ink.sampled(places), 0.0)
    profile = strip.sum(axis=1) * _STEP_MM
    inked = np.flatnonzero(own.any(axis=1))
    width = float(np.median(profile[inked[0] : inked[-1] + 1]))
    first = int(np.argmax(profile > width / 2))
    if first == 0 or _meets(others_page_mm - mark_page_mm, way, aside, s[[first, inked[-1]]]):
        return None
    start = _crossing(s[first - 1 : first + 1], profile[first - 1 : first + 1], width / 2) + _ROUND * width
    near = strip[first : first + round(_NEAR_MM / _STEP_MM)].sum(axis=0)
    begin: FloatArray = mark_page_mm + start * way + float(near @ t / near.sum()) * aside
    return begin


def _meets(others: FloatArray, along: FloatArray, aside: FloatArray, span_mm: FloatArray) -> bool:
    """Whether other ink is expected on what was taken for the line, or just before or after it."""
    s, t = others @ along, others @ aside
    return bool(np.any((np.abs(t) < _APART_MM) & (s > span_mm[0] - _APART_MM) & (s < span_mm[1] + _APART_MM)))


def _line(dark: BoolArray, s: FloatArray, t: FloatArray) -> BoolArray | None:
    """Which pixels of the strip (s, t) belong to the line that the mark is on, and to its rim."""
    skip = np.ones((round(_SKIP_MM / _STEP_MM), 1), np.uint8)
    whole = cv2.morphologyEx(dark.astype(np.uint8), cv2.MORPH_CLOSE, skip)
    _, labels = cv2.connectedComponents(whole)
    own = labels[np.argmin(np.abs(s)), np.argmin(np.abs(t))]
    if not own:
        return None
    rim = round(0.3 / _STEP_MM)
    near = cv2.dilate((labels == own).astype(np.uint8), np.ones((2 * rim + 1, 2 * rim + 1), np.uint8))
    found: BoolArray = near.astype(bool) & np.isin(labels, (0, own))
    return found


def _crossing(s: FloatArray, values: FloatArray, level: float) -> float:
    """Where a line through two points is at a level."""
    return float(s[0] + (level - values[0]) / (values[1] - values[0]) * (s[1] - s[0]))
