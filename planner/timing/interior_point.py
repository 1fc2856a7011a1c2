"""One Newton step after the other towards the least time: a primal-dual interior-point method for many paths at once.

The Newton systems are banded, so work is linear in the number of cells. Divided by sqrt(b), the jerk limit is a
linear expression against J / sqrt(b); the curvature of that right-hand side is used where it leaves the Newton system
positive definite and dropped elsewhere (sequential convex programming). Every iterate is strictly feasible: what is
returned keeps the limits there even if the iteration stops early.

Arrays have the cells on their last axis, so that sums over joints and ends run along memory.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg.lapack import dpbtrf, dpbtrs

from planner.arrays import BoolArray, FloatArray
from planner.ragged import starts_of, within
from planner.timing.timing_problem import FRACTIONS, TimingProblem

_ACCELERATION_POINTS = (0, 2)
"""Those at which acceleration limits are imposed; the right end is the left end of the next cell, or at rest."""

_BOOLE = np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90
"""Weights of the points for an integral over the cell."""

HERMITE = np.array([[1.0, 0.0, -3.0, 2.0], [0.0, 1.0, -2.0, 1.0], [0.0, 0.0, 3.0, -2.0], [0.0, 0.0, -1.0, 1.0]])
"""Polynomials in the fraction, lowest power first, of the four unknowns of a cell: b and b' at its left and right."""
_BOUNDARY = 0.95
_CENTRING, _MOST_CENTRING = 0.3, 0.9
_START_GAP = 3.0
"""Decrease of the barrier with every step, the less the shorter the step before had to be, and the barrier at the
start. Smaller ones let slacks run dry far from the optimum: steps then stay short, and the gap closes before the
gradient does."""
_START_SLOPE = 0.1
_LOWERED_BY = 1.2
"""How much a jerk limit is lowered at a point for each unit that the jerk exceeds it by nearby: the more, the less is
left to be slowed down for afterwards."""
_KEPT_SLACK = 0.1
"""Share of a slack that lowering its limit leaves."""


def _powers(fractions: FloatArray, derivative: int) -> FloatArray:
    """(n, 4) a derivative of 1, f, f^2, f^3 at the fractions."""
    f, one, zero = fractions, np.ones_like(fractions), np.zeros_like(fractions)
    rows = ((one, f, f**2, f**3), (zero, one, 2 * f, 3 * f**2), (zero, zero, 2 * one, 6 * f))
    return np.stack(rows[derivative], axis=1)


