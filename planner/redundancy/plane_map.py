"""The configuration map of an arm that does not turn over its paper: a configuration for each place of a grid.

Slides, lifts at the base, arms on a wall or before a board: no place of the paper is like another. So
configurations are chosen all over a grid of the paper. Fields grow over it from usable configurations, the one that
comes furthest is made cheaper, and a cubic B-spline over its nodes carries it to the places between. That rounds a
little, as a reference may: configurations are projected onto their targets from there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.errors import PlanError
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import within_limits
from planner.kinematics.projection import project
from planner.redundancy.configuration_tests import slowest_direction_mm_s, usable_configurations
from planner.redundancy.cost import ConfigurationCost
from planner.redundancy.paper_grid import PaperGrid
from planner.redundancy.paper_samples import grid_around, on_paper, outside_of_base, starts_for_paper, usable_on_paper
from planner.redundancy.plane_growth import Fields, grown, longest_steps, seeded
from planner.redundancy.plane_polish import field_cost, polished
from planner.redundancy.refusal import no_usable_configuration
from planner.redundancy.requirements import require_drawing_arm
from planner.settings import ConfigurationWeights
from planner.spline import weights as spline_weights

_DEGREE = 3
_SEEDS = 16
_TIMES_POLISHED = 2
_FEWEST_SHARE = 0.08
"""Of the nodes of the first branch that a further one has to add."""
_MOST_BRANCHES = 4
_ALONE = 0.01
"""What a node at the edge of a field is worth."""
_AS_FAR = 0.97
"""Fields that come so far beside the one that comes furthest are as good, and the cheapest of them is taken."""


@dataclass(frozen=True, eq=False)
class PlaneMap:
    """Configurations (n_nodes, n_independent) at the nodes of a grid of the paper, and where there is one, (n_nodes,);
    elsewhere they are carried on."""

    kinematics: Kinematics
    grid: PaperGrid
    configurations: FloatArray
    known: BoolArray

    @property
    def arm(self) -> Arm:
        return self.kinematics.arm

    @property
    def home(self) -> FloatArray:
        """(n_independent,) the configuration nearest to the middle of the map."""
        nodes = self.grid.tips_mm[self.known]
        nearest = np.linalg.norm(nodes - nodes.mean(axis=0), axis=1).argmin()
        home: FloatArray = self.configurations[self.known][nearest]
        return home

    @property
    def box_mm(self) -> FloatArray:
        """(2, 2) corners that all of what the map reaches lies between."""
        nodes = self.grid.tips_mm[self.known, :2]
        return np.stack((nodes.min(axis=0) - self.grid.spacing_mm, nodes.max(axis=0) + self.grid.spacing_mm))

    @property
    def arrays(self) -> dict[str, FloatArray]:
        """What `of` makes the same map of."""
        return {
            "origin_mm": self.grid.origin_mm,
            "layout": np.array([self.grid.spacing_mm, *self.grid.shape]),
            "configurations": self.configurations,
            "known": self.known.astype(np.float64),
        }

    @staticmethod
    def of(kinematics: Kinematics, arrays: Mapping[str, FloatArray]) -> PlaneMap:
        spacing_mm, columns, rows = arrays["layout"].tolist()
        grid = PaperGrid(arrays["origin_mm"], spacing_mm, (int(columns), int(rows)))
        return PlaneMap(kinematics, grid, arrays["configurations"], arrays["known"] > 0)

    def reference(self, tip_mm: FloatArray) -> FloatArray:
        """(n, n_independent) the map's configurations at tips (n, 3), whatever their height; outside of the map, those
        that it is carried on by."""
        cell, fraction = self._cells(tip_mm)
        along, across = spline_weights(_DEGREE, fraction[:, 0]), spline_weights(_DEGREE, fraction[:, 1])
        reference = np.zeros((len(tip_mm), self.configurations.shape[1]))
        for i in range(_DEGREE + 1):
            for j in range(_DEGREE + 1):
                controls = self._controls[cell[:, 0] + i, cell[:, 1] + j]
                reference += (along[:, i] * across[:, j])[:, None] * controls
        return reference

    def configurations_at(self, tip_mm: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Exact configurations (n, n_independent) at tips (n, 3), and where they exist within the joint limits."""
        configurations, exact = project(self.kinematics, self.reference(tip_mm), tip_mm)
        return configurations, exact & within_limits(self.arm, self.arm.complete(configurations))

    def reaches(self, points_mm: FloatArray) -> BoolArray:
        """(n,) whether points of the paper (n, 2) lie within the map and the joint limits."""
        tips_mm = np.column_stack((points_mm, np.zeros(len(points_mm))))
        cell, fraction = self._cells(tips_mm)
        of_branch, whole = (cells[cell[:, 0], cell[:, 1]] for cells in self._sound)
        off_mm = np.abs(tips_mm[:, :2] - self.grid.origin_mm - (cell + fraction) * self.grid.spacing_mm).max(axis=1)
        reached: BoolArray = of_branch & (off_mm < 1e-6) & outside_of_base(self.kinematics, tips_mm)
        rows = np.flatnonzero(reached)
        configurations, good = self.configurations_at(tips_mm[rows])
        edge = np.flatnonzero(good & ~whole[rows])
        near = np.abs(configurations[edge] - self.reference(tips_mm[rows[edge]])) <= self._longest
        good[edge] = near.all(axis=1) & usable_configurations(self.kinematics, configurations[edge])
        reached[rows] = good
        return reached

    @cached_property
    def _controls(self) -> FloatArray:
        """(columns + 2, rows + 2, n_independent): one more all around, for the cells at the edge."""
        return np.pad(self.configurations.reshape(*self.grid.shape, -1), ((1, 1), (1, 1), (0, 0)), mode="edge")

    @cached_property
    def _longest(self) -> FloatArray:
        return longest_steps(self.kinematics, self.grid.spacing_mm)

    @cached_property
    def _sound(self) -> tuple[BoolArray, BoolArray]:
        """(columns - 1, rows - 1) cells with a corner that is known and all controls in one branch, and those of them
        with all corners known."""
        known = self.known.reshape(self.grid.shape)
        corners = np.stack([known[:-1, :-1], known[1:, :-1], known[:-1, 1:], known[1:, 1:]])
        columns, rows = known.shape[0] - 1, known.shape[1] - 1
        torn = np.zeros((columns, rows), dtype=np.bool_)
        for axis, beyond in enumerate(((_DEGREE, _DEGREE + 1), (_DEGREE + 1, _DEGREE))):
            jumps: BoolArray = np.any(np.abs(np.diff(self._controls, axis=axis)) > self._longest, axis=2)
            for i, j in np.ndindex(beyond):
                torn |= jumps[i : i + columns, j : j + rows]
        return corners.any(axis=0) & ~torn, corners.all(axis=0) & ~torn

    def _cells(self, tip_mm: FloatArray) -> tuple[IntArray, FloatArray]:
        """(n, 2) the cells that tips lie in, and where in them, from 0 to 1; beyond the grid, the nearest place in
        it."""
        last = np.array(self.grid.shape) - 1
        at = np.clip((tip_mm[:, :2] - self.grid.origin_mm) / self.grid.spacing_mm, 0, last)
        cell = np.minimum(at.astype(np.int64), last - 1)
        return cell, at - cell


