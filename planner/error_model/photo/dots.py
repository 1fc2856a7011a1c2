"""Dots of ink: all that could be marks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.error_model.photo.ink import InkMap
from planner.error_model.vision import cv2

_REACH_MM = 0.35  # round what is above the threshold, so that a faint rim counts for the middle
_LEAST_INK_MM2 = 0.02  # a dot of 0.16 mm
_LONGEST_SD_MM = 0.65  # of a stroke of 2.2 mm


@dataclass(frozen=True, eq=False, slots=True)
class Dots:
    """places_mm (n, 2): middles, in page coordinates. ink_mm2 (n,): as much paper as they blacken. smear_mm (n,): how
    much longer than wide they are, as a standard deviation."""

    places_mm: FloatArray
    ink_mm2: FloatArray
    smear_mm: FloatArray

    def only(self, indices: IntArray) -> Dots:
        return Dots(self.places_mm[indices], self.ink_mm2[indices], self.smear_mm[indices])


def find_dots(ink: InkMap) -> Dots:
    """The spots of ink that are small and about as long as they are wide."""
    _, labels, boxes, _ = cv2.connectedComponentsWithStats((ink.excess >= 1).astype(np.uint8))
    reach = round(_REACH_MM * ink.px_per_mm)
    longest = 6 * _LONGEST_SD_MM * ink.px_per_mm
    rows, columns = labels.shape
    found = []
    for number, (left, top, width, height, _) in enumerate(boxes[1:].tolist(), 1):
        on_rim = left == 0 or top == 0 or left + width == columns or top + height == rows
        if on_rim or max(width, height) > longest:
            continue
        part = np.s_[max(top - reach, 0) : top + height + reach, max(left - reach, 0) : left + width + reach]
        near = cv2.dilate((labels[part] == number).astype(np.uint8), np.ones((2 * reach + 1, 2 * reach + 1), np.uint8))
        own = near.astype(bool) & np.isin(labels[part], (0, number))
        weight = np.where(own, ink.darkness[part], 0.0)
        total = float(weight.sum())
        if total < _LEAST_INK_MM2 * ink.px_per_mm**2:
            continue
        down, right = np.nonzero(own)
        points = np.stack((right, down), axis=-1).astype(np.float64)
        shares = weight[own] / total
        middle = shares @ points
        spread = (points - middle).T @ ((points - middle) * shares[:, None])
        narrow, wide = np.sqrt(np.maximum(np.linalg.eigvalsh(spread), 0.0)) / ink.px_per_mm
        if wide <= _LONGEST_SD_MM:
            corner = np.array([part[1].start, part[0].start])
            found.append((*ink.to_page_mm(middle + corner), total / ink.px_per_mm**2, wide - narrow))
    table = np.array(found, dtype=np.float64).reshape(-1, 4)
    return Dots(table[:, :2], table[:, 2], table[:, 3])
