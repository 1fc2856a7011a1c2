"""How good the choice of configurations is: against dense searches, along the radius and along single strokes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.targets.configurations import reversals
from benchmarks.targets.row import Row
from benchmarks.targets.strokes import length_mm, lines, placed_strokes
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.errors import PlanError
from planner.kinematics.projection import Pins, project
from planner.redundancy.arm_model import ArmModel
from planner.redundancy.configuration_path import (
    cheapest_configuration_path,
    polished_configuration_path,
)
from planner.redundancy.configuration_tests import usable_configurations
from planner.redundancy.cost import ConfigurationCost
from planner.redundancy.ring_map import (
    RingMap,
    choice_of_configurations,
    sharp_configuration_path,
)
from planner.redundancy.samples import on_ray
from planner.settings import PlanSettings
from tests.redundancy.path_cost import configuration_path_cost

_STROKES, _LONGER_THAN_MM = 20, 12.0
_STATION_MM = 1.0
_SPACING_DEG = 1.0
_REFERENCES = 3


@dataclass(frozen=True, slots=True)
class Design:
    """Mean cost of a millimetre, and how the joints fare, of the strokes together."""

    cost: float
    sideways_mm_rad: float
    reversals: int


def against_brute_force(drawing: Path, settings: PlanSettings) -> list[Row]:
    """The map's configuration path against a dense search over all configurations of the ray; and, the price of the
    same configuration at the same place, the map along short strokes against a dense search for each of them."""
    arm = load_arm(settings.arm)
    model, weights = ArmModel(arm, cache=False), settings.weights or arm.weights
    cost, radii, samples = choice_of_configurations(model.kinematics, weights)
    nodes, sharp = sharp_configuration_path(cost, radii, samples)
    configuration_map = model.configuration_map(weights)
    pool = np.concatenate(samples)
    dense = best_of_dense(cost, nodes, on_ray(nodes), pool)
    ours, rounded, brute = (
        configuration_path_cost(cost, nodes, configuration_path)
        for configuration_path in (sharp, configuration_map.configurations, dense)
    )
    rows = [
        Row(
            "redundancy optimum, the configuration map against a dense search over all configurations of the ray",
            "within 0.5 %",
            f"cost {ours:.3f} against {brute:.3f}: {ours / brute - 1:+.2%}"
            f" ({rounded / brute - 1:+.2%} once its corners are rounded)",
            ours <= 1.005 * brute,
        )
    ]
    strokes = sorted(lines(placed_strokes(drawing, arm, settings), _LONGER_THAN_MM), key=length_mm)[:_STROKES]
    designs = per_stroke_designs(cost, configuration_map, pool, strokes)
    base = designs["map"]
    told = "; ".join(
        f"{name}: cost {one.cost / base.cost - 1:+.1%}, sensitivity"
        f" {one.sideways_mm_rad / base.sideways_mm_rad - 1:+.1%}, reversals {one.reversals}"
        for name, one in designs.items()
        if name != "map"
    )
    rows.append(
        Row(
            f"configurations chosen for each of {len(strokes)} short strokes by itself, against the map",
            "report: the price of the same configuration at the same place",
            f"map: cost {base.cost:.3f}, reversals {base.reversals}; {told}",
        )
    )
    return rows


def per_stroke_designs(
    cost: ConfigurationCost, configuration_map: RingMap, pool: FloatArray, strokes: list[FloatArray]
) -> dict[str, Design]:
    """The same strokes by the map, by a dense search for each, and by the map polished for each."""
    configuration_paths: dict[str, list[tuple[FloatArray, FloatArray]]] = {"map": [], "per stroke": [], "both": []}
    for stroke in strokes:
        along, tips = stations(stroke)
        start, _ = project(cost.kinematics, configuration_map.reference(tips), tips)
        configuration_paths["map"].append((along, start))
        configuration_paths["per stroke"].append((along, best_of_dense(cost, along, tips, pool)))
        configuration_paths["both"].append((along, polished_configuration_path(cost, along, tips, start)))
    return {name: _design(cost, each) for name, each in configuration_paths.items()}


def stations(stroke: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(n,) ways along a polyline and (n, 3) its points there, evenly spaced."""
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))))
    along = np.linspace(0.0, way[-1], int(np.ceil(way[-1] / _STATION_MM)) + 1)
    x, y = (np.interp(along, way, column) for column in stroke.T)
    return along, np.column_stack((x, y, np.zeros(len(along))))


def best_of_dense(cost: ConfigurationCost, along_mm: FloatArray, tips_mm: FloatArray, pool: FloatArray) -> FloatArray:
    """(n, n_independent) the cheapest path through all usable configurations in which a joint is at a whole degree
    (or mm), found from several references at each tip; polished like ours, so that the grid costs nothing."""
    reached, configuration_path = cheapest_configuration_path(
        cost, along_mm, [_all_configurations(cost, tip, pool) for tip in tips_mm]
    )
    if len(reached) < len(along_mm):
        raise PlanError("the dense search found no path over the whole way")
    return polished_configuration_path(cost, along_mm, tips_mm, configuration_path)


def _all_configurations(cost: ConfigurationCost, tip_mm: FloatArray, pool: FloatArray) -> FloatArray:
    """(m, n_independent) usable configurations at one tip with one joint at each multiple of the spacing in turn."""
    kinematics, arm = cost.kinematics, cost.kinematics.arm
    matrix, constant = arm.coupling_matrix
    radius = float(np.hypot(*tip_mm[:2]))
    task, _ = kinematics.task_and_jacobian(pool)
    near = pool[np.argsort(np.abs(np.hypot(task[:, 0], task[:, 1]) - radius), kind="stable")[:60]].copy()
    near = near[np.linspace(0, len(near) - 1, _REFERENCES).astype(int)]
    near[:, 0] += np.arctan2(tip_mm[1], tip_mm[0])
    found = [np.empty((0, kinematics.n_independent))]
    for joint in range(1, arm.n_joints):
        spacing = _SPACING_DEG * arm.per_file_unit[joint]
        values = np.arange(np.ceil(arm.minimum[joint] / spacing), arm.maximum[joint] / spacing) * spacing
        start = np.repeat(near, len(values), axis=0)
        configurations, exact = project(
            kinematics,
            start,
            np.tile(tip_mm, (len(start), 1)),
            iterations=12,
            pins=Pins(np.tile(matrix[joint], (len(start), 1)), np.tile(values - constant[joint], len(near))),
        )
        configurations = configurations[exact]
        found.append(configurations[usable_configurations(kinematics, configurations)])
    _, first = np.unique(np.round(np.concatenate(found), 6), axis=0, return_index=True)
    return np.concatenate(found)[np.sort(first)]


def _design(cost: ConfigurationCost, configuration_paths: list[tuple[FloatArray, FloatArray]]) -> Design:
    arm = cost.kinematics.arm
    weights = np.array([along[-1] for along, _ in configuration_paths])
    costs = np.array(
        [configuration_path_cost(cost, along, configuration_path) for along, configuration_path in configuration_paths]
    )
    joints = [arm.complete(configuration_path) for _, configuration_path in configuration_paths]
    square = [
        float((cost.kinematics.jacobian(each)[:, :2] ** 2).sum(axis=(1, 2)).mean()) / arm.n_joints for each in joints
    ]
    return Design(
        float(weights @ costs / weights.sum()),
        float(np.sqrt(weights @ np.array(square) / weights.sum())),
        sum(reversals(each / arm.per_file_unit) for each in joints),
    )
