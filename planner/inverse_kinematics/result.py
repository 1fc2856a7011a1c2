"""What every inverse-kinematics method returns."""

from __future__ import annotations

from dataclasses import dataclass

from planner.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False, slots=True)
class Solutions:
    """Configurations for a sequence of targets.

    configurations: (n, n_independent) independent joints, rad or mm; converged: (n,) whether the method met its
    tolerance;
    iterations: (n,) how many it took; error_mm: (n,) distance of the tip from its target.
    """

    configurations: FloatArray
    converged: BoolArray
    iterations: IntArray
    error_mm: FloatArray
