"""The least time within velocity, acceleration and jerk limits by other means than the planner's: a nonlinear
program over finer cells, solved by Ipopt.

States are b = (dsigma/dt)^2 and its slope at the ends of `finer` cells for each of the planner's, with b'' constant in
each; all limits are imposed at both ends and in the middle of each.
"""

from __future__ import annotations

import casadi
import numpy as np

from benchmarks.targets.strokes import SinglePath
from planner.arrays import FloatArray


def least_time_s(path: SinglePath, finer: int = 4, start_share: float = 0.5) -> float:
    """The time of the optimum that is found from a constant rate of sigma, NaN where the solver gives up."""
    step = 1.0 / finer
    nodes = np.arange(path.n_cells * finer + 1) * step
    unit = start_share * _steady_rate(path) ** 2
    n_nodes = len(nodes)
    value, slope = casadi.SX.sym("b", n_nodes), casadi.SX.sym("s", n_nodes)
    bend = (slope[1:] - slope[:-1]) / step
    constraints = [(value[1:] - value[:-1] - 0.5 * step * (slope[1:] + slope[:-1])) * finer]
    lower, upper = [np.zeros(n_nodes - 1)], [np.zeros(n_nodes - 1)]
    inverse_roots = []
    for fraction in (0.0, 0.5, 1.0):
        sigma = nodes[:-1] + fraction * step
        q1, q2, q3 = (path.derivative(sigma, order) for order in (1, 2, 3))
        b = value[:-1] + fraction * step * slope[:-1] + 0.5 * (fraction * step) ** 2 * bend
        s = slope[:-1] + fraction * step * bend
        inverse_roots.append(1 / casadi.sqrt(b))
        for joint, (acceleration, jerk) in enumerate(zip(path.limits.acceleration, path.limits.jerk, strict=True)):
            of_acceleration = (q2[:, joint] * b + 0.5 * q1[:, joint] * s) * (unit / acceleration)
            of_jerk = (
                (q3[:, joint] * b + 1.5 * q2[:, joint] * s + 0.5 * q1[:, joint] * bend)
                * casadi.sqrt(b)
                * (unit**1.5 / jerk)
            )
            for constraint in (of_acceleration, of_jerk):
                constraints.append(constraint)
                lower.append(-np.ones(n_nodes - 1))
                upper.append(np.ones(n_nodes - 1))
    time = step / 6 * casadi.sum1(inverse_roots[0] + 4 * inverse_roots[1] + inverse_roots[2])
    solver = casadi.nlpsol(
        "least_time",
        "ipopt",
        {"x": casadi.vertcat(value, slope), "f": time, "g": casadi.vertcat(*constraints)},
        {
            "ipopt.print_level": 0,
            "ipopt.sb": "yes",
            "print_time": False,
            "ipopt.tol": 1e-6,
            "ipopt.max_iter": 400,
            "ipopt.mu_strategy": "adaptive",
        },
    )
    solution = solver(
        x0=np.concatenate((np.ones(n_nodes), np.zeros(n_nodes))),
        lbx=np.concatenate((np.full(n_nodes, 1e-6), np.full(n_nodes, -np.inf))),
        ubx=np.concatenate((rate_bound(path, nodes) ** 2 / unit, np.full(n_nodes, np.inf))),
        lbg=np.concatenate(lower),
        ubg=np.concatenate(upper),
    )
    return float(solution["f"]) / np.sqrt(unit) if solver.stats()["success"] else float("nan")


def rate_bound(path: SinglePath, sigma: FloatArray) -> FloatArray:
    """(n,) largest dsigma/dt by the cap and by the joints' speeds."""
    with np.errstate(divide="ignore"):
        by_speed = 1.0 / np.abs(path.derivative(sigma, 1) / path.limits.velocity).max(axis=1)
    return np.minimum(path.cap_at(sigma), by_speed)


def _steady_rate(path: SinglePath) -> float:
    """The largest constant dsigma/dt within all limits."""
    sigma = np.linspace(0.0, path.n_cells, 20 * path.n_cells + 1)
    rates = [
        float((limit / np.maximum(np.abs(path.derivative(sigma, order)), 1e-12)).min()) ** (1 / order)
        for order, limit in ((2, path.limits.acceleration), (3, path.limits.jerk))
    ]
    return min(*rates, float(rate_bound(path, sigma).min()))
