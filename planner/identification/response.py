"""How a servo answers, and up to which step of a test motion it does so in one and the same way.

Within its limits a servo is linear, and its gears have play: the joint is at

    y = c + P_b(u),   u(t) = sum of h_m x(t - m / rate),

where x is what the servo was told. Lag, delay and overshoot are in the weights h, which add up to 1; P_b is the play
operator: the joint stays where it is until u has come half of the play b away from it. b shows at rest, in how much
shorter ways are than told. h is fitted by least squares, to the measured positions with the effect of the play taken
out. What the gentler steps tell of h foretells the next step; a servo that cannot follow that one is elsewhere. What is
measured is folded first: all ways of a step are one way, there or mirrored, and noise averages out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray

_KNOTS_S = (0.0, 0.01, 0.02, 0.035, 0.055, 0.085, 0.13, 0.2)
"""h is straight between these, and 0 from the last one on."""
_GRAIN_S = 0.0025
_ROUNDS = 3
_APART = 3
"""So many steps before the one in question are not asked what it should be like: the first that is not followed
differs by little, and would be taken for the rule."""
GENTLE = 4
"""So many steps are taken to be within the limits, or nothing can be said."""
_STRANGE = 1.5
"""So many times the usual error is another behaviour."""
_RESTED = 0.3
"""Of the samples of a rest, the last ones, in which the joint stands still."""


@dataclass(frozen=True, eq=False, slots=True)
class Trial:
    """One step: what a joint was told, (n,) at a rate, from rest on, and what was measured, (k,) times and positions;
    rad or mm, times in s from the first sample told. n_way: samples of each way with its rest, there and back by turns;
    n_rest: of the rest."""

    told: FloatArray
    times_s: FloatArray
    measured: FloatArray
    n_way: int
    n_rest: int

    def bins(self, rate_hz: float) -> tuple[IntArray, FloatArray]:
        """(k,) how many samples each measurement is into its way, and (k,) 1 there, -1 back."""
        samples = np.maximum(self.times_s * rate_hz - 0.5, 0.0).astype(np.int64)
        return samples % self.n_way, np.where(samples // self.n_way % 2, -1.0, 1.0)

    def play(self, rate_hz: float) -> float:
        """How much shorter its ways are than told, at rest; 0 where no rest was measured."""
        inside, way = self.bins(rate_hz)
        at_rest = inside >= self.n_way - max(round(_RESTED * self.n_rest), 1)
        there, back = self.measured[at_rest & (way > 0)], self.measured[at_rest & (way < 0)]
        if not len(there) or not len(back):
            return 0.0
        return max(float(np.ptp(self.told) - abs(there.mean() - back.mean())), 0.0)


def steps_followed(trials: Sequence[Trial], rate_hz: float, noise: float) -> tuple[int, FloatArray]:
    """How many of the trials, which go up, were followed as the gentler ones were, and the weights (m,) h. noise:
    what the folded error of a step is at least. 0 where even the gentlest are not followed alike."""
    play = float(np.median([trial.play(rate_hz) for trial in trials[:GENTLE]]))
    systems = [_System(trial, rate_hz, play) for trial in trials]
    weights = _fitted(systems[:GENTLE])
    usual = max(noise, float(np.median([system.error(weights) for system in systems[:GENTLE]])))
    followed = GENTLE
    while followed < len(systems) and systems[followed].error(weights) <= _STRANGE * usual:
        followed += 1
        weights = _fitted(systems[: max(GENTLE, followed - _APART)])
    return followed, weights


def answer(told: FloatArray, weights: FloatArray, rate_hz: float) -> FloatArray:
    """(n,) u of what was told (n,), from rest on."""
    times_s = np.arange(len(told)) / rate_hz
    answered: FloatArray = _told_before(told, times_s, rate_hz) @ weights
    return answered


def _told_before(told: FloatArray, times_s: FloatArray, rate_hz: float) -> FloatArray:
    """(k, m) what was told before each of the times (k,), weighed by the hat function of each knot of h."""
    lags_s = np.arange(0.0, _KNOTS_S[-1], _GRAIN_S)
    hats = np.stack([np.interp(lags_s, _KNOTS_S, np.eye(len(_KNOTS_S))[k]) for k in range(len(_KNOTS_S) - 1)], axis=1)
    grid = np.arange(len(told)) / rate_hz
    before: FloatArray = np.interp(np.subtract.outer(times_s, lags_s), grid, told) @ (hats / hats.sum(axis=0))
    return before


class _System:
    """The equations of one trial: rows (k, m) of what was told before each measurement, against the positions (k,)."""

    def __init__(self, trial: Trial, rate_hz: float, play: float) -> None:
        self._trial, self._play, self._rate_hz = trial, play, rate_hz
        self._grid = np.arange(len(trial.told)) / rate_hz
        self._inside, self._way = trial.bins(rate_hz)
        rows = _told_before(trial.told, trial.times_s, rate_hz)
        self.rows = rows - rows.mean()

    def values(self, weights: FloatArray | None) -> FloatArray:
        """(k,) positions less the effect of the play, as these weights tell it; None: the servo is where it is told."""
        u = self._trial.told if weights is None else answer(self._trial.told, weights, self._rate_hz)
        joint, at = np.empty_like(u), u[0] + self._play / 2  # it came down to where it begins
        for k, motor in enumerate(u.tolist()):
            at = min(max(at, motor - self._play / 2), motor + self._play / 2)
            joint[k] = at
        values: FloatArray = self._trial.measured - np.interp(self._trial.times_s, self._grid, joint - u)
        expected = self.rows[:, 0] if weights is None else self.rows @ weights
        values -= np.mean(values - expected)  # c
        return values

    def error(self, weights: FloatArray) -> float:
        """Root mean square of the folded error."""
        error = self._way * (self.values(weights) - self.rows @ weights)
        counts = np.bincount(self._inside, minlength=self._trial.n_way)
        sums = np.bincount(self._inside, weights=error, minlength=self._trial.n_way)
        seen = counts > 0
        means = sums[seen] / counts[seen]
        return float(np.sqrt(np.average(means**2, weights=counts[seen])))


def _fitted(systems: Sequence[_System]) -> FloatArray:
    """(m,) least squares, with a sum of 1."""
    rows = np.concatenate([system.rows for system in systems])
    whole = np.full((1, rows.shape[1]), 1e3 * np.sqrt(np.sum(rows[:, 0] ** 2)))
    left = np.concatenate((rows, whole))
    weights: FloatArray | None = None
    for _ in range(_ROUNDS):
        values = np.concatenate([system.values(weights) for system in systems])
        right = np.concatenate((values, whole[0, :1]))
        weights = np.asarray(np.linalg.lstsq(left, right, rcond=None)[0], dtype=np.float64)
    assert weights is not None
    return weights
