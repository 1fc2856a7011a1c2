"""What was measured of joints while they moved."""

from __future__ import annotations

from dataclasses import dataclass

from planner.arrays import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Measurements:
    """times_s: (n,) since the first set point. positions: (n, n_joints) rad or mm, NaN where a joint was not measured
    then."""

    times_s: FloatArray
    positions: FloatArray
