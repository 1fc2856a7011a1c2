"""How a servo answers, and up to which step of a test motion it does so in one and the same way.

Within its limits a servo is linear, and its gears have play: the joint is at

    y = c + P_b(u),   u(t) = sum of h_m x(t - m / rate),

where x is what the servo was told. Lag, delay and overshoot are in the weights h, which add up to 1; P_b is the play
operator: the joint stays where it is until u has come half of the play b away from it. b shows at rest, in how much
shorter ways are than told. h is fitted by least squares, to the measured positions with the effect of the play taken
out. What the gentler steps tell of h foretells the next step.

A servo that is limited to a little less than a step asks for goes the same way and arrives later: u becomes u + a d,
where d is the difference that a limit lower by `BY` makes, and a is 0 where the step is followed and 1 where the limit is
so much lower. a is fitted to each step, there and back apart: gravity helps one of them. Where its standard error is not
small beside 1, a step tells nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray

_KNOTS_S = (0.0, 0.01, 0.02, 0.035, 0.055, 0.085, 0.13, 0.2)
"""h is straight between these, and 0 from the last one on."""
_GRAIN_S = 0.0025
_N_WEIGHTS = len(_KNOTS_S) - 1
_WHOLE = 1e6
"""How much more it counts that weights add up to 1 than any measurement."""
_ROUNDS = 3
_APART = 3
"""So many steps before the one in question are not asked what it should be like: the first that is not followed
differs by little, and would be taken for the rule."""
GENTLE = 4
"""So many steps are taken to be within the limits, or nothing can be said."""
BY = 1.15
_LEAST, _ERRORS = 0.35, 4.0
"""a is above 0 from here on, and from so many standard errors on."""
_SHOWS = 0.25
"""Standard error of a, at most, where a step tells something."""
_STRANGE = 3.0
"""So many times the usual error, as a share of the way, is another behaviour, whatever it is like."""
_RECENT = 7
"""So many of the steps before say what is usual."""
_RESTED = 0.3
"""Of the samples of a rest, the last ones, in which the joint stands still."""


@dataclass(frozen=True, eq=False, slots=True)
class Trial:
    """One step: what a joint was told, (n,) at a rate, from rest on; limited: (n,) what it would be told by one that has
    1 / BY of what is tried; and what was measured, (k,) times and positions; rad or mm, times in s from the first sample
    told. n_way: samples of each way with its rest, there and back by turns; n_rest: of the rest."""

    told: FloatArray
    limited: FloatArray
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


@dataclass(frozen=True, eq=False, slots=True)
class Following:
    """followed: how many steps of a ladder were, 0 where none tells. weights: (m,) h, by the last that were."""

    followed: int
    weights: FloatArray


def followings(ladders: Sequence[Sequence[Trial]], rate_hz: float) -> list[Following]:
    """Of the ladders of one joint, each of which goes up."""
    gentle = [trial for ladder in ladders for trial in ladder[:GENTLE]]
    play = float(np.median([trial.play(rate_hz) for trial in gentle]))
    systems = [[_System(trial, rate_hz, play) for trial in ladder] for ladder in ladders]
    weights: FloatArray | None = None
    for _ in range(_ROUNDS):
        rule = _Rule(weights)
        for system in (system for ladder in systems for system in ladder[:GENTLE]):
            rule.take(system)
        weights = rule.weights
    return [_following(ladder, rule) for ladder in systems]


def _following(ladder: Sequence[_System], gentle: _Rule) -> Following:
    rule, followed, doubtful = gentle.copy(), 0, 0
    usual: list[tuple[FloatArray, float]] = []
    for number, system in enumerate(ladder, 1):
        if number - _APART > GENTLE:
            rule.take(ladder[number - _APART - 1])
        judged = system.judged(rule.weights)
        if number > GENTLE and judged.is_strange(usual):
            doubtful += 1
            if doubtful == 2:
                break
            continue
        doubtful = 0
        usual.append((judged.share, judged.error))
        if judged.shows:
            followed = number
    return Following(followed, rule.weights)


@dataclass(frozen=True, eq=False, slots=True)
class _Judged:
    """Of one step, there and back: a and its standard error (2,); error: root mean square, as a share of the way."""

    share: FloatArray
    doubt: FloatArray
    error: float

    @property
    def shows(self) -> bool:
        return bool(np.all(self.doubt <= _SHOWS))

    def is_strange(self, usual: list[tuple[FloatArray, float]]) -> bool:
        recent = usual[-_RECENT:]
        share = self.share - np.median([one for one, _ in recent], axis=0)
        error = float(np.median([one for _, one in recent]))
        return bool(np.any(share > np.maximum(_LEAST, _ERRORS * self.doubt))) or self.error > _STRANGE * error


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
        self._late = _told_before(trial.limited - trial.told, trial.times_s, rate_hz)

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

    def judged(self, weights: FloatArray) -> _Judged:
        residual, late = self.values(weights) - self.rows @ weights, self._late @ weights
        share, doubt, squares = np.zeros(2), np.zeros(2), 0.0
        for k, way in enumerate((1.0, -1.0)):
            mine = self._way == way
            r, d = residual[mine] - residual[mine].mean(), late[mine] - late[mine].mean()
            power = max(float(d @ d), 1e-30)
            share[k] = r @ d / power
            left = r - share[k] * d
            doubt[k] = np.sqrt(left @ left / max(len(r) - 2, 1) / power)
            squares += r @ r
        return _Judged(share, doubt, float(np.sqrt(squares / len(residual)) / np.ptp(self._trial.told)))


class _Rule:
    """h by least squares, with a sum of 1, of the steps that it takes."""

    def __init__(self, before: FloatArray | None = None) -> None:
        """before: weights by which the effect of the play is taken out of steps; None: the servo is where it is told."""
        self._before = before
        self._squares, self._products = np.zeros((_N_WEIGHTS, _N_WEIGHTS)), np.zeros(_N_WEIGHTS)

    def take(self, system: _System) -> None:
        self._squares = self._squares + system.rows.T @ system.rows
        self._products = self._products + system.rows.T @ system.values(self._before)

    @property
    def weights(self) -> FloatArray:
        whole = _WHOLE * self._squares[0, 0]
        found: FloatArray = np.linalg.solve(self._squares + whole, self._products + whole)
        return found

    def copy(self) -> _Rule:
        other = _Rule(self.weights)
        other._squares, other._products = self._squares, self._products
        return other
