"""What a minimum-time motion along paths has to keep: joint velocity, acceleration, jerk and pen speed limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.kinematics.limits import Limits

FRACTIONS = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
"""Points of each cell at which velocity and jerk limits are imposed."""


@dataclass(frozen=True, eq=False, slots=True)
class TimingProblem:
    """Paths to be timed, laid end to end, each at rest at both ends (q' = q'' = 0 there).

    n_cells: (n_paths,); rate_limit: (5, total cells) cap on dsigma/dt at FRACTIONS of every cell; the others:
    (5, n_joints, total cells) derivatives of the joints by sigma at FRACTIONS of every cell, divided by the limit
    that the name says. Those by acceleration are of the joints alone that can reach that limit.
    """

    n_cells: IntArray
    rate_limit: FloatArray
    first_by_acceleration: FloatArray
    second_by_acceleration: FloatArray
    first_by_jerk: FloatArray
    second_by_jerk: FloatArray
    third_by_jerk: FloatArray

    @staticmethod
    def of(
        n_cells: IntArray,
        derivatives: tuple[FloatArray, FloatArray, FloatArray],
        limits: Limits,
        rate_limit: FloatArray,
    ) -> TimingProblem:
        """derivatives: q', q'', q''' (total cells, 5, n_joints) at FRACTIONS; rate_limit: (total cells, 5), the pen's
        own there, inf where it has none.

        A joint whose speed stays below V and whose jerk below J, from rest to rest, has an acceleration below
        sqrt(2 V J) (Hadamard 1914; Landau 1913): where that is within its limit the limit needs no word.
        """
        first, second, third = (np.ascontiguousarray(np.moveaxis(derivative, 0, 2)) for derivative in derivatives)
        velocity, acceleration, jerk = (limit[:, None] for limit in (limits.velocity, limits.acceleration, limits.jerk))
        with np.errstate(divide="ignore"):
            cap = np.minimum(rate_limit.T, 1.0 / np.abs(first / velocity).max(axis=1))
        inside = slice(1, -1)  # at its ends a path does not move, however fast sigma goes
        fastest = np.abs(first[inside] * cap[inside, None]).max(axis=(0, 2))
        reached = 2 * fastest * limits.jerk > limits.acceleration**2
        return TimingProblem(
            n_cells,
            cap,
            first[:, reached] / acceleration[reached],
            second[:, reached] / acceleration[reached],
            first / jerk,
            second / jerk,
            third / jerk,
        )

    def subset(self, paths: BoolArray) -> TimingProblem:
        """Only the paths of the mask (n_paths,)."""
        cells = np.repeat(paths, self.n_cells)
        return TimingProblem(
            self.n_cells[paths],
            self.rate_limit[:, cells],
            self.first_by_acceleration[..., cells],
            self.second_by_acceleration[..., cells],
            self.first_by_jerk[..., cells],
            self.second_by_jerk[..., cells],
            self.third_by_jerk[..., cells],
        )
