"""How a servo answers, and up to which step of a test motion it does so in one and the same way.

Within its limits a servo is linear, and its gears have play: the joint is at

    y = c + P_b(u),   u(t) = sum of h_m x(t - m / rate),

where x is what the servo was told. Lag, delay and overshoot are in the weights h, which add up to 1; P_b is the play
operator: the joint stays where it is until u has come half of the play b away from it. b shows at rest, in how much
shorter ways are than told. h is fitted by least squares, to the measured positions with the effect of the play taken
out. What the gentler steps tell of h foretells the next step.

A servo that is limited to a little less than a step asks for goes the same way and arrives later: u becomes u + a d,
where d is the difference that a limit lower by `BY` makes, and a is 0 where the step is followed and 1 where the limit
is so much lower. a is fitted to each step, there and back apart: gravity helps one of them. Where its standard error is
not small beside 1, a step tells nothing. A servo that is limited in another way shows by what h leaves unexplained.
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
_BEND = 0.05
"""How much h bends from knot to knot, as far as what is measured does not tell."""
_WHOLE = 1e6
"""How much more it counts that weights add up to 1 than any measurement."""
_ROUNDS = 3
_IN_A_ROW = 3
"""So many steps have to be strange; noise makes one so, now and then."""
_GROWN, _AT_ONCE = 2.0, 6
"""So many times the usual error is reached by them where a limit is the reason, and after so many steps at most: from
there on errors grow fast. What was strange before that is only doubtful."""
_APART = 4
"""So many steps before the one in question are not asked what it should be like: the first that is not followed
differs by little, and would be taken for the rule."""
GENTLE = 4
"""So many steps are taken to be within the limits, or nothing can be said."""
BY = 1.15
_LEAST, _ERRORS = 0.15, 4.0
"""a is above what is usual from so much on, and from so many standard errors of it, or of what is usual, on."""
_OF_A_NORMAL = 1.4826
"""Standard deviation of a normal distribution, in its median deviations."""
_SHOWS = 0.3
"""Standard error of a, at most, where a step tells something."""
_STRANGE = 1.35
"""So many times the usual error, as a share of the way, is another behaviour, whatever it is like."""
_RECENT = 7
"""So many of the steps before say what is usual."""
_RESTED = 0.3
"""Of the samples of a rest, the last ones, in which the joint stands still."""


@dataclass(frozen=True, eq=False, slots=True)
class Trial:
    """One step: what a joint was told, (n,) at a rate, from rest on; limited: (n,) what it would be told by one that
    has 1 / BY of what is tried; and what was measured, (k,) times and positions; rad or mm, times in s from the first
    sample told. n_way: samples of each way with its rest, there and back by turns; n_rest: of the rest."""

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
    """followed: the last step of a ladder that was and tells it, 0 for none. refused: the first from which on none is,
    None where there is none. weights: (m,) h, by those that were."""

    followed: int
    refused: int | None
    weights: FloatArray


def followings(ladders: Sequence[Sequence[Trial]], rate_hz: float) -> list[Following]:
    """Of the ladders of one joint, each of which goes up."""
    gentle = [trial for ladder in ladders for trial in ladder[:GENTLE]]
    play = float(np.median([trial.play(rate_hz) for trial in gentle]))
    systems = [[_System(trial, rate_hz, play) for trial in ladder] for ladder in ladders]
    first = [system for ladder in systems for system in ladder[:GENTLE]]
    rule = _Rule()
    for again in range(_ROUNDS):
        rule = _Rule(rule.weights) if again else rule
        for system in first:
            rule.take(system)
    weights = rule.weights
    rough = float(np.sqrt(np.mean([system.judged(weights).off ** 2 for system in first])))
    return [_following(ladder, rule, rough) for ladder in systems]


def _following(ladder: Sequence[_System], gentle: _Rule, rough: float) -> Following:
    """rough: how far off a joint is on gentle steps, whatever the way."""
    rule, followed, strange = gentle.copy(), 0, 0
    usual: list[_Judged] = []
    for number, system in enumerate(ladder, 1):
        if number - _APART > GENTLE:
            rule.take(ladder[number - _APART - 1])
        judged = system.judged(rule.weights)
        if number > GENTLE and judged.is_strange(usual[-_RECENT:], rough):
            strange += 1
            if strange >= _IN_A_ROW and judged.error > _GROWN * np.median([one.error for one in usual[-_RECENT:]]):
                return Following(followed, number - min(strange, _AT_ONCE) + 1, rule.weights)
            continue
        strange = 0
        usual.append(judged)
        if judged.shows:
            followed = number
    return Following(followed, None, rule.weights)


@dataclass(frozen=True, eq=False, slots=True)
class _Judged:
    """Of one step, there and back: a and its standard error (2,), and how much a of 1 is, root mean square; error: root
    mean square of what h leaves, as a share of the way."""

    share: FloatArray
    doubt: FloatArray
    size: FloatArray
    error: float

    @property
    def shows(self) -> bool:
        return bool(np.all(self.doubt <= _SHOWS))

    @property
    def off(self) -> FloatArray:
        """(2,) a, in rad or mm."""
        return self.share * self.size

    def is_strange(self, usual: list[_Judged], rough: float) -> bool:
        """usual: of the steps before."""
        share, its_spread = _usual(np.array([one.share for one in usual]))
        error, errors_spread = _usual(np.array([one.error for one in usual]))
        doubt = np.maximum(np.maximum(self.doubt, its_spread), rough / self.size)
        is_late = np.any(np.abs(self.share - share) > np.maximum(_LEAST, _ERRORS * doubt))
        return bool(is_late or self.error > max(_STRANGE * error, error + _ERRORS * errors_spread))


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
        share, doubt, size, squares = np.zeros(2), np.zeros(2), np.zeros(2), 0.0
        for k, way in enumerate((1.0, -1.0)):
            mine = self._way == way
            r, d = residual[mine] - residual[mine].mean(), late[mine] - late[mine].mean()
            power = max(float(d @ d), 1e-30)
            share[k] = r @ d / power
            left = r - share[k] * d
            doubt[k] = np.sqrt(left @ left / max(len(r) - 2, 1) / power)
            size[k] = np.sqrt(power / len(d))
            squares += r @ r
        return _Judged(share, doubt, size, float(np.sqrt(squares / len(residual)) / np.ptp(self._trial.told)))


def _usual(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Median over the first axis, and the standard deviation that goes with the median deviation from it."""
    middle: FloatArray = np.median(values, axis=0)
    return middle, _OF_A_NORMAL * np.median(np.abs(values - middle), axis=0)


