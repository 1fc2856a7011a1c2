"""TOPP-RA's least time of a joint path without jerk limits (Pham and Pham 2018; package `toppra`): a bound from below,
and what its rivals with jerk limits begin with."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np

from benchmarks.targets.strokes import SinglePath
from planner.arrays import FloatArray

_NEAR_REST = 0.5
"""The bound begins and ends at rest so many cells inside: at the ends themselves every rate of sigma is rest, because
sigma passes them as the cube root of the way. It leaves out a few micrometres of the way, and so stays a bound."""
_GROWTH = 1.15
_FASTEST = 1e3
"""Cap on the rate in units of the usual rate, where there is none."""


@dataclass(frozen=True, eq=False, slots=True)
class Profile:
    """sigma at the ends of n cells, the rate dsigma/dt there, and when each is passed, (n + 1,) each; the rate's square
    is linear in each cell."""

    path: SinglePath
    sigma: FloatArray
    rate: FloatArray
    time_s: FloatArray

    @property
    def duration_s(self) -> float:
        return float(self.time_s[-1])

    def at(self, time_s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Joint positions, velocities and accelerations, (m, n_joints) each, at times (m,); at rest at the end."""
        cell = np.clip(np.searchsorted(self.time_s, time_s, side="right") - 1, 0, len(self.sigma) - 2)
        after = np.minimum(time_s, self.duration_s) - self.time_s[cell]
        bend = np.diff(self.rate**2) / (2 * np.diff(self.sigma))
        rate = np.maximum(self.rate[cell] + bend[cell] * after, 0.0)
        sigma = self.sigma[cell] + after * (self.rate[cell] + 0.5 * bend[cell] * after)
        q1, q2 = (self.path.derivative(sigma, order) for order in (1, 2))
        return (
            self.path.derivative(sigma, 0),
            q1 * rate[:, None],
            q2 * rate[:, None] ** 2 + q1 * bend[cell][:, None],
        )


def profile_of(path: SinglePath) -> Profile | None:
    """The quickest within velocity and acceleration limits and the cap on the rate, from rest to rest; None where the
    solver finds none."""
    import toppra

    logging.getLogger("toppra").setLevel(logging.ERROR)
    usual = path.n_cells / path.time_s  # the solver fails on badly scaled paths

    class Joints(toppra.interpolator.AbstractGeometricPath):
        def __call__(self, parameter: FloatArray, order: int = 0) -> FloatArray:
            at = np.atleast_1d(np.asarray(parameter, dtype=np.float64))
            values = path.derivative(at * usual, order) * usual**order
            return values[0] if np.ndim(parameter) == 0 else values

        @property
        def dof(self) -> int:
            return len(path.limits.velocity)

        @property
        def path_interval(self) -> FloatArray:
            return np.array([grid[0], grid[-1]])

    class Speeds(toppra.constraint.linear_constraint.LinearConstraint):
        """The joints' velocity limits and the cap on the rate, as bounds on its square."""

        def compute_constraint_params(self, curve: Joints, points: FloatArray) -> tuple[FloatArray | None, ...]:
            with np.errstate(divide="ignore"):
                joints = (path.limits.velocity / np.abs(curve(points, 1))).min(axis=1)
            most = np.minimum(np.minimum(joints, path.cap_at(points * usual) / usual), _FASTEST)
            return (*6 * [None], np.column_stack((np.zeros(len(points)), most**2)))

    grid = _grid(path.n_cells) / usual
    most = path.limits.acceleration
    speeds = Speeds()
    speeds.set_discretization_type(0)
    instance = toppra.algorithm.TOPPRA(
        [speeds, toppra.constraint.JointAccelerationConstraint(np.column_stack((-most, most)))],
        Joints(),
        gridpoints=grid,
        solver_wrapper="seidel",
    )
    _, speed, _ = instance.compute_parameterization(0.0, 0.0)
    if speed is None or not np.isfinite(speed).all():
        return None
    cells_s = 2 * np.diff(grid) / (speed[1:] + speed[:-1])
    return Profile(path, grid * usual, speed * usual, np.concatenate(([0.0], np.cumsum(cells_s))))


def _grid(n_cells: int) -> FloatArray:
    """Cell ends, finer towards both ends of the path."""
    ramp = _NEAR_REST * _GROWTH ** np.arange(100)
    ramp = ramp[ramp < 4.0]
    return np.concatenate((ramp, np.arange(4.0, n_cells - 3.5), n_cells - ramp[::-1]))
