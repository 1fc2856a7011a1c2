"""How well an arm draws at each place of the paper in front of it, in the configurations that it draws with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.kinematics.sensitivity import sideways_error
from planner.kinematics.singularity import manipulability
from planner.redundancy.arm_model import ArmModel
from planner.redundancy.configuration_map import ConfigurationMap
from planner.redundancy.ring_map import RingMap

_RADII, _AZIMUTHS = 91, 121


@dataclass(frozen=True, eq=False, slots=True)
class PaperMap:
    """Figures at the nodes of a grid over what the pen reaches, all of one shape (n, m): a polar one over a half ring,
    or a square one. NaN where the arm does not get to.

    x_mm, y_mm: places on the paper. manipulability: in mm and rad. sideways_error_mm: along the paper, rms over
    the joints, per degree (or mm) of error of each.
    """

    x_mm: FloatArray
    y_mm: FloatArray
    manipulability: FloatArray
    sideways_error_mm: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class PaperNodes:
    """The nodes of such a grid: places (n, m), the configurations that lines are drawn in there
    (n m, n_joints), row by row, and which of them the arm gets to (n m,)."""

    x_mm: FloatArray
    y_mm: FloatArray
    joints: FloatArray
    kept: BoolArray

    def map_of(self, figures: FloatArray) -> FloatArray:
        """(n, m) of figures (n m,), NaN where the arm does not get to."""
        return np.where(self.kept, figures, np.nan).reshape(self.x_mm.shape)


def paper_map(model: ArmModel) -> PaperMap:
    """The map of an arm. Errors: PlanError where the arm cannot draw."""
    arm, nodes = model.arm, paper_nodes(model)
    figures = (nodes.map_of(figure(arm, nodes.joints)) for figure in (manipulability, sideways_error))
    return PaperMap(nodes.x_mm, nodes.y_mm, *figures)


def paper_nodes(model: ArmModel) -> PaperNodes:
    """Errors: PlanError where the arm cannot draw."""
    arm, branches = model.arm, model.branches()
    x, y = _half_ring(model.rings()) if model.rings() else _square(branches)
    tips = np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size)))
    independent = np.zeros((len(tips), len(arm.independent_joints)))
    kept = np.zeros(len(tips), dtype=np.bool_)
    for branch in branches:
        rest = np.flatnonzero(~kept)
        independent[rest], kept[rest] = branch.configurations_at(tips[rest])
        if not model.rings():
            kept[rest] &= branch.reaches(tips[rest, :2])
    return PaperNodes(x, y, arm.complete(independent), kept)


def _half_ring(rings: Sequence[RingMap]) -> tuple[FloatArray, FloatArray]:
    reach_mm = min(ring.radii_mm[0] for ring in rings), max(ring.radii_mm[-1] for ring in rings)
    radius, azimuth = np.meshgrid(
        np.linspace(*reach_mm, _RADII), np.linspace(-np.pi / 2, np.pi / 2, _AZIMUTHS), indexing="ij"
    )
    azimuth += rings[0].ahead_rad
    return radius * np.cos(azimuth), radius * np.sin(azimuth)


def _square(branches: Sequence[ConfigurationMap]) -> tuple[FloatArray, FloatArray]:
    low = np.min([branch.box_mm[0] for branch in branches], axis=0)
    high = np.max([branch.box_mm[1] for branch in branches], axis=0)
    x, y = np.meshgrid(*(np.linspace(one, other, _RADII) for one, other in zip(low, high, strict=True)), indexing="ij")
    return x, y