class _Rule:
    """h by least squares, with a sum of 1, of the steps that it takes."""

    def __init__(self, before: FloatArray | None = None) -> None:
        """before: weights by which the effect of the play is taken out of steps; None: it is where it is told."""
        self._before = before
        self._squares, self._products = np.zeros((_N_WEIGHTS, _N_WEIGHTS)), np.zeros(_N_WEIGHTS)
        self._of_values, self._number = 0.0, 0

    def take(self, system: _System) -> None:
        self._squares = self._squares + system.rows.T @ system.rows
        values = system.values(self._before)
        self._products = self._products + system.rows.T @ values
        self._of_values += float(values @ values)
        self._number += len(values)

    @property
    def weights(self) -> FloatArray:
        whole = _WHOLE * self._squares[0, 0]
        squares, products = self._squares + whole, self._products + whole
        at_will = np.linalg.lstsq(squares, products, rcond=None)[0]
        left = self._of_values - 2 * at_will @ self._products + at_will @ self._squares @ at_will
        bends = np.diff(np.eye(_N_WEIGHTS + 2)[:, 1:-1], 2, axis=0)
        found: FloatArray = np.linalg.solve(
            squares + max(left, 0.0) / self._number / _BEND**2 * bends.T @ bends, products
        )
        return found

    def copy(self) -> _Rule:
        other = _Rule(self.weights)
        other._squares, other._products = self._squares, self._products
        other._of_values, other._number = self._of_values, self._number
        return other
