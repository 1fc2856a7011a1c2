"""The general program against the closed forms: its configurations are branches of theirs, at the redundancy it
chose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.kinematics.limits import within_limits
from tests.arms.chains import kinematics_of, solver_of
from tests.inverse_kinematics.closed_forms.arms import NAMES, apart, arm_of, family, poses_of, redundancy_of

COUNT = 200
EXACT = 1e-7
ROOM = 0.01
"""Share of each joint's range that targets have from its limits: the program itself keeps a little from them."""


def targets_with_starts(arm: Arm) -> tuple[FloatArray, FloatArray]:
    """Tips (COUNT, 3) from the paper up to the lift height that some configuration within the limits meets, pen held,
    and configurations (COUNT, n_independent) somewhat away from it."""
    rng = np.random.default_rng(31)
    drawn = 400 * COUNT
    radius, azimuth = rng.uniform(arm.workspace.inner_radius_mm, 300.0, drawn), rng.uniform(-np.pi, np.pi, drawn)
    tips = np.column_stack((radius * np.cos(azimuth), radius * np.sin(azimuth), rng.uniform(0, arm.pen.lift_mm, drawn)))
    branches = family(arm).at_tip(arm, tips, rng.uniform(-np.pi, np.pi, drawn))
    roomy = replace(
        arm,
        joints=tuple(
            replace(
                joint,
                minimum=joint.minimum + ROOM * (joint.maximum - joint.minimum),
                maximum=joint.maximum - ROOM * (joint.maximum - joint.minimum),
            )
            for joint in arm.joints
        ),
    )
    inside = within_limits(roomy, roomy.complete(branches.configurations)) & ~branches.singular[:, None]
    target, branch = np.nonzero(inside)
    chosen = rng.choice(len(target), COUNT, replace=False)
    target, branch = target[chosen], branch[chosen]
    starts = branches.configurations[target, branch]
    speeds = kinematics_of(arm).independent_of(arm.max_velocity)
    return tips[target], starts + rng.normal(scale=0.02, size=starts.shape) * speeds


@pytest.mark.parametrize("name", NAMES)
def test_configurations_of_the_program_are_branches_of_the_closed_form(name: str) -> None:
    arm = arm_of(name)
    solver = solver_of(arm)
    tips, starts = targets_with_starts(arm)
    solved = [solver.solve(tip, start) for tip, start in zip(tips, starts, strict=True)]
    converged = np.array([good for _, good, _, _ in solved])
    assert converged.all()
    independent = np.array([configuration for configuration, _, _, _ in solved])
    joints = arm.complete(independent)
    assert ((joints >= arm.minimum - 1e-6) & (joints <= arm.maximum + 1e-6)).all()
    np.testing.assert_allclose(poses_of(arm, joints)[:, :3, 3], tips, rtol=0, atol=1e-3)
    branches = family(arm).at_tip(arm, tips, redundancy_of(arm, independent))
    away = apart(arm, branches.configurations, independent[:, None])
    assert np.where(branches.exist, away, np.inf).min(axis=1).max() < EXACT
