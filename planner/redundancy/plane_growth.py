"""Fields of configurations that grow over the paper from single ones, each in its branch as far as that goes.

At the edge of a field, the straight lines on from its configurations are projected onto the next nodes; what is usable
there and near enough joins it. Many fields grow at once, so that the one that comes furthest can be chosen.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import Pins, project, turning_joints
from planner.redundancy.configuration_tests import LIMIT_MARGIN, usable_configurations
from planner.redundancy.paper_grid import PaperGrid
from planner.redundancy.paper_samples import outside_of_base

_ITERATIONS = 12
_TO_MIDDLE = np.array([0.03, 0.3])
"""Of the way to the middle of their ranges joints go from node to node, as far as the pen lets them, in every other
field: so it does not run into limits that spare joints could have kept away from."""
_HELD = 1.25 * LIMIT_MARGIN
"""Share of its range that a joint is held from its limits."""
_LONGEST_TURN_RAD, _LONGEST_SLIDE = 0.8, 4.0
"""Between neighbouring nodes: a joint that turns by more, or slides by more times their distance, is in another
branch."""


@dataclass(frozen=True, eq=False, slots=True)
class Fields:
    """Configurations (n_fields, n_nodes, n_independent) on a grid, and where each field has one, (n_fields,
    n_nodes)."""

    configurations: FloatArray
    known: BoolArray


def longest_steps(kinematics: Kinematics, spacing_mm: float) -> FloatArray:
    """(n_independent,) rad or mm that joints may differ by at neighbouring nodes."""
    return np.where(turning_joints(kinematics), _LONGEST_TURN_RAD, _LONGEST_SLIDE * spacing_mm)


def seeded(grid: PaperGrid, nodes: IntArray, seeds: FloatArray) -> Fields:
    """Fields of one configuration each, (n_fields, n_independent) at nodes (n_fields,)."""
    rows = np.arange(len(seeds))
    configurations = np.zeros((len(seeds), grid.n_nodes, seeds.shape[1]))
    known = np.zeros((len(seeds), grid.n_nodes), dtype=np.bool_)
    configurations[rows, nodes], known[rows, nodes] = seeds, True
    return Fields(configurations, known)


def grown(kinematics: Kinematics, grid: PaperGrid, fields: Fields) -> Fields:
    """The fields, all usable, as far as they grow."""
    arm = kinematics.arm
    middle = kinematics.independent_of((arm.minimum + arm.maximum) / 2)
    longest = longest_steps(kinematics, grid.spacing_mm)
    may_be = outside_of_base(kinematics, grid.tips_mm)
    configurations, known = fields.configurations.copy(), fields.known.copy()
    tried_beside = np.zeros(known.shape, dtype=np.int64)
    while True:
        beside = np.pad(known, ((0, 0), (0, 1)))[:, grid.neighbours].sum(axis=1)
        row, node = np.nonzero(~known & may_be & (beside > tried_beside))
        if not len(row):
            return Fields(configurations, known)
        tried_beside[row, node] = beside[row, node]  # once more only where there is one more to come from
        mean, near, near_known = grid.carried_on(configurations, known, row, node)
        reference = mean + _TO_MIDDLE[row % len(_TO_MIDDLE), None] * (middle - mean)
        found, good = _projected(kinematics, reference, grid.tips_mm[node])
        good &= ((np.abs(found - near) <= longest) | ~near_known[..., None]).all(axis=(0, 2))
        good[good] = usable_configurations(kinematics, found[good])
        configurations[row[good], node[good]] = found[good]
        known[row[good], node[good]] = True


def _projected(kinematics: Kinematics, reference: FloatArray, tips_mm: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Configurations (n, n_independent) at tips (n, 3) near the references, and which are exact: where one would have
    a joint beyond its limits that others can spare, the joint that is furthest beyond is held within."""
    found, exact = project(kinematics, reference, tips_mm, iterations=_ITERATIONS)
    if kinematics.n_redundant == 0:
        return found, exact
    arm = kinematics.arm
    matrix, constant = arm.coupling_matrix
    ranges = arm.maximum - arm.minimum
    joints = arm.complete(found)
    within = np.clip(joints, arm.minimum + _HELD * ranges, arm.maximum - _HELD * ranges)
    beyond = np.abs(joints - within) / ranges
    rows = np.flatnonzero(exact & (beyond.max(axis=1) > 0.0))
    joint = beyond[rows].argmax(axis=1)
    pins = Pins(matrix[joint], within[rows, joint] - constant[joint])
    held, met = project(kinematics, reference[rows], tips_mm[rows], iterations=_ITERATIONS, pins=pins)
    found[rows[met]] = held[met]
    return found, exact
