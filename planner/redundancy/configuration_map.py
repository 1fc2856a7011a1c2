"""The configuration map: one configuration for each place of the paper, chosen once for an arm.

The same place is then always drawn with the same configuration, whatever the drawing. Where the arm turns over its
paper, a distance from the base axis stands for all places around it (`ring_map`); any other arm has a map over the
paper's two coordinates (`plane_map`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.kinematics.chain import Kinematics


class ConfigurationMap(Protocol):
    """Configurations of one branch of an arm. Points and tips are in the paper's frame, mm."""

    @property
    def kinematics(self) -> Kinematics: ...

    @property
    def arm(self) -> Arm: ...

    @property
    def home(self) -> FloatArray:
        """(n_independent,) a configuration amid the map: clear of limits and singularities."""
        ...

    @property
    def box_mm(self) -> FloatArray:
        """(2, 2) corners that all of what the map reaches lies between."""
        ...

    def reference(self, tip_mm: FloatArray) -> FloatArray:
        """(n, n_independent) the map's configurations at tips (n, 3), whatever their height, nearly exact; outside of
        it, those of its edge."""
        ...

    def configurations_at(self, tip_mm: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Exact configurations (n, n_independent) at tips (n, 3), and where they exist within the joint limits."""
        ...

    def reaches(self, points_mm: FloatArray) -> BoolArray:
        """(n,) whether points of the paper (n, 2) lie within the map and the joint limits."""
        ...


def branch_references(branches: Sequence[ConfigurationMap], tips_mm: FloatArray, starts: IntArray) -> FloatArray:
    """(n, n_independent) the map's configurations at tips (n, 3), those of each path in the branch that holds most of
    it. starts: (n_paths,) the first tip of each."""
    if len(branches) == 1 or len(tips_mm) == 0:
        return branches[0].reference(tips_mm)
    held = np.array([np.add.reduceat(branch.reaches(tips_mm[:, :2]), starts, dtype=np.int64) for branch in branches])
    chosen = np.repeat(held.argmax(axis=0), np.diff(np.append(starts, len(tips_mm))))
    references = np.empty((len(tips_mm), len(branches[0].arm.independent_joints)))
    for index, branch in enumerate(branches):
        references[chosen == index] = branch.reference(tips_mm[chosen == index])
    return references
