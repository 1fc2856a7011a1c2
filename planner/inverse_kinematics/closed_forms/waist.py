"""The joint at the base that turns the arm's plane towards the target, to its front or over its back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray

_ON_AXIS_MM = 1e-10
_ROUNDING = 1e-14


@dataclass(frozen=True, eq=False, slots=True)
class Sides:
    """Angles of the base (theta of row 1) and distances within the arm's plane, in front and behind, each (n,).
    The plane passes the axis at the lateral offset, so no target lies nearer to the axis than that."""

    azimuth_rad: FloatArray
    theta_rad: tuple[FloatArray, FloatArray]
    along_mm: tuple[FloatArray, FloatArray]
    gap_mm: FloatArray
    singular: BoolArray


def face(x_mm: FloatArray, y_mm: FloatArray, left_mm: float) -> Sides:
    """Both ways to turn the plane so that (x, y) lies in it, `left_mm` to the left of the axis:
    `x = c1 A - s1 m`, `y = s1 A + c1 m`, A = ±sqrt(x^2 + y^2 - m^2)."""
    squared = x_mm * x_mm
    squared += y_mm * y_mm
    azimuth = np.arctan2(y_mm, x_mm)
    if left_mm == 0.0:
        singular = squared < _ON_AXIS_MM**2
        if singular.any():
            azimuth[singular] = 0.0
        front = np.sqrt(squared)
        return Sides(azimuth, (azimuth, azimuth + np.pi), (front, -front), np.zeros(len(front)), singular)
    rest = squared - left_mm * left_mm
    singular = rest <= _ROUNDING * left_mm * left_mm
    gap = np.zeros(len(rest))
    if singular.any():
        gap[singular] = abs(left_mm) - np.sqrt(squared[singular])
        gap[gap < _ON_AXIS_MM] = 0.0
        rest[singular] = 0.0
    front = np.sqrt(rest)
    swing = np.arctan2(left_mm, front)
    return Sides(azimuth, (azimuth - swing, azimuth + swing + np.pi), (front, -front), gap, singular & (gap == 0.0))
