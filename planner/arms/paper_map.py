"""How well an arm draws at each place of the paper in front of it, in the postures that it draws with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arms.posture_field import posture_sheets
from planner.arms.sensitivity import sideways_error
from planner.arms.singularity import manipulability
from planner.arrays import FloatArray

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


def paper_map(arm: Arm) -> PaperMap:
    """The map of an arm. Errors: PlanError where the arm cannot draw."""
    sheets = posture_sheets(arm)
    reach_mm = min(sheet.radii_mm[0] for sheet in sheets), max(sheet.radii_mm[-1] for sheet in sheets)
    radius, azimuth = np.meshgrid(np.linspace(*reach_mm, _RADII),
                                  np.linspace(-np.pi / 2, np.pi / 2, _AZIMUTHS), indexing="ij")
    x, y = radius * np.cos(azimuth), radius * np.sin(azimuth)
    tips = np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size)))
    free = np.zeros((len(tips), len(arm.free_joints)))
    kept = np.zeros(len(tips), dtype=np.bool_)
    for sheet in sheets:
        rest = np.flatnonzero(~kept)
        free[rest], kept[rest] = sheet.postures_at(tips[rest])
    joints = arm.complete(free)
    figures = (np.where(kept, figure(arm, joints), np.nan).reshape(x.shape)
               for figure in (manipulability, sideways_error))
    return PaperMap(x, y, *figures)
