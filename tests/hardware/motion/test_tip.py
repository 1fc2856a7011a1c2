from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.motion.tip import link_nodes_mm, tip_at
from planner.arms.arm import Arm, Joint, JointKind, Pen, PenHold
from planner.arms.arm_file import load_arm
from planner.arms.rigid_transform import RigidTransform
from planner.checking.chain import chain_poses

DRAWING_ARM = load_arm("drawing_arm")


def _joint(name: str, kind: JointKind, d_mm: float, a_mm: float, alpha_rad: float) -> Joint:
    return Joint(name, kind, 0.3, d_mm, a_mm, alpha_rad, -3.0, 3.0, 1.0, 1.0, 1.0)


MIXED = replace(
    DRAWING_ARM,
    name="mixed",
    couplings=(),
    pen=Pen(PenHold.FREE, (0.0, 0.6, 0.8), 5.0, 1.0),
    joints=(
        _joint("a", JointKind.REVOLUTE, 40, 30, 0.7),
        _joint("b", JointKind.PRISMATIC, 10, -20, -1.2),
        _joint("c", JointKind.REVOLUTE, 5, 60, 0.4),
        _joint("d", JointKind.REVOLUTE, 0, 15, math.pi / 2),
    ),
)


OF_A_DESCRIPTION = replace(
    MIXED,
    name="with origins",
    tool=RigidTransform(3.0, -4.0, 50.0, 0.2, -0.4, 1.0),
    joints=tuple(
        replace(joint, origin=RigidTransform(10.0 * k, 5.0, 20.0, 0.3 * k, -0.5, 0.7))
        for k, joint in enumerate(MIXED.joints)
    ),
)


def test_known_configuration(arm: Arm) -> None:
    tip = tip_at(arm, np.radians([90.0, 60.0, -60.0, -60.0, -30.0]))
    np.testing.assert_allclose(tip.position_mm, [0, 100, 0], atol=1e-9)
    np.testing.assert_allclose(tip.axis, [0, 0, -1], atol=1e-12)


@pytest.mark.parametrize(
    "chain", [DRAWING_ARM, load_arm("drawing_arm_2022"), MIXED, OF_A_DESCRIPTION], ids=lambda chain: chain.name
)
@given(data=st.data())
def test_jacobian_is_the_finite_difference_and_the_chain_agrees_with_the_check(chain: Arm, data: st.DataObject) -> None:
    joints = np.array(data.draw(st.lists(st.floats(-3, 3), min_size=chain.n_joints, max_size=chain.n_joints)))
    tip = tip_at(chain, joints)
    other = chain_poses(chain, joints[None])
    np.testing.assert_allclose(tip.position_mm, other.tip_mm[:, 0], atol=1e-9)
    np.testing.assert_allclose(tip.axis, other.tool[:, 0], atol=1e-12)
    nodes_mm = link_nodes_mm(chain, np.stack((joints, -joints)))
    np.testing.assert_allclose(nodes_mm[:, -1], [tip.position_mm, tip_at(chain, -joints).position_mm], atol=1e-9)
    np.testing.assert_allclose(
        min(0.0, nodes_mm[0, :, 2].min()), min(0.0, other.lowest_mm[0], tip.position_mm[2]), atol=1e-9
    )
    step = 1e-5
    for k in range(chain.n_joints):
        change = step * np.eye(chain.n_joints)[k]
        ahead, behind = tip_at(chain, joints + change), tip_at(chain, joints - change)
        np.testing.assert_allclose(
            tip.position_jacobian[:, k], (ahead.position_mm - behind.position_mm) / (2 * step), atol=1e-5
        )
        np.testing.assert_allclose(tip.axis_jacobian[:, k], (ahead.axis - behind.axis) / (2 * step), atol=1e-8)
