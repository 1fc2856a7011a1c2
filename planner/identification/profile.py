"""One joint from rest to rest and back, at a given acceleration and a given jerk.

Jerk is +J, 0, -J, 0, +J for the times t, h, 2t, h, t: the acceleration climbs to A = J t, holds it for h, goes through
zero to -A, holds it, and comes back. Integrated, the way is D = J t (t + h) (2 t + h), at a greatest speed of
V = J t (t + h) in its middle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray

HELD = 0.5
"""h / t where it is the acceleration that is tried."""
_REST_S = 0.15
"""Between two ways: what a servo is late by is over by then."""
_CYCLES = 3


@dataclass(frozen=True, slots=True)
class Way:
    """From rest to rest: jerk, in rad or mm and seconds, for `climb_s`, and the acceleration kept for `held_s`."""

    jerk: float
    climb_s: float
    held_s: float

    @property
    def acceleration(self) -> float:
        return self.jerk * self.climb_s

    @property
    def velocity(self) -> float:
        return self.acceleration * (self.climb_s + self.held_s)

    @property
    def length(self) -> float:
        return self.velocity * (2 * self.climb_s + self.held_s)

    @property
    def duration_s(self) -> float:
        return 4 * self.climb_s + 2 * self.held_s

    def positions(self, times_s: FloatArray) -> FloatArray:
        """(n,) how far it is at these times (n,)."""
        climb, held = self.climb_s, self.held_s
        begins = np.cumsum([0.0, climb, held, 2 * climb, held, climb])
        changes = self.jerk * np.array([1.0, -1.0, -1.0, 1.0, 1.0, -1.0])
        since = np.maximum(times_s[:, None] - begins, 0.0)
        positions: FloatArray = since**3 @ changes / 6
        return np.where(times_s >= self.duration_s, self.length, positions)


def way_of_jerk(jerk: float, acceleration: float, velocity: float, length: float) -> Way:
    """The longest climbs at this jerk that keep the other three."""
    climb_s = min(acceleration / jerk, (velocity / jerk) ** (1 / 2), (length / (2 * jerk)) ** (1 / 3))
    return Way(jerk, climb_s, 0.0)


def way_of_acceleration(acceleration: float, velocity: float, length: float) -> Way:
    """At this acceleration, held for a while, with the least jerk that speed and room allow."""
    climb_s = min(
        velocity / (acceleration * (1 + HELD)), float(np.sqrt(length / (acceleration * (1 + HELD) * (2 + HELD))))
    )
    return Way(acceleration / climb_s, climb_s, HELD * climb_s)


def there_and_back(way: Way, rate_hz: float) -> tuple[FloatArray, int, int]:
    """(n,) samples of the way, there and back a few times, from rest to a rest; of how many samples each way is, and
    the rest at its end."""
    n_moving, n_rest = int(np.ceil(way.duration_s * rate_hz)), int(np.ceil(_REST_S * rate_hz))
    there = way.positions(np.arange(n_moving + n_rest + 1) / rate_hz)
    cycle = np.concatenate((there, way.length - there[1:]))
    return np.concatenate((cycle, *[cycle[1:]] * (_CYCLES - 1))), n_moving + n_rest, n_rest
