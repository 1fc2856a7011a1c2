"""Minimum-time motion along paths within joint velocity, acceleration and jerk limits.

With b = (dsigma/dt)^2 as a function of sigma and ' = d/dsigma, a joint path q(sigma) moves with

    velocity      q' sqrt(b)
    acceleration  q'' b + q' b'/2
    jerk          (q''' b + 3/2 q'' b' + 1/2 q' b'') sqrt(b)

(Verscheure et al. 2009 for the first two; the third is not convex). Each b is a cubic in every cell of its path with
value and slope in common at the cell ends, so acceleration is continuous and jerk jumps at cell ends only. Velocity
and jerk limits are imposed at five points of every cell, acceleration limits at its ends and middle.

The problem is solved by a primal-dual interior-point method whose Newton systems are banded, so work is
linear in the number of cells, and all paths are solved at once. Divided by sqrt(b), the jerk limit is a
linear expression against J / sqrt(b); the curvature of that right-hand side is used where it leaves the
Newton system positive definite and dropped elsewhere (sequential convex programming). Every iterate is
strictly feasible: what is returned keeps the limits there even if the iteration stops early.

Arrays have the cells on their last axis, so that sums over joints and ends run along memory.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solveh_banded

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.ragged import starts_of, within

_MOST_ITERATIONS = 80
FRACTIONS = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
"""Points of each cell at which velocity and jerk limits are imposed."""

_ACCELERATION_POINTS = (0, 2)
"""Those at which acceleration limits are imposed; the right end is the left end of the next cell, or at rest."""

_BOOLE = np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90
"""Weights of the points for an integral over the cell."""

_HERMITE = np.array([[1.0, 0.0, -3.0, 2.0], [0.0, 1.0, -2.0, 1.0], [0.0, 0.0, 3.0, -2.0], [0.0, 0.0, -1.0, 1.0]])
"""Polynomials in the fraction, lowest power first, of the four unknowns of a cell: b and b' at its left and right."""
_GAP = 1e-3
"""Iteration stops where the barrier can still save less than this share of a path's time."""
_BOUNDARY = 0.95
_CENTRING = 0.4
_START_GAP = 1.0
"""Barrier at the start and its decrease with every step. A smaller one lets slacks run dry far from the optimum:
steps then stay short, and the gap closes before the gradient does."""
_START_SLOPE = 0.25
_COMPACT_BELOW = 0.7
"""Paths that are done leave the working set once fewer than this share of its cells is still being improved."""


@dataclass(frozen=True, eq=False, slots=True)
class TimingProblem:
    """Paths to be timed, laid end to end, each at rest at both ends (q' = q'' = 0 there).

    n_cells: (n_paths,); rate_cap: (5, total cells) cap on dsigma/dt at FRACTIONS of every cell; the others:
    (5, n_joints, total cells) derivatives of the joints by sigma at FRACTIONS of every cell, divided by
    the limit that the name says.
    """

    n_cells: IntArray
    rate_cap: FloatArray
    first_by_acceleration: FloatArray
    second_by_acceleration: FloatArray
    first_by_jerk: FloatArray
    second_by_jerk: FloatArray
    third_by_jerk: FloatArray

    @staticmethod
    def of(n_cells: IntArray, derivatives: tuple[FloatArray, FloatArray, FloatArray],
           limits: tuple[FloatArray, FloatArray, FloatArray], rate_cap: FloatArray) -> TimingProblem:
        """derivatives: q', q'', q''' (total cells, 5, n_joints) at FRACTIONS; limits: velocity, acceleration, jerk
        (n_joints,); rate_cap: (total cells,), the pen's own at the left end of every cell, inf where it has none."""
        first, second, third = (np.ascontiguousarray(np.moveaxis(derivative, 0, 2)) for derivative in derivatives)
        velocity, acceleration, jerk = (limit[:, None] for limit in limits)
        with np.errstate(divide="ignore"):
            by_velocity = 1.0 / np.abs(first / velocity).max(axis=1)
        right = np.append(rate_cap[1:], np.inf)
        right[starts_of(n_cells)[1:] - 1] = np.inf  # at rest
        cap = np.stack([rate_cap, *[np.minimum(rate_cap, right)] * (len(FRACTIONS) - 2), right])
        return TimingProblem(n_cells, np.minimum(cap, by_velocity), first / acceleration, second / acceleration,
                             first / jerk, second / jerk, third / jerk)

    def subset(self, paths: BoolArray) -> TimingProblem:
        """Only the paths of the mask (n_paths,)."""
        cells = np.repeat(paths, self.n_cells)
        return TimingProblem(
            self.n_cells[paths], self.rate_cap[:, cells], self.first_by_acceleration[..., cells],
            self.second_by_acceleration[..., cells], self.first_by_jerk[..., cells],
            self.second_by_jerk[..., cells], self.third_by_jerk[..., cells])


