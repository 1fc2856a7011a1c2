"""What a configuration path costs, as one figure to compare it by."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.redundancy.cost import ConfigurationCost


def configuration_path_cost(cost: ConfigurationCost, along_mm: FloatArray, configuration_path: FloatArray) -> float:
    """The cost of a configuration path: the mean of its densities over the way."""
    lengths = np.diff(along_mm)
    own, squares = cost.configurations(configuration_path)
    steps = np.diff(cost.kinematics.arm.complete(configuration_path), axis=0)
    total = 0.5 * (own[1:] + own[:-1]) @ lengths + sum(
        float(cost.steps(step, length, to)) * length
        for step, length, to in zip(steps, lengths.tolist(), squares[1:], strict=True)
    )
    return float(total / lengths.sum())
