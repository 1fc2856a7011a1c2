"""A field of configurations made cheaper, node by node, as far as its branch lets it.

At each node the configuration that costs least with its neighbours is chosen among the present one, the one
in the middle of the neighbours, and steps along each internal motion; nodes take turns like the fields of a
chessboard, so that the cost of the whole never rises (iterated conditional modes, Besag 1986).
"""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.kinematics.projection import joint_scale, project
from planner.redundancy.configuration_tests import usable_configurations
from planner.redundancy.cost import ConfigurationCost
from planner.redundancy.paper_grid import PaperGrid
from planner.redundancy.plane_growth import Fields, longest_steps

_SHARES = (1.0, 0.3, 0.1, 0.03)
"""Of the time that the arm takes from node to node, that steps along internal motions take."""
_ROUNDS = 3
"""With each of them."""
_ITERATIONS = 6


def polished(cost: ConfigurationCost, grid: PaperGrid, fields: Fields) -> Fields:
    """One field, usable, as cheap as its nodes can make it."""
    if cost.kinematics.n_redundant == 0:
        return fields
    (field,), (known,) = fields.configurations.copy(), fields.known
    column, row = np.divmod(np.arange(grid.n_nodes), grid.shape[1])
    colours = [np.flatnonzero(known & ((column + row) % 2 == colour)) for colour in range(2)]
    for share in _SHARES:
        for _ in range(_ROUNDS):
            for nodes in colours:
                field[nodes] = _cheapest(cost, grid, field, known, nodes, share)
    return Fields(field[None], fields.known)


def field_cost(cost: ConfigurationCost, grid: PaperGrid, field: FloatArray, known: BoolArray) -> float:
    """The mean cost of a node of the field."""
    nodes = np.flatnonzero(known)
    return float(_costs(cost, grid, field, known, nodes, field[nodes][:, None])[:, 0].mean())


def _cheapest(
    cost: ConfigurationCost, grid: PaperGrid, field: FloatArray, known: BoolArray, nodes: IntArray, share: float
) -> FloatArray:
    kinematics = cost.kinematics
    own: FloatArray = field[nodes]
    scale = joint_scale(kinematics)
    _, jacobian = kinematics.task_and_jacobian(own)
    internal = np.linalg.svd(jacobian * scale)[2][:, kinematics.n_task :] * scale
    internal *= share * grid.spacing_mm / cost.quickness_mm_s
    _, near, near_known = grid.carried_on(field[None], known[None], np.zeros(len(nodes), dtype=np.int64), nodes)
    count = near_known.sum(axis=0)[:, None]
    mean = np.where(count > 0, (near * near_known[..., None]).sum(axis=0) / np.maximum(count, 1), own)
    tried = np.concatenate((mean[:, None], own[:, None] + internal, own[:, None] - internal), axis=1)
    n_tried = tried.shape[1]
    found, good = project(
        kinematics,
        tried.reshape(-1, tried.shape[2]),
        np.repeat(grid.tips_mm[nodes], n_tried, axis=0),
        iterations=_ITERATIONS,
    )
    good[good] = usable_configurations(kinematics, found[good])
    candidates = np.concatenate((own[:, None], found.reshape(tried.shape)), axis=1)
    costs = _costs(cost, grid, field, known, nodes, candidates)
    costs[:, 1:][~good.reshape(len(nodes), n_tried)] = np.inf
    costs[np.isnan(costs)] = np.inf
    chosen: FloatArray = np.take_along_axis(candidates, costs.argmin(axis=1)[:, None, None], axis=1)[:, 0]
    return chosen


def _costs(
    cost: ConfigurationCost,
    grid: PaperGrid,
    field: FloatArray,
    known: BoolArray,
    nodes: IntArray,
    candidates: FloatArray,
) -> FloatArray:
    """(n, n_candidates) of candidates (n, n_candidates, n_independent) at nodes (n,), with the steps to the
    neighbours; infinite where one is in another branch."""
    arm = cost.kinematics.arm
    shape = candidates.shape[:2]
    density, squares = cost.configurations(candidates.reshape(-1, candidates.shape[2]))
    costs = density.reshape(shape)
    squares = squares.reshape(*shape, arm.n_joints)
    padded, flags = np.pad(field, ((0, 1), (0, 0))), np.pad(known, (0, 1))
    longest = longest_steps(cost.kinematics, grid.spacing_mm)
    for beside in grid.neighbours[:, nodes]:
        steps = candidates - padded[beside][:, None]
        jumps = (np.abs(steps) > longest).any(axis=2)
        step_costs = cost.steps(steps @ arm.coupling_matrix[0].T, grid.spacing_mm, squares)
        costs = costs + np.where(flags[beside][:, None], np.where(jumps, np.inf, step_costs), 0.0)
    return costs
