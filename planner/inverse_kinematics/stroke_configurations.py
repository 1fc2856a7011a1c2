"""Joint paths for pen paths, by any method: reference configurations first, then exact ones near them.

A method decides how the arm's redundancy is used; it gives a reference configuration for every knot of a path. The
nearest configurations that put the pen exactly on the path are then joined by splines, so that every method
yields smooth joint paths of the same accuracy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.inverse_kinematics import dls, nlp
from planner.inverse_kinematics.closed_forms import closed_form_configurations
from planner.inverse_kinematics.joint_path import JointPaths, interpolate
from planner.kinematics.chain import kinematics_of
from planner.kinematics.link_clearance import link_clearance
from planner.kinematics.projection import project
from planner.placement.pen_path import PenPaths
from planner.ragged import starts_of
from planner.redundancy.configuration_map import branch_references, configuration_branches, configuration_map_of
from planner.settings import ConfigurationWeights, Method

_WEIGHTS = ConfigurationWeights()
_HOME = ConfigurationWeights(time=0.1, sensitivity=0.0, reversals=0.0, limits=1.0)
"""Sequential methods start from a home that is well inside the joint limits."""

TARGET_SPACING_MM = 1.0
"""Distance between the targets that sequential methods solve for; splines carry their configurations between."""
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


def configurations_at(
    arm: Arm, method: Method, tips_mm: FloatArray, weights: ConfigurationWeights = _WEIGHTS
) -> FloatArray:
    """(n, n_independent) reference configurations for single tips (n, 3), each by itself."""
    if method is Method.PATH:
        return branch_references(configuration_branches(arm, weights), tips_mm, np.arange(len(tips_mm)))
    if method is Method.CLOSED_FORM:
        return closed_form_configurations(arm)(arm, tips_mm)
    if len(tips_mm) == 0:
        return np.empty((0, len(arm.independent_joints)))
    return np.concatenate([_sequence(arm, method, tip[None]) for tip in tips_mm])


def exact_configurations(
    arm: Arm, references: FloatArray, tips_mm: FloatArray
) -> tuple[FloatArray, list[InfeasiblePath]]:
    """Exact configurations near the references, and for those that fail the reason, with the index as path."""
    independent, exact = project(kinematics_of(arm), np.nan_to_num(references), tips_mm)
    joints = arm.complete(independent)
    outside = np.maximum(arm.minimum - joints, joints - arm.maximum).max(axis=1) > 1e-9
    return independent, [
        _infeasible_path(arm, index, joints[index], tips_mm[index], bool(exact[index]))
        for index in np.flatnonzero(~exact | outside).tolist()
    ]


def joint_paths(
    arm: Arm, method: Method, paths: PenPaths, weights: ConfigurationWeights = _WEIGHTS
) -> tuple[JointPaths, list[InfeasiblePath]]:
    """Joint splines along pen paths on the paper, and the paths that cannot be followed, each with where.

    Where a sequential method leads out of the joints' ranges, or from branch to branch, its references are drawn
    towards those of method `path`, all along a path alike, by as little as lets it be followed.
    """
    starts = starts_of(paths.n_cells)
    corners = paths.points(np.array([0.0, 1.0]))
    knots = np.insert(corners[:, 0], starts[1:], corners[starts[1:] - 1, 1], axis=0)
    tips = np.column_stack((knots, np.zeros(len(knots))))
    per_path = starts + np.arange(len(starts))  # each path has a knot more than cells
    if method in (Method.DLS, Method.NLP):
        references = np.concatenate(
            [_sequential_references(arm, method, tips[first:last]) for first, last in pairwise(per_path)]
        )
    elif method is Method.PATH:
        references = branch_references(configuration_branches(arm, weights), tips, per_path[:-1])
    else:
        references = configurations_at(arm, method, tips, weights)
    splines, infeasible_paths = _followed(arm, paths, references, tips, per_path)
    if method not in (Method.DLS, Method.NLP) or not infeasible_paths:
        return splines, infeasible_paths
    reasons = {infeasible_path.path: infeasible_path for infeasible_path in infeasible_paths}
    wished = references.copy()
    sure = branch_references(configuration_branches(arm, weights), tips, per_path[:-1])
    for share in _TO_METHOD_PATH:
        for infeasible_path in infeasible_paths:
            along = slice(int(per_path[infeasible_path.path]), int(per_path[infeasible_path.path + 1]))
            references[along] = (1 - share) * wished[along] + share * sure[along]
        splines, infeasible_paths = _followed(arm, paths, references, tips, per_path)
        if not infeasible_paths:
            break
    return splines, [reasons[infeasible_path.path] for infeasible_path in infeasible_paths]


def _followed(
    arm: Arm, paths: PenPaths, references: FloatArray, tips_mm: FloatArray, per_path: IntArray
) -> tuple[JointPaths, list[InfeasiblePath]]:
    """Joint splines through the exact configurations near the references (n_knots, n_independent), and the paths that
    these cannot follow."""
    independent, exact = project(kinematics_of(arm), np.nan_to_num(references), tips_mm)
    exact &= np.isfinite(independent).all(axis=1)  # where it ran away, the spline still needs numbers
    independent = np.where(np.isfinite(independent), independent, 0.0)
    splines = interpolate(paths.n_cells, arm.complete(independent))
    strayed = strays_mm(arm, paths, splines) > _STRAYED_MM
    return splines, _infeasible_paths(arm, splines, tips_mm, exact, per_path, strayed)


def strays_mm(arm: Arm, paths: PenPaths, splines: JointPaths) -> FloatArray:
    """(total cells,) how far the tip is off its path in the middle between two knots."""
    kinematics = kinematics_of(arm)
    middles = kinematics.tip_mm(kinematics.independent_of(splines.positions(_MIDDLE)[:, 0]))
    middles[:, :2] -= paths.points(_MIDDLE)[:, 0]
    strays: FloatArray = np.abs(middles).max(axis=1)
    return strays


def colliding_paths(arm: Arm, samples: Sequence[FloatArray]) -> dict[int, InfeasiblePath]:
    """For the paths whose joint samples (n, n_joints) bring links too close to each other or to the paper: where."""
    kinematics = kinematics_of(arm)
    infeasible_paths = {}
    for path, collision in enumerate(link_clearance(arm).collisions(samples)):
        if collision:
            x, y, _ = kinematics.tip_mm(kinematics.independent_of(samples[path][collision.configuration])[None])[
                0
            ].tolist()
            infeasible_paths[path] = InfeasiblePath(path, (x, y), str(collision), None, None)
    return infeasible_paths


def home_of(arm: Arm) -> FloatArray:
    """(n_independent,) the configuration that sequential methods start each stroke from. Errors: as
    `configuration_map_of`."""
    return configuration_map_of(arm, _HOME).home


def _sequence(arm: Arm, method: Method, tips_mm: FloatArray) -> FloatArray:
    """Configurations of targets solved one after the other, the first from the arm's home."""
    home = home_of(arm)
    if method is Method.DLS:
        return dls.solve_sequence(arm, tips_mm, arm.complete(home), dls.FOR_DRAWING).configurations
    return nlp.solve_sequence(arm, tips_mm, home).configurations


