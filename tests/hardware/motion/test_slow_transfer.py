from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hardware.motion.slow_transfer import slow_transfer
from hardware.motion.stopping import lift, slow_down
from hardware.motion.tip import link_nodes_mm
from planner.arms.arm import Arm
from planner.arms.arm_file import known_arms, load_arm
from planner.errors import PlanError

ARMS = [load_arm(name) for name in known_arms()]
RATE_HZ = 100.0
DOWN = np.radians([25.0, 60.0, -60.0, -60.0, -30.0])


@settings(max_examples=40, deadline=None)
@given(arm=st.sampled_from(ARMS), shares=st.lists(st.floats(0, 1), min_size=14, max_size=14))
def test_it_arrives_with_the_pen_in_the_air_and_in_no_hurry(arm: Arm, shares: list[float]) -> None:
    ends = np.reshape(shares[: 2 * arm.n_joints], (2, arm.n_joints)) * (arm.maximum - arm.minimum) + arm.minimum
    start, goal = ends = arm.complete(ends[:, list(arm.independent_joints)])
    assume(bool(((ends >= arm.minimum) & (ends <= arm.maximum)).all()))
    assume(link_nodes_mm(arm, ends)[:, :, 2].min() > arm.pen.clearance_mm)
    try:
        points = slow_transfer(arm, start, goal, RATE_HZ)
    except PlanError:  # between some configurations there may be no such way
        return
    way = np.concatenate((start[None], points))
    np.testing.assert_allclose(way[-1], goal, atol=1e-7)
    assert (np.abs(np.diff(way, axis=0)) * RATE_HZ <= arm.max_velocity * 0.21).all()
    assert slow_down(arm, np.concatenate((np.tile(start, (3, 1)), way)), 1 / RATE_HZ) <= 1
    np.testing.assert_allclose(way, arm.complete(way[:, list(arm.independent_joints)]), atol=1e-9)
    heights_mm = link_nodes_mm(arm, way)[:, :, 2]
    assert heights_mm[:, -1].min() >= arm.pen.clearance_mm - 0.02
    assert heights_mm.min() >= -0.02


def test_from_the_paper_and_to_it_the_pen_goes_straight_up_and_down() -> None:
    arm = load_arm("drawing_arm")
    goal = DOWN - np.radians([50.0, 0, 0, 0, 0])
    way = np.concatenate((DOWN[None], slow_transfer(arm, DOWN, goal, RATE_HZ)))
    tips = link_nodes_mm(arm, way)[:, -1]
    aside_mm = np.minimum(*(np.hypot(*(tips - link_nodes_mm(arm, end[None])[0, -1])[:, :2].T) for end in (DOWN, goal)))
    assert aside_mm[tips[:, 2] < arm.pen.clearance_mm].max() < 1e-3
    assert tips[:, 2].max() >= arm.pen.lift_mm - 1e-3
    np.testing.assert_array_equal(way[-1], goal)


def test_where_the_straight_way_would_dip_it_goes_up_first() -> None:
    arm = load_arm("three_joint")
    # Two configurations above the paper between which the straight way of the joints leads through it.
    rng = np.random.default_rng(3)
    dips = found = 0
    while dips < 5:
        ends = rng.uniform(arm.minimum, arm.maximum, (2, arm.n_joints))
        straight = ends[0] + np.linspace(0, 1, 50)[:, None] * (ends[1] - ends[0])
        heights_mm = link_nodes_mm(arm, straight)[:, :, 2]
        if heights_mm[[0, -1]].min() < 5 or heights_mm[:, -1].min() > -1:
            continue
        dips += 1
        try:
            points = slow_transfer(arm, ends[0], ends[1], RATE_HZ)
        except PlanError:
            continue
        found += 1
        assert link_nodes_mm(arm, points)[:, -1, 2].min() >= arm.pen.clearance_mm - 0.02
    assert found


def test_nowhere_to_go_is_no_set_points() -> None:
    arm = load_arm("drawing_arm")
    assert slow_transfer(arm, DOWN, DOWN, RATE_HZ).shape == (0, 5)


def test_no_way_is_an_error_that_names_both_ends() -> None:
    arm = load_arm("drawing_arm")
    # All links flat on the paper's far side: no lift helps, since the shoulder itself would have to be elsewhere.
    below = arm.complete(np.radians([0.0, 0.0, -150.0, -30.0]))
    up = np.concatenate((DOWN[None], lift(arm, DOWN, RATE_HZ)))[-1]
    with pytest.raises(PlanError, match=r"from \(q1 0.0 deg, .* to \(q1 25.0 deg"):
        slow_transfer(arm, below, up, RATE_HZ)
