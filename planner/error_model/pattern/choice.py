"""Which marks tell most: one after the other, the one that leaves tips least uncertain all over the paper.

Every mark is a measurement of three numbers with the Jacobian J by the parameters of the error model. With covariance
P before it and noise R, it takes `G P J^T (J P J^T + R)^-1 J P G^T` off the covariance of tips whose Jacobian is G:
the trace of that, summed over places all over the paper, in the configurations that drawings are drawn in, and both
sides of every joint's slack, is what a mark is worth
(integrated variance, or V-optimality). How joints come to a mark counts: they stand on the side of their slack from
which the mark before, and the stroke that ends in the mark, has brought them.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.chain import tips
from planner.error_model.pattern.candidates import Candidates

MARK_SD_MM = 0.15


def chosen_marks(
    arm: Arm,
    parameters: Parameters,
    pool: Candidates,
    drawn: FloatArray,
    count: int,
    random: np.random.Generator,
    accepts: Callable[[list[int], int], bool],
) -> list[int]:
    """Indices of `count` marks of the pool in the order that they are drawn in; fewer where no more are accepted.

    drawn: (n, n_joints) configurations of drawings, whose tips are to be told. accepts(chosen, next) says whether a
    mark can follow those that are chosen.
    """
    model = parameters.prior
    joints, begun = arm.complete(pool.free), arm.complete(pool.begun)
    jacobians, by_joint = _jacobians(parameters, joints)
    sides = random.choice((-1.0, 1.0), drawn.shape)
    goals = _on_sides(parameters, *_jacobians(parameters, drawn), sides).reshape(-1, jacobians.shape[2])
    covariance = np.diag(parameters.sd**2)
    standing = joints.mean(axis=0)
    chosen: list[int] = []
    banned = np.zeros(len(pool), dtype=np.bool_)
    while len(chosen) < count and not banned.all():
        came = _dragged(_dragged(standing, begun, model.slack), joints, model.slack)
        jacobians = _on_sides(parameters, jacobians, by_joint, (came - joints) / model.slack)
        worth = _worth(jacobians, covariance, goals)
        for index in np.argsort(-np.where(banned, -np.inf, worth)).tolist():
            if banned[index]:
                return chosen
            if accepts(chosen, index):
                break
            banned[index] = True
        else:
            return chosen
        chosen.append(index)
        banned[index] = True
        J = jacobians[index]
        gain = covariance @ J.T @ np.linalg.inv(J @ covariance @ J.T + MARK_SD_MM**2 * np.eye(3))
        covariance = covariance - gain @ J @ covariance
        standing = came[index]
    return chosen


def _dragged(standing: FloatArray, to: FloatArray, slack: FloatArray) -> FloatArray:
    """Where joints stand that were standing there and are told to go to `to`."""
    return np.minimum(np.maximum(standing, to - slack), to + slack)


def _jacobians(parameters: Parameters, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Of tips with joints (n, n_joints): by the parameters, slack apart, (n, 3, n_parameters) and by joints (n, 3,
    n_joints)."""
    return parameters.jacobian_at(joints), tips(parameters.prior.geometry, joints).by_joint


def _on_sides(parameters: Parameters, jacobians: FloatArray, by_joint: FloatArray, side: FloatArray) -> FloatArray:
    """The same Jacobians with joints on sides (n, n_joints) of their slack."""
    on_sides = jacobians.copy()
    on_sides[:, :, parameters.slack_entries] = by_joint * side[:, None, :]
    return on_sides


def _worth(jacobians: FloatArray, covariance: FloatArray, goals: FloatArray) -> FloatArray:
    """(n,) how much a measurement with each Jacobian (n, 3, p) takes off the summed variance of the goals (g, p)."""
    spread = covariance @ (goals.T @ goals) @ covariance
    turned = jacobians.transpose(0, 2, 1)
    scatter, gained = (jacobians @ matrix @ turned for matrix in (covariance, spread))
    inverse = np.linalg.inv(scatter + MARK_SD_MM**2 * np.eye(3))
    worth: FloatArray = np.einsum("nij,nji->n", inverse, gained)
    return worth
