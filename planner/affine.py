"""Affine maps of the plane as (2, 3) arrays [[a, c, e], [b, d, f]]: x' = a x + c y + e, y' = b x + d y + f."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray


def compose(outer: FloatArray, inner: FloatArray) -> FloatArray:
    """The map that applies `inner` first, then `outer`."""
    return np.column_stack((outer[:, :2] @ inner[:, :2], outer[:, :2] @ inner[:, 2] + outer[:, 2]))


def rotation(angle_deg: float) -> FloatArray:
    """Clockwise turn as seen on a page whose y points down; right angles are exact."""
    quarter, rest = divmod(angle_deg / 90.0, 1.0)
    if rest == 0.0:
        c, s = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    else:
        c, s = float(np.cos(np.radians(angle_deg))), float(np.sin(np.radians(angle_deg)))
    return np.array([[c, -s, 0.0], [s, c, 0.0]])


def scale_of(affine: FloatArray) -> float:
    """What it makes of a unit of length, in the geometric mean of all directions."""
    return float(np.sqrt(abs(np.linalg.det(affine[:, :2]))))


def inverse(affine: FloatArray) -> FloatArray:
    """The map that undoes `affine`. Errors: numpy.linalg.LinAlgError where it squeezes the plane to a line."""
    back = np.linalg.inv(affine[:, :2])
    return np.column_stack((back, -back @ affine[:, 2]))
