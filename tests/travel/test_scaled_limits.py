"""Arms with limits of any proportion: whatever library finds no candidate, a plan comes out, and keeps its limits."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.kinematics.limits import Limits
from planner.motion.timed_stroke import Contact
from planner.travel.ruckig_profile import NoSuchMove, between_states, rest_to_rest
from planner.travel.travel_moves import TravelRules, plan_travel_moves
from tests.arms.chains import kinematics_of, load_once, model_of
from tests.timing.rig import share_of_limits

RATE_HZ = 100.0
ARMS = ["drawing_arm", "scara", "three_joint", "so101"]
decades = st.floats(-1.5, 2.5).map(lambda decade: 10.0**decade)


@lru_cache
def contacts_of(name: str) -> tuple[Contact, ...]:
    """Places about a centimetre and about five apart, in the middle of the arm's reach."""
    arm = load_once(name)
    configuration_map = model_of(arm).configuration_map()
    for radius in np.linspace(arm.workspace.inner_radius_mm + 10.0, 300.0, 25):
        tips = np.array([[radius, 0.0], [radius + 3.0, 9.0], [radius + 3.2, 9.0], [radius, -40.0]])
        independent, good = configuration_map.configurations_at(np.column_stack((tips, np.zeros(len(tips)))))
        if good.all():
            return tuple(Contact(tip, configuration) for tip, configuration in zip(tips, independent, strict=True))
    raise AssertionError(f"{name} reaches nothing in the middle")


def scaled(limits: Limits, factors: FloatArray) -> Limits:
    """factors: (3, n_joints) for velocity, acceleration and jerk."""
    return Limits(limits.velocity * factors[0], limits.acceleration * factors[1], limits.jerk * factors[2])


def assert_travel_moves_within(arm: Arm, limits: Limits, contacts: tuple[Contact, ...]) -> None:
    moves = plan_travel_moves(
        kinematics_of(arm), limits, TravelRules(1.0, 5.0, 30.0, RATE_HZ, 0.05), [None, *contacts], [*contacts, None]
    )
    for move in moves:
        assert move.held or not move.exact  # a joint may leave its range where its neighbours are slow: that is told
        held = np.concatenate((move.joints[:1],) * 3 + (move.joints,) + (move.joints[-1:],) * 3)
        assert (share_of_limits(held, 1 / RATE_HZ, limits) <= 1.002).all()


@pytest.mark.parametrize("name", ARMS)
@settings(deadline=None, max_examples=6)
@given(data=st.data())
def test_hops_are_found_whatever_the_proportion_of_the_limits(name: str, data: st.DataObject) -> None:
    arm = load_once(name)
    count = 3 * arm.n_joints
    factors = np.array(data.draw(st.lists(decades, min_size=count, max_size=count))).reshape(3, arm.n_joints)
    assert_travel_moves_within(arm, scaled(Limits.of(arm), factors), contacts_of(name))


@pytest.mark.parametrize(
    ("name", "key", "joint", "value"),
    [("drawing_arm", "max_jerk", slice(None), np.radians(2.5e6)), ("three_joint", "max_acceleration", 1, 1.0)],
)
def test_one_limit_out_of_proportion_costs_candidates_alone(
    name: str, key: str, joint: int | slice, value: float
) -> None:
    arm = load_once(name)
    limits = Limits.of(arm)
    changed = getattr(limits, key.removeprefix("max_")).copy()
    changed[joint] = value
    assert_travel_moves_within(arm, replace(limits, **{key.removeprefix("max_"): changed}), contacts_of(name))


def test_ends_that_mirror_each_other_are_refused_and_do_not_crash() -> None:
    with pytest.raises(NoSuchMove):
        between_states(
            2.0,
            (19.45455588507448, -4426.552177067475),
            (-19.45455588507448, -4426.552177067475),
            -200.0,
            (902.0, 11278.0, 90228.86105757494),
            0.0,
        )


@settings(deadline=None, max_examples=100)
@given(st.lists(st.floats(-8.0, 8.0), min_size=4, max_size=4))
def test_there_is_a_move_from_rest_to_rest_within_any_limits(exponents: list[float]) -> None:
    distance, *limits = (10.0**exponent for exponent in exponents)
    move = rest_to_rest(distance, *limits)
    states = np.array(move.states)
    assert (np.abs(states[:, 1:]).max(axis=0) <= np.array(limits) * (1 + 1e-6)).all()
    assert states[-1, 0] == pytest.approx(distance, rel=1e-6)
    assert (np.diff(move.at(np.linspace(0.0, move.duration_s, 50))) >= -1e-6 * distance).all()
