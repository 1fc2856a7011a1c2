"""Least times by sequential linear programming with HiGHS, for small paths: an oracle for the planner's timing.

Unknown are b = (dsigma/dt)^2 and its slope at the ends of fine cells with b'' constant in each. Divided by sqrt(b), a
jerk limit is linear but for its right-hand side J / sqrt(b), which is convex: its tangent lies below, so every
solution of a linear program keeps the true limit, and the time falls from one to the next.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_array, diags_array, eye_array, hstack, vstack

from planner.arrays import FloatArray
from planner.kinematics.limits import Limits

Derivative = Callable[[FloatArray, int], FloatArray]
"""sigma (n,) and an order 1, 2 or 3 to derivatives (n, n_joints) of a joint path."""

_FRACTIONS = (0.0, 0.5, 1.0)
_SIMPSON = (1 / 6, 4 / 6, 1 / 6)
_MOST_ROUNDS = 120
_CONVERGED = 2e-5


def least_time_s(
    derivative: Derivative, n_cells: int, limits: Limits, cap: Callable[[FloatArray], FloatArray], finer: int = 2
) -> float:
    """The least time from sigma = 0 to n_cells that is found from a constant rate, limits kept at both ends and in
    the middle of every fine cell. cap: sigma (n,) to the largest dsigma/dt (n,) of its own."""
    step = 1.0 / finer
    nodes = np.arange(n_cells * finer + 1) * step
    count = len(nodes)
    with np.errstate(divide="ignore"):
        by_speed = 1.0 / np.abs(derivative(nodes, 1) / limits.velocity).max(axis=1)
    ceiling = np.minimum(cap(nodes), by_speed) ** 2
    left, right = eye_array(count - 1, count, format="csr"), eye_array(count - 1, count, k=1, format="csr")
    none = csr_array((count - 1, count))
    bend = (right - left) / step
    points, accelerations, jerks, room = [], [], [], []
    for fraction in _FRACTIONS:
        sigma = nodes[:-1] + fraction * step
        slope_at = hstack((none, left + fraction * step * bend))
        at = hstack((left, fraction * step * left + 0.5 * (fraction * step) ** 2 * bend))
        points.append(at)
        q1, q2, q3 = (derivative(sigma, order).T for order in (1, 2, 3))
        for joint in range(len(limits.jerk)):
            a, j = limits.acceleration[joint], limits.jerk[joint]
            accelerations.append(diags_array(q2[joint] / a) @ at + diags_array(0.5 * q1[joint] / a) @ slope_at)
            jerks.append(
                diags_array(q3[joint] / j) @ at
                + diags_array(1.5 * q2[joint] / j) @ slope_at
                + diags_array(0.5 * q1[joint] / j) @ hstack((none, bend))
            )
            room.append(at)
    continuity = hstack((right - left, -0.5 * step * (left + right)))
    acceleration, jerk, room_at = vstack(accelerations), vstack(jerks), vstack(room)
    start = 0.5 * _steady_b(derivative, nodes, limits, ceiling)
    x = np.concatenate((np.full(count, start), np.zeros(count)))
    trust, time = 1.0, _time_s(points, x, step)
    for _ in range(_MOST_ROUNDS):
        # 1 / sqrt(b) by its tangent at the b in hand: in the jerk limits from below, in the time as the objective.
        objective = np.zeros(2 * count)
        for at, weight in zip(points, _SIMPSON, strict=True):
            objective += at.T @ (-0.5 * step * weight * (at @ x) ** -1.5)
        b = room_at @ x
        tangent = diags_array(0.5 * b**-1.5) @ room_at
        largest = 1.5 / np.sqrt(b)
        lower = np.concatenate((np.maximum(x[:count] / (1 + trust), 1e-9 * start), np.full(count, -np.inf)))
        upper = np.concatenate((np.minimum(x[:count] * (1 + trust), ceiling), np.full(count, np.inf)))
        unit = np.concatenate((x[:count], np.full(count, start)))  # variables of about one
        scale = diags_array(unit)
        solution = linprog(
            objective * unit,
            A_ub=vstack((acceleration, -acceleration, jerk + tangent, tangent - jerk)) @ scale,
            b_ub=np.concatenate((np.ones(2 * acceleration.shape[0]), largest, largest)),
            A_eq=continuity @ scale,
            b_eq=np.zeros(count - 1),
            bounds=np.column_stack((lower / unit, upper / unit)),
            method="highs",
        )
        if solution.status != 0:
            raise ArithmeticError(f"HiGHS: {solution.message}")
        found = solution.x * unit
        faster = _time_s(points, found, step)
        if faster < time:
            gained, x, time = time - faster, found, faster
            trust = min(1.5 * trust, 2.0)
            if gained < _CONVERGED * time:
                break
        else:
            trust *= 0.3
            if trust < 1e-3:
                break
    return time


def _time_s(points: list[csr_array], x: FloatArray, step: float) -> float:
    values = [at @ x for at in points]
    if min(value.min() for value in values) <= 0:
        return float("inf")
    return float(
        sum(step * weight * (1 / np.sqrt(value)).sum() for value, weight in zip(values, _SIMPSON, strict=True))
    )


def _steady_b(derivative: Derivative, nodes: FloatArray, limits: Limits, ceiling: FloatArray) -> float:
    """The largest constant b within all limits."""
    sigma = np.linspace(nodes[0], nodes[-1], 4 * len(nodes))
    by_acceleration = (limits.acceleration / np.maximum(np.abs(derivative(sigma, 2)), 1e-12)).min()
    by_jerk = (limits.jerk / np.maximum(np.abs(derivative(sigma, 3)), 1e-12)).min() ** (2 / 3)
    return float(min(by_acceleration, by_jerk, ceiling.min()))
