"""Which way the joints raise the pen soonest, where the arm has more of them than it needs."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.kinematics.chain import Kinematics

_ROUNDS = 30
_LEAST_WEIGHT = 1e-9


def quickest_lifts(kinematics: Kinematics, jerk: FloatArray, configurations: FloatArray) -> FloatArray:
    """(n, n_independent) motion of the independent joints per mm of height, straight up, at configurations (n,
    n_independent): the one whose largest `|dq_i| / jerk_i` over all joints, the mimic ones too, is smallest. Short
    lifts are ruled by jerk.

    A Chebyshev problem in the null space of the task, by Lawson's weights: least squares again and again, each joint's
    weight multiplied by its share of the remaining motion (Lawson, Contributions to the theory of linear least
    maximum approximation, 1961). After any number of rounds the pen rises as exactly: what they leave is time alone.
    """
    task, jacobian = kinematics.task_and_jacobian(configurations)
    up = np.zeros(task.shape[1])
    up[2] = 1.0
    lift: FloatArray = np.linalg.pinv(jacobian) @ up
    n_redundant = configurations.shape[1] - task.shape[1]
    if n_redundant <= 0:
        return lift
    null = np.linalg.svd(jacobian)[2][:, task.shape[1] :].transpose(0, 2, 1)
    matrix = kinematics.arm.coupling_matrix[0] / jerk[:, None]
    fixed, movable = lift @ matrix.T, matrix @ null
    weight = np.ones_like(fixed)
    chosen = np.zeros((len(configurations), n_redundant))
    for _ in range(_ROUNDS):
        weighted = movable * weight[:, :, None]
        gram = np.einsum("nji,njk->nik", weighted, movable)
        gram += 1e-12 * np.trace(gram, axis1=1, axis2=2)[:, None, None] * np.eye(n_redundant)
        chosen = -np.linalg.solve(gram, np.einsum("nji,nj->ni", weighted, fixed)[:, :, None])[:, :, 0]
        weight = weight * np.abs(fixed + np.einsum("nji,ni->nj", movable, chosen))
        weight = np.maximum(weight / weight.sum(axis=1, keepdims=True), _LEAST_WEIGHT)
    quickest: FloatArray = lift + np.einsum("nij,nj->ni", null, chosen)
    return quickest
