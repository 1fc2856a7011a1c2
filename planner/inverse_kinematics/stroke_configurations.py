"""Joint paths for pen paths, by any method: reference configurations first, then exact ones near them.

A method gives a reference configuration for every knot of a path. The nearest configurations that put the pen exactly
on the path are then joined by splines, so that every method yields smooth joint paths of the same accuracy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.inverse_kinematics.joint_path import JointPaths, interpolate
from planner.inverse_kinematics.references import References
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import SLACK, beyond_limits
from planner.kinematics.projection import project
from planner.placement.pen_path import PenPaths
from planner.ragged import starts_of

_CHECKED = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
_MIDDLE = np.array([0.5])
_TO_METHOD_PATH = (0.05, 0.1, 0.2, 0.4, 0.7, 1.0)
"""Shares of the way to the references of method `path` that are tried one after the other."""
_STRAYED_MM = 0.005
"""A spline that strays further than this from its path between exact knots joins configurations of different
branches."""


@dataclass(frozen=True, slots=True)
class InfeasiblePath:
    """Why a path cannot be followed: the first place where it fails."""

    path: int
    tip_mm: tuple[float, float]
    reason: str
    joint: str | None
    limit: str | None


def exact_configurations(
    kinematics: Kinematics, references: FloatArray, tips_mm: FloatArray
) -> tuple[FloatArray, list[InfeasiblePath]]:
    """Exact configurations near the references, and for those that fail the reason, with the index as path."""
    independent, exact = project(kinematics, np.nan_to_num(references), tips_mm)
    joints = kinematics.arm.complete(independent)
    outside = beyond_limits(kinematics.arm, joints).max(axis=1) > SLACK
    return independent, [
        _infeasible_path(kinematics, index, joints[index], tips_mm[index], bool(exact[index]))
        for index in np.flatnonzero(~exact | outside).tolist()
    ]


def joint_paths(
    kinematics: Kinematics, references: References, paths: PenPaths
) -> tuple[JointPaths, list[InfeasiblePath]]:
    """Joint splines along pen paths on the paper, and the paths that cannot be followed, each with where.

    Where a sequential method leads out of the joints' ranges, or from branch to branch, its references are drawn
    towards those of method `path`, all along a path alike, by as little as lets it be followed.
    """
    starts = starts_of(paths.n_cells)
    corners = paths.positions(np.array([0.0, 1.0]))
    knots = np.insert(corners[:, 0], starts[1:], corners[starts[1:] - 1, 1], axis=0)
    tips = np.column_stack((knots, np.zeros(len(knots))))
    per_path = starts + np.arange(len(starts))  # each path has a knot more than cells
    wished = references.along(tips, per_path[:-1])
    splines, infeasible_paths = _followed(kinematics, paths, wished, tips, per_path)
    sure = references.surely_along(tips, per_path[:-1]) if infeasible_paths else None
    if sure is None:
        return splines, infeasible_paths
    reasons = {infeasible_path.path: infeasible_path for infeasible_path in infeasible_paths}
    tried = wished.copy()
    for share in _TO_METHOD_PATH:
        for infeasible_path in infeasible_paths:
            along = slice(int(per_path[infeasible_path.path]), int(per_path[infeasible_path.path + 1]))
            tried[along] = (1 - share) * wished[along] + share * sure[along]
        splines, infeasible_paths = _followed(kinematics, paths, tried, tips, per_path)
        if not infeasible_paths:
            break
    return splines, [reasons[infeasible_path.path] for infeasible_path in infeasible_paths]


def _followed(
    kinematics: Kinematics, paths: PenPaths, references: FloatArray, tips_mm: FloatArray, per_path: IntArray
) -> tuple[JointPaths, list[InfeasiblePath]]:
    """Joint splines through the exact configurations near the references (n_knots, n_independent), and the paths that
    these cannot follow."""
    independent, exact = project(kinematics, np.nan_to_num(references), tips_mm)
    exact &= np.isfinite(independent).all(axis=1)  # where it ran away, the spline still needs numbers
    independent = np.where(np.isfinite(independent), independent, 0.0)
    splines = interpolate(paths.n_cells, kinematics.arm.complete(independent))
    strayed = strays_mm(kinematics, paths, splines) > _STRAYED_MM
    return splines, _infeasible_paths(kinematics, splines, tips_mm, exact, per_path, strayed)


def strays_mm(kinematics: Kinematics, paths: PenPaths, splines: JointPaths) -> FloatArray:
    """(total cells,) how far the tip is off its path in the middle between two knots."""
    middles = kinematics.tip_mm(kinematics.independent_of(splines.positions(_MIDDLE)[:, 0]))
    middles[:, :2] -= paths.positions(_MIDDLE)[:, 0]
    strays: FloatArray = np.abs(middles).max(axis=1)
    return strays


def colliding_paths(kinematics: Kinematics, samples: Sequence[FloatArray]) -> dict[int, InfeasiblePath]:
    """For the paths whose joint samples (n, n_joints) bring links too close to each other or to the paper: where."""
    infeasible_paths = {}
    for path, collision in enumerate(kinematics.clearance.collisions(samples)):
        if collision:
            x, y, _ = kinematics.tip_mm(kinematics.independent_of(samples[path][collision.configuration])[None])[
                0
            ].tolist()
            infeasible_paths[path] = InfeasiblePath(path, (x, y), str(collision), None, None)
    return infeasible_paths


def _infeasible_paths(
    kinematics: Kinematics,
    splines: JointPaths,
    tips_mm: FloatArray,
    exact: BoolArray,
    per_path: IntArray,
    strayed: BoolArray,
) -> list[InfeasiblePath]:
    """The first place of each path where the pen is off its target or a joint beyond its limits."""
    starts = starts_of(splines.n_cells)
    joints = splines.positions(_CHECKED)
    outside = beyond_limits(kinematics.arm, joints).max(axis=2) > SLACK
    infeasible_paths = []
    missed = np.add.reduceat(~exact, per_path[:-1]) > 0
    jumped = np.add.reduceat(strayed, starts[:-1]) > 0
    beyond = np.add.reduceat(outside.any(axis=1), starts[:-1]) > 0
    for path in np.flatnonzero(missed | beyond | jumped).tolist():
        cells = slice(int(starts[path]), int(starts[path + 1]))
        if missed[path]:
            knot = int(per_path[path] + np.argmin(exact[per_path[path] : per_path[path + 1]]))
            cell = min(knot - path, cells.stop - 1)
            infeasible_paths.append(_infeasible_path(kinematics, path, joints[cell, 0], tips_mm[knot], exact=False))
        elif beyond[path]:
            cell = int(starts[path] + np.argmax(outside[cells].any(axis=1)))
            at = int(np.argmax(outside[cell]))
            infeasible_paths.append(
                _infeasible_path(kinematics, path, joints[cell, at], tips_mm[cell + path], exact=True)
            )
        else:
            tip = tips_mm[int(starts[path] + np.argmax(strayed[cells])) + path]
            infeasible_paths.append(
                InfeasiblePath(
                    path, (float(tip[0]), float(tip[1])), "the method changes to another branch there", None, None
                )
            )
    return infeasible_paths


def _infeasible_path(
    kinematics: Kinematics, path: int, joints: FloatArray, tip_mm: FloatArray, exact: bool
) -> InfeasiblePath:
    arm, tip = kinematics.arm, (float(tip_mm[0]), float(tip_mm[1]))
    if exact:
        worst = int(np.argmax(beyond_limits(arm, joints)))
        joint = arm.joints[worst]
        low = joints[worst] < arm.minimum[worst]
        bound = joint.minimum if low else joint.maximum
        limit = f"{'lower' if low else 'upper'} limit {bound / joint.per_file_unit:g} {joint.file_unit}"
        return InfeasiblePath(
            path,
            tip,
            f"joint {joint.name} would be at {joints[worst] / joint.per_file_unit:.4f}"
            f" {joint.file_unit}, beyond its {limit}",
            joint.name,
            limit,
        )
    reached = kinematics.tip_mm(kinematics.independent_of(joints)[None])[0]
    gap = float(np.hypot(*(reached[:2] - tip_mm[:2])))
    reason = f"the target is beyond the arm's reach (nearest tip found {gap:.1f} mm away)"
    return InfeasiblePath(path, tip, reason, None, None)
