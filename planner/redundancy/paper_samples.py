"""Configurations anywhere on the paper: what the map of an arm that does not turn over its paper begins with, and what
tells why an arm has none."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import PenHold
from planner.arrays import BoolArray, FloatArray
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import joint_scale, turning_joints
from planner.redundancy.configuration_tests import usable_configurations
from planner.redundancy.paper_grid import PaperGrid
from planner.redundancy.samples import turned_into_range

_DRAWN, _TRIED = 40_000, 5_000
_ITERATIONS, _DAMPING, _EXACT = 15, 1e-10, 1e-6
_NODES_ACROSS, _MOST_NODES, _NODES_BEYOND = 20, 1000, 3
"""Nodes over the smaller side of what samples reach, of the whole grid at most, and beyond the samples on each side."""
_LEAST_SPACING_MM = 1.0


def starts_for_paper(kinematics: Kinematics, n_drawn: int = _DRAWN, n_kept: int = _TRIED) -> FloatArray:
    """(m, n_independent) of so many random configurations those that come closest to the paper with the pen held as it
    is held; none where the pen always points away from it."""
    arm = kinematics.arm
    low, high = kinematics.independent_of(arm.minimum), kinematics.independent_of(arm.maximum)
    drawn = np.random.default_rng(20220601).uniform(low, high, (n_drawn, kinematics.n_independent))
    if arm.pen.hold is PenHold.TOOL_AXIS:
        drawn = drawn[kinematics.tool_axis(drawn)[:, 2] < 0]
    if not len(drawn):
        return drawn
    task, _ = kinematics.task_and_jacobian(drawn)
    longest = max(float(np.ptp(task[:, :3], axis=0).max()), 1e-9)
    off = np.abs(task[:, 2]) / longest + np.abs(task[:, 3:]).sum(axis=1)
    return drawn[np.argsort(off, kind="stable")[:n_kept]]


def on_paper(kinematics: Kinematics, starts: FloatArray) -> FloatArray:
    """(m, n_independent) what becomes of configurations (n, n_independent) whose pen is put onto the paper and held as
    it is held, by the least motion of the joints, wherever on the paper that is: those that get there."""
    found = starts.copy()
    scale, turning = joint_scale(kinematics), turning_joints(kinematics)
    for _ in range(_ITERATIONS):
        task, jacobian = kinematics.task_and_jacobian(found)
        rows = jacobian[:, 2:] * scale
        gram = rows @ rows.transpose(0, 2, 1)
        gram += _DAMPING * np.trace(gram, axis1=1, axis2=2)[:, None, None] * np.eye(gram.shape[1])
        change = (rows.transpose(0, 2, 1) @ np.linalg.solve(gram, -task[:, 2:, None]))[:, :, 0] * scale
        longest = np.abs(change[:, turning]).max(axis=1, initial=0.0)
        found += change * np.minimum(1.0, 0.5 * np.pi / np.maximum(longest, 1e-300))[:, None]
    task, _ = kinematics.task_and_jacobian(found)
    return turned_into_range(kinematics, found[np.abs(task[:, 2:]).max(axis=1, initial=0.0) < _EXACT])


def usable_on_paper(kinematics: Kinematics, found: FloatArray) -> FloatArray:
    """Those of configurations (n, n_independent) on the paper that pass all tests, outside of the inner radius."""
    kept = found[outside_of_base(kinematics, kinematics.tip_mm(found))]
    return kept[usable_configurations(kinematics, kept)]


def outside_of_base(kinematics: Kinematics, tips_mm: FloatArray) -> BoolArray:
    """(...) whether tips (..., 3) keep the inner radius from the base."""
    workspace, base_mm = kinematics.arm.workspace, kinematics.arm.paper.T_paper_base[:3, 3]
    outside: BoolArray = np.linalg.norm(tips_mm - base_mm, axis=-1) >= workspace.inner_radius_mm
    return outside


def grid_around(tips_mm: FloatArray) -> PaperGrid:
    """A grid over all tips (n, 3) and a little more, n > 0."""
    low, high = tips_mm[:, :2].min(axis=0), tips_mm[:, :2].max(axis=0)
    sides = np.maximum(high - low, _LEAST_SPACING_MM)
    spacing_mm = max(float(sides.min()) / _NODES_ACROSS, float(np.sqrt(sides.prod() / _MOST_NODES)), _LEAST_SPACING_MM)
    shape = np.ceil(sides / spacing_mm).astype(np.int64) + 1 + 2 * _NODES_BEYOND
    middle = (low + high) / 2
    return PaperGrid(middle - (shape - 1) / 2 * spacing_mm, spacing_mm, (int(shape[0]), int(shape[1])))
