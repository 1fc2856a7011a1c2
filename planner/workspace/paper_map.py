"""How well an arm draws at each place of the paper in front of it, in the configurations that it draws with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.kinematics.sensitivity import sideways_error
from planner.kinematics.singularity import manipulability
from planner.redundancy.arm_model import ArmModel

_RADII, _AZIMUTHS = 91, 121


@dataclass(frozen=True, eq=False, slots=True)
class PaperMap:
    """Figures at the nodes of a polar grid over the half ring that the pen reaches, all (n_radii, n_azimuths);
    NaN where a joint limit is in the way.

    x_mm, y_mm: places on the paper. manipulability: in mm and rad. sideways_error_mm: along the paper, rms over
    the joints, per degree (or mm) of error of each.
    """

    x_mm: FloatArray
    y_mm: FloatArray
    manipulability: FloatArray
    sideways_error_mm: FloatArray


def paper_map(model: ArmModel) -> PaperMap:
    """The map of an arm. Errors: PlanError where the arm cannot draw."""
    arm, branches = model.arm, model.branches()
    reach_mm = min(branch.radii_mm[0] for branch in branches), max(branch.radii_mm[-1] for branch in branches)
    radius, azimuth = np.meshgrid(
        np.linspace(*reach_mm, _RADII), np.linspace(-np.pi / 2, np.pi / 2, _AZIMUTHS), indexing="ij"
    )
    x, y = radius * np.cos(azimuth), radius * np.sin(azimuth)
    tips = np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size)))
    independent = np.zeros((len(tips), len(arm.independent_joints)))
    kept = np.zeros(len(tips), dtype=np.bool_)
    for branch in branches:
        rest = np.flatnonzero(~kept)
        independent[rest], kept[rest] = branch.configurations_at(tips[rest])
    joints = arm.complete(independent)
    figures = (
        np.where(kept, figure(arm, joints), np.nan).reshape(x.shape) for figure in (manipulability, sideways_error)
    )
    return PaperMap(x, y, *figures)