def minimum_time(problem: TimingProblem) -> FloatArray:
    """(total cells, 4) polynomials of b in each cell, lowest power of the fraction first, near the least time that
    the limits allow."""
    solver = _Solver(problem)
    cells = solver.cell
    result = solver.start()
    state = _State.starting(solver, result)
    where = np.arange(len(result))  # of the working set's unknowns in the result
    for _ in range(_MOST_ITERATIONS):
        alive = state.gap * solver.n_limits > _GAP * state.time_s
        if np.repeat(alive, solver.problem.n_cells).mean() < _COMPACT_BELOW:
            result[where] = state.b
            if not alive.any():
                break
            where = where[alive[solver.path_of_unknown]]
            state = state.subset(solver, alive)
            solver = _Solver(solver.problem.subset(alive))
            alive = np.ones(solver.n_paths, dtype=bool)
        state = solver.step(state, alive)
    else:
        result[where] = state.b
    four = np.stack([result[cells + k] for k in range(4)], axis=1)
    rates: FloatArray = four @ _HERMITE
    return rates


def _powers(fractions: FloatArray, derivative: int) -> FloatArray:
    """(n, 4) a derivative of 1, f, f^2, f^3 at the fractions."""
    f, one, zero = fractions, np.ones_like(fractions), np.zeros_like(fractions)
    rows = ((one, f, f ** 2, f ** 3), (zero, one, 2 * f, 3 * f ** 2), (zero, zero, 2 * one, 6 * f))
    return np.stack(rows[derivative], axis=1)


