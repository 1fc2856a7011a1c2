"""What a configuration path costs, as one figure to compare it by."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.redundancy.cost import ConfigurationCost


def configuration_path_cost(cost: ConfigurationCost, along_mm: FloatArray, configuration_path: FloatArray) -> float:
    """The cost of a configuration path: the mean of its densities over the way."""
    lengths = np.diff(along_mm)
    own, steps = (
        cost.configurations(configuration_path),
        np.diff(cost.kinematics.arm.complete(configuration_path), axis=0),
    )
    total = 0.5 * (own[1:] + own[:-1]) @ lengths + sum(
        float(cost.steps(step, length)) * length for step, length in zip(steps, lengths.tolist(), strict=True)
    )
    return float(total / lengths.sum())
