"""The configuration path is near the cheapest there is, and rounding its corners costs little."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.kinematics.projection import Pins, project
from planner.redundancy.configuration_tests import usable_configurations
from planner.redundancy.cost import ConfigurationCost
from planner.redundancy.ring_map import (
    choice_of_configurations,
    sharp_configuration_path,
)
from planner.redundancy.samples import on_ray
from planner.settings import ConfigurationWeights
from tests.arms.chains import load_once, model_of
from tests.redundancy.path_cost import configuration_path_cost

_VALUES = 120
_GUESSES = 1


def cheapest_of_a_grid(cost: ConfigurationCost, radii_mm: FloatArray, near: FloatArray) -> float:
    """The cost of the best way through a grid: at each radius every usable configuration of the branch in which one
    joint has one of many values."""
    arm = cost.kinematics.arm
    matrix, constant = arm.coupling_matrix
    joint = arm.independent_joints[1]
    values = np.linspace(arm.minimum[joint], arm.maximum[joint], _VALUES)
    before, totals = np.empty((0, arm.n_joints)), np.empty(0)
    shares = np.gradient(radii_mm)
    shares[[0, -1]] /= 2
    for index, radius in enumerate(radii_mm.tolist()):
        guesses = near[np.clip(index + np.arange(-_GUESSES, _GUESSES + 1) * 5, 0, len(near) - 1)]
        start = np.repeat(guesses, _VALUES, axis=0)
        found, exact = project(
            cost.kinematics,
            start,
            on_ray(np.full(len(start), radius)),
            iterations=30,
            pins=Pins(
                np.repeat(matrix[joint][None], len(start), axis=0), np.tile(values, len(guesses)) - constant[joint]
            ),
        )
        found = np.concatenate((found[exact], near[index : index + 1]))  # and the planner's own choice
        found = found[usable_configurations(cost.kinematics, found)]
        found = np.unique(np.round(found, 9), axis=0)
        joints = arm.complete(found)
        density, squares = cost.configurations(found)
        own = density * shares[index]
        if len(before):
            length = float(radii_mm[index] - radii_mm[index - 1])
            own += (totals + cost.steps(joints[:, None] - before[None], length, squares[:, None]) * length).min(axis=1)
        before, totals = joints, own
    return float(totals.min() / (radii_mm[-1] - radii_mm[0]))


def test_no_way_through_a_grid_is_much_cheaper() -> None:
    model, weights = model_of(load_once("drawing_arm")), ConfigurationWeights()
    cost, radii, samples = choice_of_configurations(model.kinematics, weights)
    nodes, sharp = sharp_configuration_path(cost, radii, samples)
    ours = configuration_path_cost(cost, nodes, sharp)
    assert ours <= 1.005 * cheapest_of_a_grid(cost, nodes, sharp)
    rounded = configuration_path_cost(cost, nodes, model.configuration_map(weights).configurations)
    assert rounded <= 1.02 * ours
