"""What every inverse-kinematics method returns."""

from __future__ import annotations

from dataclasses import dataclass

from planner.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False, slots=True)
class Solutions:
    """Postures for a sequence of targets.

    postures: (n, n_free) free joints, rad or mm; converged: (n,) whether the method met its tolerance;
    iterations: (n,) how many it took; error_mm: (n,) distance of the tip from its target.
    """

    postures: FloatArray
    converged: BoolArray
    iterations: IntArray
    error_mm: FloatArray
