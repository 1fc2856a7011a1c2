"""Two links in a plane that meet a point: the triangle in most arms, elbow to one side or the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray

GAP_MM = 1e-9
"""A point so little beyond reach counts as reached by the stretched (or folded) links."""
_ROUNDING = 1e-14
_SINGULAR = 1e-11
"""Shares of the squared reach: what rounding leaves of straight links, and up to where they count as singular."""
_AT_SHOULDER_MM = 1e-10


@dataclass(frozen=True, eq=False, slots=True)
class Triangle:
    """Elbow e = ±1 has the shoulder at `direction - e lead` and the elbow at `e bend`, each (n,) in rad.
    gap_mm: 0 where the triangle closes; the angles are those of stretched or folded links where it does not."""

    direction_rad: FloatArray
    lead_rad: FloatArray
    bend_rad: FloatArray
    gap_mm: FloatArray
    singular: BoolArray


def two_links(along_mm: FloatArray, up_mm: FloatArray, upper_mm: float, fore_mm: float) -> Triangle:
    """The triangle with sides upper, fore (above 0) and the way to (along, up), by the law of cosines:
    `bend = atan2(R, D^2 - l1^2 - l2^2)`, `lead = atan2(R, D^2 + l1^2 - l2^2)`,
    `R^2 = ((l1 + l2)^2 - D^2) (D^2 - (l1 - l2)^2)`. The arc cosine would lose half of the digits near stretched links.

    Links bent by less than the rounding of D^2 tells from straight (some 1e-7 rad) are taken as straight.
    """
    squared = along_mm * along_mm
    squared += up_mm * up_mm
    direction = np.arctan2(up_mm, along_mm)
    far, near = upper_mm + fore_mm, abs(upper_mm - fore_mm)
    to_stretched = far * far - squared
    to_folded = squared - near * near
    at_shoulder = _AT_SHOULDER_MM**2
    singular = to_stretched <= _SINGULAR * far * far
    singular |= to_folded <= max(_SINGULAR * far * near, at_shoulder)
    root = to_stretched * to_folded
    gap = np.zeros(len(squared))
    if singular.any():
        distance = np.sqrt(squared[singular])
        missing = np.maximum(distance - far, near - distance)
        gap[singular] = np.where(missing > GAP_MM, missing, 0.0)
        straight = to_folded <= max(_ROUNDING * far * near, at_shoulder)
        straight |= to_stretched <= _ROUNDING * far * far
        root[straight] = 0.0
        direction[squared < at_shoulder] = 0.0
    np.sqrt(root, out=root)
    bend = np.arctan2(root, squared - (upper_mm * upper_mm + fore_mm * fore_mm))
    squared += upper_mm * upper_mm - fore_mm * fore_mm
    lead = np.arctan2(root, squared, out=root)
    return Triangle(direction, lead, bend, gap, singular & (gap == 0.0))