def plane_branches(kinematics: Kinematics, weights: ConfigurationWeights) -> tuple[PlaneMap, ...]:
    """The map that reaches over most of the paper, then maps in other branches, each over as much as it can of what
    the ones before leave out. This takes a while: `ArmModel` keeps them. Errors: PlanError where the arm cannot have
    one, ArmFileError where its file contradicts itself."""
    require_drawing_arm(kinematics)
    pool = usable_on_paper(kinematics, on_paper(kinematics, starts_for_paper(kinematics)))
    if not len(pool):
        raise no_usable_configuration(kinematics)
    grid = grid_around(kinematics.tip_mm(pool))
    nodes, pool = _onto_nodes(kinematics, grid, pool)
    if not len(pool):
        raise PlanError(
            f"arm {kinematics.arm.name}: the pen gets to a few places of the paper alone; widen the joint limits, or"
            " lower workspace.inner_radius_mm"
        )
    quickness = float(np.median(slowest_direction_mm_s(kinematics, pool)))
    reach_mm = float(np.ptp(grid.tips_mm[:, :2], axis=0).max()) / 2
    cost = ConfigurationCost(kinematics, weights, quickness, reach_mm)
    seeds = np.repeat(_unlike(pool / longest_steps(kinematics, grid.spacing_mm), _SEEDS), 2)
    fields = grown(kinematics, grid, seeded(grid, nodes[seeds], pool[seeds]))
    # A field with holes is worth less than its nodes: a node counts where all around it are known too.
    worth = grid.amid(fields.known) + _ALONE * fields.known
    branches: list[PlaneMap] = []
    left_out, most = np.ones(grid.n_nodes, dtype=np.bool_), 0.0
    while len(branches) < _MOST_BRANCHES:
        adds = (worth * left_out).sum(axis=1)
        if adds.max() < _FEWEST_SHARE * most:
            break
        most = most or float(adds.max())
        best = _best(cost, grid, fields, np.flatnonzero(adds >= _AS_FAR * adds.max()))
        for _ in range(_TIMES_POLISHED):  # a cheaper field may go on where the one that was grown did not
            best = polished(cost, grid, grown(kinematics, grid, best))
        configurations, known = best.configurations[0], best.known[0]
        branches.append(PlaneMap(kinematics, grid, grid.filled(configurations, known), known))
        left_out &= ~known
    return tuple(branches)


def _onto_nodes(kinematics: Kinematics, grid: PaperGrid, pool: FloatArray) -> tuple[IntArray, FloatArray]:
    """Usable configurations (n, n_independent) carried to the nodes (n,) that are nearest to them."""
    nodes = grid.nearest(kinematics.tip_mm(pool))
    found, good = project(kinematics, pool, grid.tips_mm[nodes])
    good &= outside_of_base(kinematics, grid.tips_mm[nodes])
    good[good] = usable_configurations(kinematics, found[good])
    return nodes[good], found[good]


def _unlike(points: FloatArray, count: int) -> IntArray:
    """Up to so many of points (n, k), the first amid all and each next one as far as can be from those before."""
    chosen = [int(np.linalg.norm(points - np.median(points, axis=0), axis=1).argmin())]
    away = np.full(len(points), np.inf)
    while len(chosen) < min(count, len(points)):
        away = np.minimum(away, np.linalg.norm(points - points[chosen[-1]], axis=1))
        chosen.append(int(away.argmax()))
    return np.array(chosen)


def _best(cost: ConfigurationCost, grid: PaperGrid, fields: Fields, rows: IntArray) -> Fields:
    """The cheapest of these fields, by itself."""
    costs = [field_cost(cost, grid, fields.configurations[row], fields.known[row]) for row in rows.tolist()]
    row = rows[[int(np.argmin(costs))]]
    return Fields(fields.configurations[row], fields.known[row])