class _Solver:
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
        per_joint = 2 * (len(_ACCELERATION_POINTS) + len(FRACTIONS))
        self.n_limits = n_cells * (len(FRACTIONS) + per_joint * problem.first_by_jerk.shape[1])
        self.cap = problem.rate_cap ** 2
        p = problem
        self.acceleration = np.stack([
            _form(FRACTIONS[k], p.second_by_acceleration[k], 0.5 * p.first_by_acceleration[k], 0.0)
            for k in _ACCELERATION_POINTS], axis=1)
        self.jerk = np.stack([
            _form(fraction, p.third_by_jerk[k], 1.5 * p.second_by_jerk[k], 0.5 * p.first_by_jerk[k])
            for k, fraction in enumerate(FRACTIONS)], axis=1)

    def start(self) -> FloatArray:
        """A feasible b: the lower envelope of what each cell allows alone, of limited slope in log b, scaled
        until all limits hold."""
        p = self.problem
        with np.errstate(divide="ignore"):
            lowest = np.minimum(self.cap.min(axis=0), 1 / np.abs(p.second_by_acceleration).max(axis=(0, 1)))
            lowest = np.minimum(lowest, np.abs(p.third_by_jerk).max(axis=(0, 1)) ** (-2 / 3))
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
        worst = np.maximum((value / self.cap).max(axis=0), np.abs(acceleration).max(axis=(0, 1)))
        worst = np.maximum(worst, (np.abs(jerk).max(axis=1) * np.sqrt(value)).max(axis=0) ** (2 / 3))
        scaled: FloatArray = b * (0.7 / np.maximum.reduceat(worst, self.first_cell))[self.path_of_unknown]
        return scaled

    def values(self, b: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """b at the points of each cell (5, cells), relative acceleration at some of them (2, n_joints,
        cells) and relative jerk / sqrt(b) at all (5, n_joints, cells)."""
        four = b[self.cell], b[self.cell + 1], b[self.cell + 2], b[self.cell + 3]
        value = np.stack([form[0] * four[0] + form[1] * four[1] + form[2] * four[2] + form[3] * four[3]
                          for form in _VALUE_FORMS])
        acceleration, jerk = self.acceleration[0] * four[0], self.jerk[0] * four[0]
        for k in range(1, 4):
            acceleration += self.acceleration[k] * four[k]
            jerk += self.jerk[k] * four[k]
        return value, acceleration, jerk

    def slacks(self, values: tuple[FloatArray, FloatArray, FloatArray]) -> list[FloatArray]:
        """Distances to the limits, positive where they are kept: cap, acceleration +-, jerk +-."""
        value, acceleration, jerk = values
        with np.errstate(invalid="ignore", divide="ignore"):
            room = (1.0 / np.sqrt(value))[:, None]
        return [1.0 - value / self.cap, 1.0 - acceleration, 1.0 + acceleration, room - jerk, room + jerk]

    def total(self, per_cell: FloatArray) -> FloatArray:
        """(n_paths,) sums over all that belongs to a path."""
        sums: FloatArray = np.add.reduceat(per_cell.reshape(-1, per_cell.shape[-1]).sum(axis=0), self.first_cell)
        return sums

    def smallest(self, per_cell: FloatArray) -> FloatArray:
        """(n_paths,) minima over all that belongs to a path."""
        minima: FloatArray = np.minimum.reduceat(
            per_cell.reshape(-1, per_cell.shape[-1]).min(axis=0), self.first_cell)
        return minima

    def times_s(self, value: FloatArray) -> FloatArray:
        return self.total(_BOOLE[:, None] / np.sqrt(value))

    def step(self, state: _State, alive: BoolArray) -> _State:
        """One primal-dual Newton step; each path takes the largest step that keeps it feasible."""
        mu = np.where(alive, _CENTRING * state.gap, state.gap)[self.path_of_cell]
        value = self.values(state.b)[0]
        multipliers, slacks = state.multipliers, state.slacks
        pushes = [mu / slack for slack in slacks]  # the multipliers that the barrier wants
        stiffness = [multiplier / slack for multiplier, slack in zip(multipliers, slacks, strict=True)]
        root = value ** -1.5
        direction = self.direction(value, root, multipliers, pushes, stiffness) * alive[self.path_of_unknown]

        d_value, d_acceleration, d_jerk = self.values(direction)
        d_room = (-0.5 * root * d_value)[:, None]
        d_slacks = [-d_value / self.cap, -d_acceleration, d_acceleration, d_room - d_jerk, d_room + d_jerk]
        d_multipliers = [push - multiplier - weight * d for push, multiplier, weight, d
                         in zip(pushes, multipliers, stiffness, d_slacks, strict=True)]
        dual = np.ones(self.n_paths)
        for multiplier, d in zip(multipliers, d_multipliers, strict=True):
            dual = np.minimum(dual, _BOUNDARY * self.until_zero(multiplier, d))
        primal = np.minimum(1.0, _BOUNDARY * self.until_zero(value, d_value))
        for slack, d in zip(slacks, d_slacks, strict=True):
            primal = np.minimum(primal, _BOUNDARY * self.until_zero(slack, d))
        # The jerk limits curve, so a step that linearised slacks allow may still be too long.
        for _ in range(30):
            b = state.b + primal[self.path_of_unknown] * direction
            values = self.values(b)
            moved = self.slacks(values)
            bad = self.smallest(values[0]) <= 0
            for after, before in zip(moved[3:], slacks[3:], strict=True):
                bad |= ~(self.smallest(after - 0.1 * (1 - _BOUNDARY) * before) > 0)
            if not bad.any():
                break
            primal = np.where(bad, 0.6 * primal, primal)
        else:
            b = np.where(bad[self.path_of_unknown], state.b, b)
            values = self.values(b)
            moved = self.slacks(values)
        scale = dual[self.path_of_cell]
        updated = [multiplier + scale * d for multiplier, d in zip(multipliers, d_multipliers, strict=True)]
        return _State.of(self, b, values[0], moved, updated)

    def direction(self, value: FloatArray, root: FloatArray, multipliers: list[FloatArray],
                  pushes: list[FloatArray], stiffness: list[FloatArray]) -> FloatArray:
        """Newton's direction for time - mu * sum of log(slack), with stiffness = multiplier / slack."""
        jerk_stiffness = stiffness[3] + stiffness[4]
        by_value = -0.5 * _BOOLE[:, None] * root + 0.5 * root * (pushes[3] + pushes[4]).sum(axis=1)
        by_value += pushes[0] / self.cap
        # Second derivative of the time less that of the jerk limits' J / sqrt(b), where that is positive.
        convex = np.maximum(_BOOLE[:, None] - (multipliers[3] + multipliers[4]).sum(axis=1), 1e-9)
        second = 0.75 * convex * root / value
        second += 0.25 * root ** 2 * jerk_stiffness.sum(axis=1)
        second += stiffness[0] / self.cap ** 2
        crossed = 0.5 * root * np.einsum("fejk,ejk->fek", self.jerk, stiffness[3] - stiffness[4])
        signed = (pushes[1] - pushes[2], pushes[3] - pushes[4])
        gradient = np.zeros(self.n_unknowns)
        for k in range(4):
            ends = _VALUE_FORMS[:, k] @ by_value
            ends += np.einsum("ejk,ejk->k", self.jerk[k], signed[1])
            ends += np.einsum("ejk,ejk->k", self.acceleration[k], signed[0])
            gradient[self.cell + k] += ends
        band = np.zeros((4, self.n_unknowns))
        acceleration_stiffness = stiffness[1] + stiffness[2]
        for row in range(4):
            for column in range(row + 1):
                entry = (_VALUE_FORMS[:, row] * _VALUE_FORMS[:, column]) @ second
                entry += _VALUE_FORMS[:, row] @ crossed[column] + _VALUE_FORMS[:, column] @ crossed[row]
                entry += np.einsum("ejk,ejk,ejk->k", self.jerk[row], self.jerk[column], jerk_stiffness)
                entry += np.einsum("ejk,ejk,ejk->k", self.acceleration[row], self.acceleration[column],
                                   acceleration_stiffness)
                band[row - column, self.cell + column] += entry
        scale = 1.0 / np.sqrt(band[0])  # unknowns differ by orders of magnitude between corners and straights
        band *= scale
        for k in range(1, 4):
            band[k, :-k] *= scale[k:]
        band[0] *= scale
        band[0] += 1e-12
        newton: FloatArray = -scale * solveh_banded(band, scale * gradient, lower=True, check_finite=False)
        return newton

    def until_zero(self, value: FloatArray, change: FloatArray) -> FloatArray:
        """(n_paths,) how many such changes the positive values of each path survive."""
        fastest = self.smallest(change / value)
        steps: FloatArray = np.where(fastest < 0, -1.0 / np.where(fastest < 0, fastest, -1.0), np.inf)
        return steps


@dataclass(frozen=True, eq=False, slots=True)
class _State:
    """An iterate: unknowns, slacks and their multipliers, and per path the mean product of the two."""

    b: FloatArray
    slacks: list[FloatArray]
    multipliers: list[FloatArray]
    time_s: FloatArray
    gap: FloatArray

    @staticmethod
    def of(solver: _Solver, b: FloatArray, value: FloatArray, slacks: list[FloatArray],
           multipliers: list[FloatArray]) -> _State:
        products = sum(solver.total(multiplier * slack) for multiplier, slack in zip(multipliers, slacks, strict=True))
        return _State(b, slacks, multipliers, solver.times_s(value), products / solver.n_limits)

    @staticmethod
    def starting(solver: _Solver, b: FloatArray) -> _State:
        values = solver.values(b)
        slacks = solver.slacks(values)
        mu = (_START_GAP * solver.times_s(values[0]) / solver.n_limits)[solver.path_of_cell]
        return _State.of(solver, b, values[0], slacks, [mu / slack for slack in slacks])

    def subset(self, solver: _Solver, paths: BoolArray) -> _State:
        cells = paths[solver.path_of_cell]
        return _State(self.b[paths[solver.path_of_unknown]], [slack[..., cells] for slack in self.slacks],
                      [multiplier[..., cells] for multiplier in self.multipliers], self.time_s[paths], self.gap[paths])


_VALUE_FORMS = _powers(FRACTIONS, 0) @ _HERMITE.T
"""(5 points, 4 unknowns) b at the points of a cell."""


def _form(fraction: float, on_value: FloatArray, on_slope: FloatArray, on_bend: FloatArray | float) -> FloatArray:
    """(4, n_joints, cells) the form on_value b + on_slope b' + on_bend b'' at a fraction of each cell, in
    terms of the cell's unknowns."""
    value, slope, bend = (_powers(np.array([fraction]), derivative)[0] @ _HERMITE.T for derivative in range(3))
    return np.stack([value[k] * on_value + slope[k] * on_slope + bend[k] * on_bend for k in range(4)])