class Solver:
    """Newton's method for one set of paths."""

    def __init__(self, problem: TimingProblem) -> None:
        self.problem = problem
        n_cells = problem.n_cells
        self.n_paths = len(n_cells)
        count = 2 * n_cells + 2
        self.n_unknowns = int(count.sum())
        self.cell = np.repeat(starts_of(count)[:-1], n_cells) + 2 * within(n_cells)  # first unknown of a cell
        self.path_of_cell = np.repeat(np.arange(self.n_paths), n_cells)
        self.path_of_unknown = np.repeat(np.arange(self.n_paths), count)
        self.first_cell = starts_of(n_cells)[:-1]
        self.by_cap = problem.rate_limit**-2.0
        p = problem
        self.acceleration = np.stack(
            [
                _form(FRACTIONS[k], p.second_by_acceleration[k], 0.5 * p.first_by_acceleration[k], 0.0)
                for k in _ACCELERATION_POINTS
            ],
            axis=1,
        )
        self.jerk = np.stack(
            [
                _form(fraction, p.third_by_jerk[k], 1.5 * p.second_by_jerk[k], 0.5 * p.first_by_jerk[k])
                for k, fraction in enumerate(FRACTIONS)
            ],
            axis=1,
        )
        per_cell = len(FRACTIONS) + 2 * sum(form[0, ..., 0].size for form in (self.acceleration, self.jerk))
        self.n_limits = n_cells * per_cell

    def alone(self) -> FloatArray:
        """(cells,) the greatest b that each cell allows if it stays the same throughout."""
        p = self.problem
        with np.errstate(divide="ignore"):
            greatest = np.minimum(
                p.rate_limit.min(axis=0) ** 2, 1 / np.abs(p.second_by_acceleration).max(axis=(0, 1), initial=0.0)
            )
            least: FloatArray = np.minimum(greatest, np.abs(p.third_by_jerk).max(axis=(0, 1)) ** (-2 / 3))
        return least

    def start(self) -> FloatArray:
        """A feasible b: the lower envelope of what each cell allows alone, of limited slope in log b, scaled
        until all limits hold."""
        lowest = self.alone()
        largest = np.maximum.reduceat(np.where(np.isfinite(lowest), lowest, 0.0), self.first_cell)
        lowest = np.where(np.isfinite(lowest), lowest, np.where(largest > 0, largest, 1.0)[self.path_of_cell])
        knots = self.problem.n_cells + 1
        before = self.cell // 2  # index of the knot at the left end of a cell
        caps = np.full(int(knots.sum()), np.inf)
        for knot in (before, before + 1):
            caps[knot] = np.minimum(caps[knot], lowest)
        apart = 1e3 * np.repeat(np.arange(self.n_paths), knots) + np.arange(len(caps))  # keeps paths from each other
        level = np.log(caps)
        rise = np.minimum.accumulate(level - _START_SLOPE * apart) + _START_SLOPE * apart
        fall = np.minimum.accumulate((level + _START_SLOPE * apart)[::-1])[::-1] - _START_SLOPE * apart
        b = np.zeros(self.n_unknowns)
        b[0::2] = np.exp(np.minimum(rise, fall))
        b[3:-1:2] = 0.5 * (b[4::2] - b[:-4:2])
        ends = starts_of(2 * knots)
        b[ends[:-1] + 1] = b[ends[1:] - 1] = 0.0
        value, acceleration, jerk = self.values(b)
        worst = np.maximum((value * self.by_cap).max(axis=0), np.abs(acceleration).max(axis=(0, 1), initial=0.0))
        worst = np.maximum(worst, (np.abs(jerk).max(axis=1) * np.sqrt(value)).max(axis=0) ** (2 / 3))
        scaled: FloatArray = b * (0.7 / np.maximum.reduceat(worst, self.first_cell))[self.path_of_unknown]
        return scaled

    def values(self, b: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """b at the points of each cell (5, cells), relative acceleration at some of them (2, n_joints,
        cells) and relative jerk / sqrt(b) at all (5, n_joints, cells)."""
        four = np.stack([b[self.cell + k] for k in range(4)])
        acceleration, jerk = self.acceleration[0] * four[0], self.jerk[0] * four[0]
        for k in range(1, 4):
            acceleration += self.acceleration[k] * four[k]
            jerk += self.jerk[k] * four[k]
        return VALUE_FORMS @ four, acceleration, jerk

    def slacks(self, values: tuple[FloatArray, FloatArray, FloatArray], allowed: FloatArray) -> list[FloatArray]:
        """Distances to the limits, positive where they are kept: cap, acceleration +-, jerk +-."""
        value, acceleration, jerk = values
        room = allowed * (1.0 / np.sqrt(value))[:, None]
        return [1.0 - value * self.by_cap, 1.0 - acceleration, 1.0 + acceleration, room - jerk, room + jerk]

    def total(self, *per_cell: FloatArray) -> FloatArray:
        """(n_paths,) sums over all that belongs to a path."""
        sums: FloatArray = np.add.reduceat(
            sum(part.reshape(-1, part.shape[-1]).sum(axis=0) for part in per_cell), self.first_cell
        )
        return sums

    def smallest(self, per_cell: FloatArray) -> FloatArray:
        """(n_paths,) minima over all that belongs to a path."""
        minima: FloatArray = np.minimum.reduceat(
            per_cell.reshape(-1, per_cell.shape[-1]).min(axis=0, initial=np.inf), self.first_cell
        )
        return minima

    def times_s(self, value: FloatArray) -> FloatArray:
        return self.total(_BOOLE[:, None] / np.sqrt(value))

    def step(self, state: State, alive: BoolArray) -> State:
        """One primal-dual Newton step; each path takes the largest step that keeps it feasible."""
        centring = np.clip(1.0 - state.step, _CENTRING, _MOST_CENTRING)
        mu = np.where(alive, centring * state.gap, state.gap)[self.path_of_cell]
        value = state.value
        multipliers, slacks = state.multipliers, state.slacks
        pushes = [mu / slack for slack in slacks]  # the multipliers that the barrier wants
        stiffness = [multiplier / slack for multiplier, slack in zip(multipliers, slacks, strict=True)]
        root = value**-1.5
        room = state.allowed * root[:, None]
        direction, failed = self.direction(state, root, pushes, stiffness)
        stuck = state.stuck | failed
        direction *= (alive & ~stuck)[self.path_of_unknown]

        d_value, d_acceleration, d_jerk = self.values(direction)
        d_room = -0.5 * room * d_value[:, None]
        d_slacks = [-d_value * self.by_cap, -d_acceleration, d_acceleration, d_room - d_jerk, d_room + d_jerk]
        d_multipliers = [
            push - multiplier - weight * d
            for push, multiplier, weight, d in zip(pushes, multipliers, stiffness, d_slacks, strict=True)
        ]
        dual = np.minimum(1.0, _BOUNDARY * self.until_zero(multipliers, d_multipliers))
        primal = np.minimum(1.0, _BOUNDARY * self.until_zero([value, *slacks], [d_value, *d_slacks]))
        # The jerk limits curve, so a step that linearised slacks allow may still be too long.
        for _ in range(30):
            b = state.b + primal[self.path_of_unknown] * direction
            values = self.values(b)
            moved = self.slacks(values, state.allowed)
            bad = self.smallest(values[0]) <= 0
            for after, before in zip(moved[3:], slacks[3:], strict=True):
                bad |= ~(self.smallest(after - 0.1 * (1 - _BOUNDARY) * before) > 0)
            if not bad.any():
                break
            primal = np.where(bad, 0.6 * primal, primal)
        else:
            b = np.where(bad[self.path_of_unknown], state.b, b)
            values = self.values(b)
            moved = self.slacks(values, state.allowed)
        scale = dual[self.path_of_cell]
        updated = [multiplier + scale * d for multiplier, d in zip(multipliers, d_multipliers, strict=True)]
        allowed = _allowed(values[0], values[2], state.allowed)
        return State.of(
            self, b, values[0], self.slacks(values, allowed), updated, allowed, np.minimum(primal, dual), stuck
        )

    def direction(
        self, state: State, root: FloatArray, pushes: list[FloatArray], stiffness: list[FloatArray]
    ) -> tuple[FloatArray, BoolArray]:
        """Newton's direction for time - mu * sum of log(slack), with stiffness = multiplier / slack; and the paths
        (n_paths,) for which there is none."""
        allowed, multipliers = state.allowed, state.multipliers
        jerk_stiffness = stiffness[3] + stiffness[4]
        by_value = 0.5 * root * (np.einsum("ejk,ejk->ek", allowed, pushes[3] + pushes[4]) - _BOOLE[:, None])
        by_value += pushes[0] * self.by_cap
        # Second derivative of the time less that of the jerk limits' J / sqrt(b), where that is positive.
        convex = np.maximum(_BOOLE[:, None] - np.einsum("ejk,ejk->ek", allowed, multipliers[3] + multipliers[4]), 1e-9)
        second = 0.75 * convex * root / state.value
        second += 0.25 * root**2 * np.einsum("ejk,ejk,ejk->ek", allowed, allowed, jerk_stiffness)
        second += stiffness[0] * self.by_cap**2
        twisted = 0.5 * root[:, None] * allowed * (stiffness[3] - stiffness[4])
        jerk_push, acceleration_push = pushes[3] - pushes[4], pushes[1] - pushes[2]
        acceleration_stiffness = stiffness[1] + stiffness[2]
        gradient = np.zeros(self.n_unknowns)
        band = np.zeros((4, self.n_unknowns))
        crossed = [np.einsum("ejk,ejk->ek", self.jerk[k], twisted) for k in range(4)]
        for row in range(4):
            ends = VALUE_FORMS[:, row] @ by_value
            ends += np.einsum("ejk,ejk->k", self.jerk[row], jerk_push)
            ends += np.einsum("ejk,ejk->k", self.acceleration[row], acceleration_push)
            gradient[self.cell + row] += ends
            jerk, acceleration = self.jerk[row] * jerk_stiffness, self.acceleration[row] * acceleration_stiffness
            for column in range(row + 1):
                entry = (VALUE_FORMS[:, row] * VALUE_FORMS[:, column]) @ second
                entry += VALUE_FORMS[:, row] @ crossed[column] + VALUE_FORMS[:, column] @ crossed[row]
                entry += np.einsum("ejk,ejk->k", jerk, self.jerk[column])
                entry += np.einsum("ejk,ejk->k", acceleration, self.acceleration[column])
                band[row - column, self.cell + column] += entry
        return self.solved(band, gradient)

    def solved(self, band: FloatArray, gradient: FloatArray) -> tuple[FloatArray, BoolArray]:
        """-gradient by the lower band of a matrix, and the paths (n_paths,) whose part of it is not positive definite
        or not finite: nothing for these."""
        scale = 1.0 / np.sqrt(band[0])  # unknowns differ by orders of magnitude between corners and straights
        band *= scale
        for k in range(1, 4):
            band[k, :-k] *= scale[k:]
        band[0] *= scale
        band[0] += 1e-12
        right = scale * gradient
        failed = np.zeros(self.n_paths, dtype=bool)
        failed[self.path_of_unknown[~np.isfinite(band.sum(axis=0) + right)]] = True
        while True:
            out = failed[self.path_of_unknown]
            band[:, out], scale[out], right[out] = np.array([[1.0], [0.0], [0.0], [0.0]]), 0.0, 0.0
            factor, first_bad = dpbtrf(band, lower=1)
            if first_bad == 0:
                break
            failed[self.path_of_unknown[first_bad - 1]] = True
        newton: FloatArray = -scale * dpbtrs(factor, right, lower=1)[0]
        failed[self.path_of_unknown[~np.isfinite(newton)]] = True
        newton[failed[self.path_of_unknown]] = 0.0
        return newton, failed

    def until_zero(self, values: list[FloatArray], changes: list[FloatArray]) -> FloatArray:
        """(n_paths,) how many such changes the positive values of each path survive."""
        fastest = np.minimum.reduceat(
            np.minimum.reduce(
                [
                    (change / value).reshape(-1, value.shape[-1]).min(axis=0, initial=0.0)
                    for value, change in zip(values, changes, strict=True)
                ]
            ),
            self.first_cell,
        )
        steps: FloatArray = -1.0 / np.minimum(fastest, -1e-9)
        return steps


@dataclass(frozen=True, eq=False, slots=True)
class State:
    """An iterate: unknowns, b at the points, slacks and their multipliers, and per path the mean product of the two.

    allowed: (5, n_joints, cells) share of the jerk limits that is allowed at the points; step: (n_paths,) share of
    Newton's step that led here; stuck: (n_paths,) whether there is no way on from here.
    """

    b: FloatArray
    value: FloatArray
    slacks: list[FloatArray]
    multipliers: list[FloatArray]
    allowed: FloatArray
    time_s: FloatArray
    gap: FloatArray
    step: FloatArray
    stuck: BoolArray

    @staticmethod
    def of(
        solver: Solver,
        b: FloatArray,
        value: FloatArray,
        slacks: list[FloatArray],
        multipliers: list[FloatArray],
        allowed: FloatArray,
        step: FloatArray,
        stuck: BoolArray,
    ) -> State:
        products = solver.total(*(multiplier * slack for multiplier, slack in zip(multipliers, slacks, strict=True)))
        return State(
            b, value, slacks, multipliers, allowed, solver.times_s(value), products / solver.n_limits, step, stuck
        )

    @staticmethod
    def starting(solver: Solver, b: FloatArray) -> State:
        values = solver.values(b)
        allowed = np.ones_like(values[2])
        slacks = solver.slacks(values, allowed)
        mu = (_START_GAP * solver.times_s(values[0]) / solver.n_limits)[solver.path_of_cell]
        return State.of(
            solver,
            b,
            values[0],
            slacks,
            [mu / slack for slack in slacks],
            allowed,
            np.ones(solver.n_paths),
            np.zeros(solver.n_paths, dtype=bool),
        )

    def subset(self, solver: Solver, paths: BoolArray) -> State:
        cells = paths[solver.path_of_cell]
        return replace(
            self,
            b=self.b[paths[solver.path_of_unknown]],
            value=self.value[:, cells],
            slacks=[slack[..., cells] for slack in self.slacks],
            multipliers=[multiplier[..., cells] for multiplier in self.multipliers],
            allowed=self.allowed[..., cells],
            time_s=self.time_s[paths],
            gap=self.gap[paths],
            step=self.step[paths],
            stuck=self.stuck[paths],
        )


VALUE_FORMS = _powers(FRACTIONS, 0) @ HERMITE.T
"""(5 points, 4 unknowns) b at the points of a cell."""

_NEARBY = np.vander(np.add.outer(FRACTIONS[:-1], [1 / 16, 1 / 8, 3 / 16]).ravel(), len(FRACTIONS)) @ np.linalg.inv(
    np.vander(FRACTIONS, len(FRACTIONS))
)
"""(12, 5) values at quarters of the way from each of the points to the next, from those at the points."""


def _allowed(value: FloatArray, jerk: FloatArray, before: FloatArray) -> FloatArray:
    """(5, n_joints, cells) share of each jerk limit that is allowed at a point: less by what the jerk exceeds it
    nearby, the more so the nearer that is to the limit, and as far as slack is left.

    value, jerk: b and relative jerk / sqrt(b) at the points; before: the shares so far.
    """
    size = jerk * np.sqrt(value)[:, None]
    nearby = np.abs(_NEARBY @ size.reshape(len(FRACTIONS), -1)).reshape(-1, *size.shape[1:])
    np.abs(size, out=size)
    peak = size.copy()
    for side, furthest in ((peak[:-1], 0), (peak[1:], 2)):
        np.maximum(side, nearby[furthest::3], out=side)
        np.maximum(side, nearby[1::3], out=side)
    shares = peak**2
    shares *= shares
    shares *= size - peak
    shares *= _LOWERED_BY
    shares += 1.0
    return np.maximum(shares, size + np.maximum(_KEPT_SLACK * (before - size), 1e-9))


def _form(fraction: float, on_value: FloatArray, on_slope: FloatArray, on_bend: FloatArray | float) -> FloatArray:
    """(4, n_joints, cells) the form on_value b + on_slope b' + on_bend b'' at a fraction of each cell, in
    terms of the cell's unknowns."""
    value, slope, bend = (_powers(np.array([fraction]), derivative)[0] @ HERMITE.T for derivative in range(3))
    return np.stack([value[k] * on_value + slope[k] * on_slope + bend[k] * on_bend for k in range(4)])
