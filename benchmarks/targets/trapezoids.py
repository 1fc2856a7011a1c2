"""How long plotters with constant acceleration take: what AxiDraw's, saxi's and grbl's planners have in common.

Trapezia of speed along straight lines, a junction speed at each vertex from the deviation that a rounded corner would
have (S. K. Jeon, Improving Grbl's cornering algorithm, 2011), and look-ahead, so that each of them can be braked for.
Neither jerk nor joints are limited, and no time is lost to slices, steps or the link.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from planner.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Plotter:
    """Speeds and accelerations with the pen down and up, the deviation at junctions, the times to lower and to raise
    the pen, and the gap that is drawn across rather than hopped over."""

    down_mm_s: float
    down_mm_s2: float
    deviation_mm: float
    up_mm_s: float
    up_mm_s2: float
    lower_s: float
    raise_s: float
    gap_mm: float

    def ink_and_whole_s(self, strokes: Sequence[FloatArray]) -> tuple[float, float]:
        """Seconds with the pen down, and of the whole, of strokes (n, 2) in their order: from above the first point to
        above the last."""
        chains = [strokes[0]]
        up_s = 0.0
        for before, after in pairwise(strokes):
            if float(np.hypot(*(after[0] - before[-1]))) < self.gap_mm:
                chains[-1] = np.concatenate((chains[-1], after))
            else:
                chains.append(after)
                up_s += way_s(np.stack((before[-1], after[0])), self.up_mm_s, self.up_mm_s2, 0.0)
        ink_s = sum(way_s(chain, self.down_mm_s, self.down_mm_s2, self.deviation_mm) for chain in chains)
        return ink_s, ink_s + up_s + len(chains) * (self.lower_s + self.raise_s)


def way_s(points: FloatArray, cap_mm_s: float, acceleration: float, deviation_mm: float) -> float:
    """How long a polyline (n, 2) takes from rest to rest."""
    length, speed = speeds(points, cap_mm_s, acceleration, deviation_mm)
    one, other = speed[:-1], speed[1:]
    top = np.minimum(np.sqrt(acceleration * length + (one**2 + other**2) / 2), cap_mm_s)
    ramps_mm = (2 * top**2 - one**2 - other**2) / (2 * acceleration)
    return float(np.sum((2 * top - one - other) / acceleration + (length - ramps_mm) / top)) if len(length) else 0.0


def speeds(
    points: FloatArray, cap_mm_s: float, acceleration: float, deviation_mm: float
) -> tuple[FloatArray, FloatArray]:
    """(m,) lengths of the lines that have any, and (m + 1,) the speeds at their ends."""
    steps = np.diff(points, axis=0)
    length = np.hypot(*steps.T)
    steps, length = steps[length > 0.0], length[length > 0.0]
    direction = steps / length[:, None]
    # The half of the angle between two lines, as it is where a circle that touches both passes the vertex.
    half = np.sqrt(np.clip((1.0 + np.sum(direction[1:] * direction[:-1], axis=1)) / 2, 0.0, 1.0))
    junction = np.sqrt(acceleration * deviation_mm * half / np.maximum(1.0 - half, 1e-12))
    speed = np.concatenate(([0.0], np.minimum(junction, cap_mm_s), [0.0]))
    for index in range(len(length)):
        speed[index + 1] = min(speed[index + 1], np.sqrt(speed[index] ** 2 + 2 * acceleration * length[index]))
    for index in range(len(length) - 1, -1, -1):
        speed[index] = min(speed[index], np.sqrt(speed[index + 1] ** 2 + 2 * acceleration * length[index]))
    return length, speed
