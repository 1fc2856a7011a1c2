"""The smoothest paths within a tube: those of the least integral of the squared third derivative.

Sigma is near to time along a path that is made for it, so the third derivative is near to jerk, which is what limits
the pen where it turns. A path may use all of its tube, and what its polyline has of facets and noise inside the tube
costs nothing. The problem is a convex quadratic one with bounds, in two unknowns a control point: a primal-dual
interior-point method solves it for many paths at once, from any start, by banded systems.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.lapack import dpbtrf, dpbtrs
from planner.placement.tube import Tube, local_controls
from planner.ragged import starts_of
from planner.spline import weights
from planner.spline_paths import DEGREE, SplinePaths

_LOCAL = 2 * (DEGREE + 1)
_ITERATIONS = 8
"""Hardly anything is to be gained by more."""
_START = 100.0
"""The barrier at the start, in shares of the price. With less of it slacks run dry far from the optimum, where facets
by the thousand each ask for a little, and steps stay short."""
_CENTRING, _MOST_CENTRING = 0.1, 0.9
"""Factors of the barrier with every step: the nearer to the second, the shorter the step before."""
_BOUNDARY = 0.95
"""Share of the way to the nearest bound that a step may go."""
_LEAST_SLACK = 0.1
"""Share of a bound that its slack begins with where the bound is broken."""
_SHIFT = 1e-9
_RAMP = np.array([-1.0, 0.1, 0.0, -0.1, 1.0])
"""The first control points of sigma cubed, in terms of the fifth: at the ends paths stay so, and at rest."""


def _third_derivative_price() -> FloatArray:
    """(12, 12) the integral over a cell of the squared third derivative, as a form of its control points."""
    nodes, node_weights = np.polynomial.legendre.leggauss(DEGREE)
    third = weights(DEGREE, 0.5 * (nodes + 1), 3)
    return np.kron(np.einsum("q,qi,qj->ij", 0.5 * node_weights, third, third), np.eye(2))


_PRICE = _third_derivative_price()


def smoothest(paths: SplinePaths, tube: Tube) -> FloatArray:
    """(n_controls, 2) control points of the paths of x and y (and more, which is ignored) with the smoothest within the
    tube, near enough; both ends stay where they are."""
    problem = _Problem(paths, tube)
    at = _Iterate(problem, paths.controls[:, :2])
    for _ in range(_ITERATIONS):
        if not at.improved():
            break
    return at.controls


class _Problem:
    """The tube and the price in terms of the unknowns: x and y of all control points, the first four and the last
    four of each path aside, which follow from the fifth.

    rows: (cells, n_bounds, 12), price: (cells, 12, 12), of the unknowns (cells, 12) of each cell.
    """

    def __init__(self, paths: SplinePaths, tube: Tube) -> None:
        self.tube = tube
        controls = local_controls(paths)
        self.controls_of_path = starts_of(paths.n_cells + DEGREE)
        self.first_cell = starts_of(paths.n_cells)[:-1]
        self.path_of_cell = np.repeat(np.arange(len(paths.n_cells)), paths.n_cells)
        self.path_of_control = np.repeat(np.arange(len(paths.n_cells)), paths.n_cells + DEGREE)
        self.unknowns: IntArray = (2 * controls[:, :, None] + np.arange(2)).reshape(len(controls), _LOCAL)
        self.n_unknowns = 2 * int(self.controls_of_path[-1])
        self.n_bounds = 2 * tube.rows.shape[1] * paths.n_cells
        self.rows = tube.rows.copy()
        self.price = np.broadcast_to(_PRICE, (len(controls), _LOCAL, _LOCAL)).copy()
        self.ends = self._ends(paths.n_cells)
        for cells, from_unknowns in self.ends:
            self.rows[cells] = self.rows[cells] @ from_unknowns
            self.price[cells] = from_unknowns.T @ self.price[cells] @ from_unknowns

    def _ends(self, n_cells: IntArray) -> list[tuple[IntArray, FloatArray]]:
        """The first four cells of all paths, one after the other, and the last four: how (12, 12) their control points
        follow from the unknowns."""
        found: list[tuple[IntArray, FloatArray]] = []
        for k in range(DEGREE):
            at_start = np.zeros((DEGREE + 1, DEGREE + 1))
            for i in range(DEGREE + 1):
                ramp = k + i < DEGREE
                at_start[i, DEGREE - 1 - k if ramp else i] = _RAMP[k + i] if ramp else 1.0
            from_unknowns: FloatArray = np.kron(at_start, np.eye(2)).astype(np.float64)
            mirrored: FloatArray = np.kron(at_start[::-1, ::-1], np.eye(2)).astype(np.float64)
            found.append((self.first_cell + k, from_unknowns))
            found.append((self.first_cell + n_cells - 1 - k, mirrored))
        return found

    def of_controls(self, unknowns: FloatArray) -> FloatArray:
        """(n_controls, 2) changes of the control points, of changes of the unknowns."""
        controls = unknowns.reshape(-1, 2).copy()
        for end, sign in ((self.controls_of_path[:-1], 1), (self.controls_of_path[1:] - 1, -1)):
            fifth = controls[end + sign * (DEGREE - 1)]
            for k, ramp in enumerate(_RAMP):
                controls[end + sign * k] = ramp * fifth
        return controls

    def summed(self, per_cell: FloatArray) -> FloatArray:
        """(n_unknowns,) of (cells, 12)."""
        sums: FloatArray = np.bincount(self.unknowns.ravel(), per_cell.ravel(), self.n_unknowns).astype(np.float64)
        return sums

    def band(self, per_cell: FloatArray) -> FloatArray:
        """(12, n_unknowns) the lower band of the sum of (cells, 12, 12)."""
        band = np.zeros((_LOCAL, self.n_unknowns))
        for i in range(_LOCAL):
            for j in range(i + 1):
                band[i - j, self.unknowns[:, j]] += per_cell[:, i, j]
        return band

    def step(self, *of_slacks: tuple[FloatArray, FloatArray]) -> FloatArray:
        """(n_paths,) the share of a step that positive values (cells, n_bounds) survive, from pairs of values and their
        changes."""
        fastest = np.min([(change / value).min(axis=1) for value, change in of_slacks], axis=0)
        return np.minimum(1.0, _BOUNDARY / np.maximum(-np.minimum.reduceat(fastest, self.first_cell), 1e-9))


class _Iterate:
    """Control points, slacks of the bounds and their multipliers, above and below, and by how much a slack is more
    than there is."""

    def __init__(self, problem: _Problem, controls: FloatArray) -> None:
        self.problem, self.controls = problem, controls.copy()
        tube = problem.tube
        local = controls.reshape(-1)[problem.unknowns]
        off = (tube.rows @ local[..., None])[..., 0] - tube.centre
        room = np.stack((tube.above - off, tube.below + off))
        self.slack = np.maximum(room, _LEAST_SLACK * np.stack((tube.above, tube.below)))
        self.lacking = room - self.slack
        # The gradient of the price in terms of the unknowns: from all control points first, then from changes.
        self.gradient = local @ _PRICE
        cost = 0.5 * np.add.reduceat((self.gradient * local).sum(axis=1), problem.first_cell)
        for cells, from_unknowns in problem.ends:
            self.gradient[cells] = self.gradient[cells] @ from_unknowns
        self.step = np.ones(len(problem.n_bounds))
        mu = (_START * np.maximum(cost, 1e-12) / problem.n_bounds)[problem.path_of_cell]
        self.multiplier = mu[:, None] / self.slack

    def improved(self) -> bool:
        """Go one step of Newton's method, or say that there is no going on."""
        problem, slack, multiplier = self.problem, self.slack, self.multiplier
        gap = np.add.reduceat((slack * multiplier).sum(axis=(0, 2)), problem.first_cell) / problem.n_bounds
        mu = (np.clip(1.0 - self.step, _CENTRING, _MOST_CENTRING) * gap)[problem.path_of_cell][:, None]
        stiffness = multiplier / slack
        push = mu / slack - stiffness * self.lacking
        turned = problem.rows.transpose(0, 2, 1)
        matrix = (turned * (stiffness[0] + stiffness[1])[:, None]) @ problem.rows
        matrix += problem.price
        right = self.gradient + (turned @ (push[0] - push[1])[..., None])[..., 0]
        unknowns = _solved(problem.band(matrix), problem.summed(right))
        if unknowns is None:
            return False
        local = unknowns[problem.unknowns]
        moved = (problem.rows @ local[..., None])[..., 0]
        d_slack = self.lacking + np.stack((-moved, moved))
        d_multiplier = mu / slack - multiplier - stiffness * d_slack
        primal = problem.step((slack[0], d_slack[0]), (slack[1], d_slack[1]))
        dual = problem.step((multiplier[0], d_multiplier[0]), (multiplier[1], d_multiplier[1]))
        share = primal[problem.path_of_cell][:, None]
        self.step = np.minimum(primal, dual)
        self.controls += primal[problem.path_of_control][:, None] * problem.of_controls(unknowns)
        self.gradient = self.gradient + share * (problem.price @ local[..., None])[..., 0]
        self.slack = slack + share * d_slack
        self.lacking = self.lacking * (1.0 - share)
        self.multiplier = multiplier + dual[problem.path_of_cell][:, None] * d_multiplier
        return True


def _solved(band: FloatArray, right: FloatArray) -> FloatArray | None:
    """(n,) minus the solution of the symmetric system of that lower band, None where it is not positive definite. Rows
    of zeros are left out. The band is spent."""
    band[0, band[0] == 0.0] = 1.0
    scale = 1.0 / np.sqrt(band[0])  # control points differ by orders of magnitude between corners and straights
    band *= scale
    for k in range(1, len(band)):
        band[k, :-k] *= scale[k:]
    band[0] = 1.0 + _SHIFT
    factor, failed = dpbtrf(band, lower=1, overwrite_ab=1)
    if failed or not np.isfinite(right).all():
        return None
    solution: FloatArray = -scale * dpbtrs(factor, scale * right, lower=1)[0]
    return solution
