"""One joint from rest to rest and back, at a given speed, acceleration or jerk.

Jerk is +J, 0, -J, 0, -J, 0, +J for the times t, h, t, c, t, h, t: the acceleration climbs to A = J t, holds it for h,
and goes back to zero at the speed V = J t (t + h), which is kept for c; braking mirrors it. Integrated, the way is
D = V (2 t + h + c).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from planner.arrays import FloatArray

HELD = 0.5
"""h / t where it is the acceleration that is tried, and jerk allows."""
CRUISE_S = (0.06, 0.4)
"""c, at least and at most, where it is the speed that is tried."""
_REST_S = 0.2
"""Between two ways: what a servo is late by is over by then."""
_CYCLES = 2


class Quantity(StrEnum):
    """In the order in which they are tried: what comes first bounds what comes later."""

    VELOCITY = "velocity"
    ACCELERATION = "acceleration"
    JERK = "jerk"

    @property
    def order(self) -> int:
        return list(Quantity).index(self) + 1

    @property
    def per_time(self) -> str:
        return "/s" + ("", "²", "³")[self.order - 1]


@dataclass(frozen=True, slots=True)
class Limits:
    """Of a joint, in rad or mm and seconds."""

    velocity: float
    acceleration: float
    jerk: float

    def of(self, quantity: Quantity) -> float:
        return self._all()[quantity.order - 1]

    def times(self, factor: float) -> Limits:
        return Limits(*(factor * one for one in self._all()))

    def with_one(self, quantity: Quantity, value: float) -> Limits:
        values = list(self._all())
        values[quantity.order - 1] = value
        return Limits(*values)

    def products(self, other: Limits) -> Limits:
        return Limits(*(mine * theirs for mine, theirs in zip(self._all(), other._all(), strict=True)))

    def pairs(self) -> Iterator[tuple[Quantity, float]]:
        return zip(Quantity, self._all(), strict=True)

    def _all(self) -> tuple[float, float, float]:
        return self.velocity, self.acceleration, self.jerk


@dataclass(frozen=True, slots=True)
class Way:
    """From rest to rest: jerk, in rad or mm and seconds, for `climb_s`, the acceleration kept for `held_s`, and the
    speed for `cruise_s`."""

    jerk: float
    climb_s: float
    held_s: float
    cruise_s: float = 0.0

    @property
    def acceleration(self) -> float:
        return self.jerk * self.climb_s

    @property
    def velocity(self) -> float:
        return self.acceleration * (self.climb_s + self.held_s)

    @property
    def length(self) -> float:
        return self.velocity * (2 * self.climb_s + self.held_s + self.cruise_s)

    @property
    def duration_s(self) -> float:
        return 4 * self.climb_s + 2 * self.held_s + self.cruise_s

    def positions(self, times_s: FloatArray) -> FloatArray:
        """(n,) how far it is at these times (n,)."""
        climb, held = self.climb_s, self.held_s
        begins = np.cumsum([0.0, climb, held, climb, self.cruise_s, climb, held, climb])
        changes = self.jerk * np.array([1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0])
        since = np.maximum(times_s[:, None] - begins, 0.0)
        positions: FloatArray = since**3 @ changes / 6
        return np.where(times_s >= self.duration_s, self.length, positions)

    def limited(self, quantity: Quantity, by: float) -> Way:
        """As far, by a servo that has only 1 / `by` of one quantity: it arrives later."""
        if quantity is Quantity.VELOCITY:
            velocity = self.velocity / by
            climb_s = min(self.climb_s, float(np.sqrt(velocity / self.jerk)))
            held_s = velocity / (self.jerk * climb_s) - climb_s
            return Way(self.jerk, climb_s, held_s, self.length / velocity - 2 * climb_s - held_s)
        jerk = self.jerk / by if quantity is Quantity.JERK else self.jerk
        acceleration = self.acceleration / by if quantity is Quantity.ACCELERATION else self.acceleration
        climb_s = min(acceleration / jerk, (self.length / (2 * jerk)) ** (1 / 3))
        return Way(jerk, climb_s, _held_s(jerk * climb_s, climb_s, self.length), 0.0)


def fastest(limits: Limits, length: float) -> float:
    """The speed that there is room for, kept for a little: V (V / A + A / J + c) = D."""
    apart_s = limits.acceleration / limits.jerk + CRUISE_S[0]
    speed = limits.acceleration * (float(np.sqrt(apart_s**2 + 4 * length / limits.acceleration)) - apart_s) / 2
    return speed * (1 - 1e-9)


def way_at(quantity: Quantity, limits: Limits, length: float) -> Way | None:
    """The way on which `quantity` is at its limit and the others are below theirs, if they can be; None where there is
    no room to keep the speed."""
    velocity, acceleration, jerk = limits.velocity, limits.acceleration, limits.jerk
    if quantity is Quantity.VELOCITY:
        climb_s = min(acceleration / jerk, float(np.sqrt(velocity / jerk)))
        held_s = velocity / (jerk * climb_s) - climb_s
        cruise_s = min(length / velocity - 2 * climb_s - held_s, CRUISE_S[1])
        return Way(jerk, climb_s, held_s, cruise_s) if cruise_s >= CRUISE_S[0] else None
    if quantity is Quantity.ACCELERATION:
        longest_s = min(velocity / acceleration, float(np.sqrt(length / (2 * acceleration))))
        climb_s = min(longest_s, max(longest_s / (1 + HELD), acceleration / jerk))
    else:
        climb_s = min(acceleration / jerk, (velocity / jerk) ** (1 / 2), (length / (2 * jerk)) ** (1 / 3))
        acceleration = jerk * climb_s
    held_s = min(velocity / acceleration - climb_s, _held_s(acceleration, climb_s, length))
    return Way(acceleration / climb_s, climb_s, max(held_s, 0.0))


def _held_s(acceleration: float, climb_s: float, length: float) -> float:
    """h of a way of that length without c: A (t + h) (2 t + h) = D."""
    return max(float(np.sqrt(climb_s**2 + 4 * length / acceleration) - 3 * climb_s) / 2, 0.0)


def samples_of_way(way: Way, rate_hz: float) -> tuple[int, int]:
    """How many samples it takes with the rest at its end, and the rest."""
    n_rest = int(np.ceil(_REST_S * rate_hz))
    return int(np.ceil(way.duration_s * rate_hz)) + n_rest, n_rest


def there_and_back(way: Way, rate_hz: float, n_way: int) -> FloatArray:
    """(n,) samples of the way, there and back a few times, from rest to rest, `n_way` samples each way."""
    there = way.positions(np.arange(n_way + 1) / rate_hz)
    cycle = np.concatenate((there, way.length - there[1:]))
    return np.concatenate((cycle, *[cycle[1:]] * (_CYCLES - 1)))
