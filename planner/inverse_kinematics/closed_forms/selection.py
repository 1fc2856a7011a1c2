"""Which of all configurations to draw with: one branch, and a value of the redundancy for every radius.

Apart from the base, no joint depends on where around the base a tip lies. So a radius is enough to choose by: the
middle of the widest window of redundancy values that the joint limits allow, as a smooth function of the radius,
on the branch that gets to most of the paper.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.errors import PlanError
from planner.inverse_kinematics.closed_forms.branches import Branches
from planner.kinematics.limits import SLACK

if TYPE_CHECKING:
    from numpy.polynomial import Chebyshev

AtTip = Callable[[Arm, FloatArray, FloatArray], Branches]
"""Arm, tips (n, 3) and redundancy (n,) to all configurations."""

_REDUNDANCY_RAD = np.radians(np.arange(-180.0, 180.0))
_RADII = 120
_AZIMUTHS_RAD = np.radians(np.arange(-90.0, 91.0, 5.0))
_DEGREE = 8


@dataclass(frozen=True, eq=False, slots=True)
class Selection:
    """The branch to draw with, and its redundancy in rad by the radius in mm (None: there is nothing to choose)."""

    branch: int
    redundancy: Chebyshev | None

    def redundancy_at(self, radius_mm: FloatArray) -> FloatArray:
        """(n,) rad at radii (n,); beyond the radii that the branch gets to, the value at the nearest of them."""
        if self.redundancy is None:
            return np.zeros(len(radius_mm))
        chosen: FloatArray = self.redundancy(np.clip(radius_mm, *self.redundancy.domain))
        return chosen


@dataclass(frozen=True, eq=False, slots=True)
class _Survey:
    """Configurations over a grid of radii and redundancy values: joints (n_radii, n_values, n_branches, n_joints), and
    how far within its range the joint lies that is nearest to a limit, as a share of the range; -inf where outside. The
    base counts for `share`: the part of the directions in front of the arm that it can turn to."""

    radii_mm: FloatArray
    joints: FloatArray
    room: FloatArray
    share: FloatArray


def select(arm: Arm, at_tip: AtTip, redundant: bool) -> Selection:
    """The selection for drawing on the paper. Errors: PlanError where no configuration is within the joint limits."""
    values = _REDUNDANCY_RAD if redundant else np.zeros(1)
    bound = sum(abs(joint.a_mm) + abs(joint.d_mm) for joint in arm.joints) + float(
        sum(max(abs(joint.minimum), abs(joint.maximum)) for joint in arm.joints if joint.file_unit == "mm")
    )
    inner = min(arm.workspace.inner_radius_mm, bound)
    coarse = _survey(arm, at_tip, np.linspace(inner, bound, _RADII), values[::5])
    reached = np.flatnonzero((coarse.room > -np.inf).any(axis=(1, 2)))
    if not len(reached):
        raise PlanError(f"arm {arm.name}: the closed form finds no configuration within the joint limits on the paper")
    step = coarse.radii_mm[1] - coarse.radii_mm[0]
    span = coarse.radii_mm[reached[[0, -1]]] + (-step, step)
    survey = _survey(arm, at_tip, np.linspace(max(span[0], inner), span[1], _RADII), values)
    branch = _widest_branch(survey)
    if not redundant:
        return Selection(branch, None)
    windows = [
        _middle_of_widest(values, survey.joints[row, :, branch], survey.room[row, :, branch] > -np.inf)
        for row in range(_RADII)
    ]
    first, last = _longest_run(~np.isnan(windows))
    radii = survey.radii_mm[first : last + 1]
    middles = np.unwrap(windows[first : last + 1])
    from numpy.polynomial import Chebyshev

    return Selection(branch, Chebyshev.fit(radii, middles, min(_DEGREE, len(radii) - 1)))


def _survey(arm: Arm, at_tip: AtTip, radii_mm: FloatArray, values_rad: FloatArray) -> _Survey:
    tips = np.zeros((len(radii_mm) * len(values_rad), 3))
    tips[:, 0] = np.repeat(radii_mm, len(values_rad))
    configurations = at_tip(arm, tips, np.tile(values_rad, len(radii_mm))).configurations
    joints = arm.complete(np.ascontiguousarray(configurations))
    from_limit = np.minimum(joints - arm.minimum, arm.maximum - joints)
    room = (from_limit / (arm.maximum - arm.minimum))[..., 1:].min(axis=-1)
    room[~(from_limit[..., 1:] >= -SLACK).all(axis=-1)] = -np.inf
    base = joints[..., 0] - (arm.minimum[0] + arm.maximum[0]) / 2
    half = (arm.maximum[0] - arm.minimum[0]) / 2 + SLACK
    share = np.zeros(base.shape)
    for azimuth in _AZIMUTHS_RAD:
        turned = base + azimuth
        share += np.abs(turned - 2 * np.pi * np.rint(turned / (2 * np.pi))) <= half
    grid = (len(radii_mm), len(values_rad), configurations.shape[1])
    return _Survey(
        radii_mm, joints.reshape(*grid, arm.n_joints), room.reshape(grid), share.reshape(grid) / len(_AZIMUTHS_RAD)
    )


def _widest_branch(survey: _Survey) -> int:
    """The branch that gets to most of the paper and, where several do, the one with most room to the limits."""
    usable = survey.room > -np.inf
    covered = np.where(usable, survey.share, 0.0).max(axis=1).sum(axis=0)
    room = (np.where(usable, survey.room, 0.0) * survey.share).sum(axis=(0, 1))
    return max(range(len(covered)), key=lambda branch: (round(float(covered[branch]), 6), float(room[branch])))


def _middle_of_widest(values_rad: FloatArray, joints: FloatArray, allowed: BoolArray) -> float:
    """Middle of the longest run of allowed values around the circle, along which no joint (m, n_joints) goes over
    to another turn; NaN where nothing is allowed."""
    if not allowed.any():
        return float("nan")
    with np.errstate(invalid="ignore"):
        jumps = (np.abs(np.roll(joints, -1, axis=0) - joints) > np.pi).any(axis=1)
    ends = allowed & (jumps | ~np.roll(allowed, -1))
    start = (int(np.flatnonzero(ends)[-1]) + 1) % len(values_rad) if ends.any() else 0
    # Cut open where a run ends, so that no run goes over the end of the array.
    steps = (start + np.arange(len(values_rad))) % len(values_rad)
    run = np.concatenate(([0], np.cumsum(ends[steps])[:-1]))
    runs = np.bincount(run[allowed[steps]])
    inside = np.flatnonzero((run == int(runs.argmax())) & allowed[steps])
    angles = values_rad[0] + (values_rad[1] - values_rad[0]) * (start + inside[[0, -1]])
    return float(angles.mean())


def _longest_run(flags: BoolArray) -> tuple[int, int]:
    """First and last index of the longest run of true values; there is one at least."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(np.int8), [0]))))
    starts, ends = edges[0::2], edges[1::2] - 1
    longest = int((ends - starts).argmax())
    return int(starts[longest]), int(ends[longest])