def _sequential_references(arm: Arm, method: Method, tips_mm: FloatArray) -> FloatArray:
    """(n_knots, n_independent): targets about a millimetre apart are solved in turn and joined by a spline."""
    from scipy.interpolate import make_interp_spline  # heavy, and only these methods need it

    travelled = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(tips_mm, axis=0), axis=1))))
    count = max(int(np.ceil(travelled[-1] / TARGET_SPACING_MM)), 1) + 1
    wanted = np.searchsorted(travelled, np.linspace(0.0, travelled[-1], count))
    chosen = np.unique(np.concatenate(([0], np.minimum(wanted, len(tips_mm) - 1), [len(tips_mm) - 1])))
    configurations = np.nan_to_num(_sequence(arm, method, tips_mm[chosen]))
    spline = make_interp_spline(chosen, configurations, k=min(5, 2 * ((len(chosen) - 2) // 2) + 1))
    references: FloatArray = np.ascontiguousarray(spline(np.arange(len(tips_mm))))
    return references


def _infeasible_paths(
    arm: Arm, splines: JointPaths, tips_mm: FloatArray, exact: BoolArray, per_path: IntArray, strayed: BoolArray
) -> list[InfeasiblePath]:
    """The first place of each path where the pen is off its target or a joint beyond its limits."""
    starts = starts_of(splines.n_cells)
    joints = splines.positions(_CHECKED)
    outside = np.maximum(arm.minimum - joints, joints - arm.maximum).max(axis=2) > 1e-9
    infeasible_paths = []
    missed = np.add.reduceat(~exact, per_path[:-1]) > 0
    jumped = np.add.reduceat(strayed, starts[:-1]) > 0
    beyond = np.add.reduceat(outside.any(axis=1), starts[:-1]) > 0
    for path in np.flatnonzero(missed | beyond | jumped).tolist():
        cells = slice(int(starts[path]), int(starts[path + 1]))
        if missed[path]:
            knot = int(per_path[path] + np.argmin(exact[per_path[path] : per_path[path + 1]]))
            cell = min(knot - path, cells.stop - 1)
            infeasible_paths.append(_infeasible_path(arm, path, joints[cell, 0], tips_mm[knot], exact=False))
        elif beyond[path]:
            cell = int(starts[path] + np.argmax(outside[cells].any(axis=1)))
            at = int(np.argmax(outside[cell]))
            infeasible_paths.append(_infeasible_path(arm, path, joints[cell, at], tips_mm[cell + path], exact=True))
        else:
            tip = tips_mm[int(starts[path] + np.argmax(strayed[cells])) + path]
            infeasible_paths.append(
                InfeasiblePath(
                    path, (float(tip[0]), float(tip[1])), "the method changes to another branch there", None, None
                )
            )
    return infeasible_paths


def _infeasible_path(arm: Arm, path: int, joints: FloatArray, tip_mm: FloatArray, exact: bool) -> InfeasiblePath:
    tip = (float(tip_mm[0]), float(tip_mm[1]))
    if exact:
        excess = np.maximum(arm.minimum - joints, joints - arm.maximum)
        worst = int(np.argmax(excess))
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
    kinematics = kinematics_of(arm)
    reached = kinematics.tip_mm(kinematics.independent_of(joints)[None])[0]
    gap = float(np.hypot(*(reached[:2] - tip_mm[:2])))
    reason = f"the target is beyond the arm's reach (nearest tip found {gap:.1f} mm away)"
    return InfeasiblePath(path, tip, reason, None, None)
