"""TOPP-RA's least time of a joint path without jerk limits: a bound from below (Pham and Pham 2018)."""

from __future__ import annotations

import logging

import numpy as np

from benchmarks.targets.strokes import SinglePath
from planner.arrays import FloatArray

_NEAR_REST = 0.5
"""The bound begins and ends at rest so many cells inside: at the ends themselves every rate of sigma is rest, because
sigma passes them as the cube root of the way. It leaves out a few micrometres of the way, and so stays a bound."""
_GROWTH = 1.15
_FASTEST = 1e3
"""Cap on the rate in units of the planner's mean rate, where there is none."""


def bound_s(path: SinglePath) -> float:
    """Least time within velocity and acceleration limits and the cap on the rate, from rest to rest; NaN if none."""
    import toppra

    logging.getLogger("toppra").setLevel(logging.ERROR)
    n_joints = len(path.limits.velocity)
    rate = path.n_cells / path.time_s  # sigma in units of the mean rate: the solver fails on badly scaled paths

    class AndParameter(toppra.interpolator.AbstractGeometricPath):
        """The joints over sigma / rate and, as one joint more, that itself: its speed limit is the cap on the rate."""

        def __call__(self, parameter: FloatArray, order: int = 0) -> FloatArray:
            at = np.atleast_1d(np.asarray(parameter, dtype=np.float64))
            own = at if order == 0 else np.full(len(at), 1.0 if order == 1 else 0.0)
            values = np.column_stack((path.derivative(at * rate, order) * rate**order, own))
            return values[0] if np.ndim(parameter) == 0 else values

        @property
        def dof(self) -> int:
            return n_joints + 1

        @property
        def path_interval(self) -> FloatArray:
            return np.array([grid[0], grid[-1]])

    grid = _grid(path.n_cells) / rate

    def speeds(parameter: float) -> FloatArray:
        cap = float(path.cap_at(np.array([parameter * rate]))[0]) / rate
        most = np.append(path.limits.velocity, min(cap, _FASTEST))
        return np.column_stack((-most, most))

    most = np.append(path.limits.acceleration, 1e8)
    instance = toppra.algorithm.TOPPRA(
        [
            toppra.constraint.JointVelocityConstraintVarying(speeds),
            toppra.constraint.JointAccelerationConstraint(np.column_stack((-most, most))),
        ],
        AndParameter(),
        gridpoints=grid,
        solver_wrapper="seidel",
    )
    _, speed, _ = instance.compute_parameterization(0.0, 0.0)
    if speed is None:
        return float("nan")
    return float((2 * np.diff(grid) / (speed[1:] + speed[:-1])).sum())


def _grid(n_cells: int) -> FloatArray:
    """Cell ends, finer towards both ends of the path."""
    ramp = _NEAR_REST * _GROWTH ** np.arange(100)
    ramp = ramp[ramp < 4.0]
    return np.concatenate((ramp, np.arange(4.0, n_cells - 3.5), n_cells - ramp[::-1]))
