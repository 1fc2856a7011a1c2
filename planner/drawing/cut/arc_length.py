"""Arc length along cubics, and the parameter at a length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.drawing.cubics import velocity
from planner.drawing.cut.cubic_roots import sign_changes

_ROUNDS, _STEPS = 24, 12
_PRECISION = 1e-9
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True, eq=False, slots=True)
class ArcLength:
    """Lengths along a row of cubics that follow each other.

    control: (n, 4, 2). curve, start: of each stretch (m,), in order, the cubic that it is of and the parameter where it
    begins; a stretch is so short that eight Gauss-Legendre nodes give its length to a billionth of that of its curve.
    begins: (m + 1,) the length up to each stretch, and of all.
    """

    control: FloatArray
    curve: IntArray
    start: FloatArray
    begins: FloatArray

    @classmethod
    def of(cls, control: FloatArray) -> ArcLength:
        """Stretches begin where a curve is slowest, as it is at a cusp, and are halved until halves and whole agree
        twice in a row: once may be by chance."""
        curve, start, end = _between_slowest(control)
        bound = _PRECISION * np.hypot(*np.moveaxis(np.diff(control, axis=1), 2, 0)).sum(axis=1)
        done: list[tuple[IntArray, FloatArray, FloatArray]] = []
        whole, agreed = _length(control[curve], start, end), np.zeros(len(curve), dtype=np.bool_)
        for round_ in range(_ROUNDS):
            middle = 0.5 * (start + end)
            left, right = _length(control[curve], start, middle), _length(control[curve], middle, end)
            agrees = np.abs(left + right - whole) <= bound[curve]
            is_fine = (agrees & agreed) | (round_ == _ROUNDS - 1)
            done.append((curve[is_fine], start[is_fine], (left + right)[is_fine]))
            rough = ~is_fine
            curve, agreed = np.repeat(curve[rough], 2), np.repeat(agrees[rough], 2)
            whole = np.column_stack((left[rough], right[rough])).ravel()
            start, end = (
                np.column_stack((start[rough], middle[rough])).ravel(),
                np.column_stack((middle[rough], end[rough])).ravel(),
            )
            if not len(curve):
                break
        curves, starts, lengths = (np.concatenate(column) for column in zip(*done, strict=True))
        order = np.lexsort((starts, curves))
        begins = np.concatenate(([0.0], np.cumsum(lengths[order])))
        return cls(control, curves[order], starts[order], begins)

    @property
    def total(self) -> float:
        return float(self.begins[-1])

    def places(self, lengths: FloatArray) -> tuple[IntArray, FloatArray]:
        """The curve and the parameter at each of the lengths (n,), by Newton's method within the stretch."""
        stretch = np.clip(np.searchsorted(self.begins, lengths, side="right") - 1, 0, len(self.curve) - 1)
        curve, start = self.curve[stretch], self.start[stretch]
        end = np.append(self.start[1:], 1.0)[stretch]
        end = np.where(end > start, end, 1.0)
        wanted = lengths - self.begins[stretch]
        size = self.begins[stretch + 1] - self.begins[stretch]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = start + (end - start) * np.nan_to_num(np.clip(wanted / size, 0.0, 1.0))
        control = self.control[curve]
        for _ in range(_STEPS):
            speed = np.hypot(*velocity(control, t[:, np.newaxis]).T)
            excess = _length(control, start, t) - wanted
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                t = np.clip(t - np.nan_to_num(excess / speed, posinf=0.0, neginf=0.0), start, end)
        return curve, t


def _between_slowest(control: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Curves cut where their speed is least or greatest: of each stretch the curve, its start and its end. There the
    velocity is square to the acceleration, and their product is a cubic polynomial."""
    d0, d1, d2 = np.moveaxis(np.diff(control, axis=1), 1, 0)
    a, b, c = d0, 2.0 * (d1 - d0), d0 - 2.0 * d1 + d2  # velocity / 3 = a + b t + c t^2
    power = np.stack([np.sum(terms, axis=1) for terms in (a * b, b * b + 2.0 * a * c, 3.0 * b * c, 2.0 * c * c)])
    # Rounding must not make the speed of a straight line come and go.
    power[np.abs(power) < 1e-12 * np.sum(np.square(np.diff(control, axis=1)), axis=(1, 2))] = 0.0
    slowest, t = sign_changes(power, np.zeros(len(control)), np.ones(len(control)))
    curve = np.concatenate((np.arange(len(control)), slowest))
    start = np.concatenate((np.zeros(len(control)), t))
    order = np.lexsort((start, curve))
    curve, start = curve[order], start[order]
    is_last = np.append(np.diff(curve) != 0, True)
    return curve, start, np.where(is_last, 1.0, np.append(start[1:], 1.0))


def _length(control: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """The lengths (n,) of cubics between parameters (n,)."""
    half = 0.5 * (end - start)
    t = start[:, np.newaxis] + half[:, np.newaxis] * (1.0 + _NODES)
    speed = np.hypot(*np.moveaxis(velocity(control[:, np.newaxis], t[:, :, np.newaxis]), 2, 0))
    length: FloatArray = half * (speed * _WEIGHTS).sum(axis=1)
    return length
