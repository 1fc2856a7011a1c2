"""Pen-up moves: from contact to contact, at rest there, straight up and down near the paper, within all limits."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.kinematics.limits import Limits
from planner.kinematics.quickest_lift import quickest_lifts
from planner.motion.timed_stroke import Contact
from planner.travel.ruckig_profile import between_states, rest_to_rest
from planner.travel.travel_moves import TravelMove, TravelRules, plan_travel_moves
from tests.arms.chains import DRAWING_ARMS, kinematics_of, load_once, model_of, tips_by_product
from tests.timing.rig import share_of_limits

CLEARANCE_MM, LIFT_MM = 1.0, 5.0
PLACES = {
    "drawing_arm": np.array(
        [[60.0, -50.0], [110.0, 40.0], [110.3, 40.1], [40.0, 0.0], [130.0, 5.0], [130.0, 5.0], [70.0, 80.0]]
    ),
    "drawing_arm_2022": np.array(
        [[90.0, -40.0], [110.0, 10.0], [110.3, 10.1], [80.0, 0.0], [120.0, 5.0], [120.0, 5.0], [90.0, 20.0]]
    ),
}


def contacts(arm: Arm, tips_mm: FloatArray) -> list[Contact]:
    independent, good = (
        model_of(arm).configuration_map().configurations_at(np.column_stack((tips_mm, np.zeros(len(tips_mm)))))
    )
    assert good.all()
    return [Contact(tip, configuration) for tip, configuration in zip(tips_mm, independent, strict=True)]


def rules(rate_hz: float = 100.0, lift_mm: float = LIFT_MM, lowering_mm_s: float = 30.0) -> TravelRules:
    return TravelRules(CLEARANCE_MM, lift_mm, lowering_mm_s, rate_hz, 0.05)


def move(arm: Arm, start: Contact | None, end: Contact | None, how: TravelRules) -> TravelMove:
    return plan_travel_moves(kinematics_of(arm), Limits.of(arm), how, [start], [end])[0]


@lru_cache
def travel_moves_of(name: str) -> tuple[Arm, list[Contact], list[TravelMove]]:
    """From the lift height over all places and up again."""
    arm = load_once(name)
    on_paper = contacts(arm, PLACES[name])
    return (
        arm,
        on_paper,
        plan_travel_moves(kinematics_of(arm), Limits.of(arm), rules(), [None, *on_paper], [*on_paper, None]),
    )


@pytest.fixture(params=DRAWING_ARMS)
def flight(request: pytest.FixtureRequest) -> tuple[Arm, list[Contact], list[TravelMove]]:
    return travel_moves_of(request.param)


def test_travel_moves_begin_and_end_exactly_at_the_contacts(
    flight: tuple[Arm, list[Contact], list[TravelMove]],
) -> None:
    arm, on_paper, moves = flight
    assert all(move.exact for move in moves)
    for index, contact in enumerate(on_paper):
        for joints in (moves[index].joints[-1], moves[index + 1].joints[0]):
            np.testing.assert_allclose(joints, arm.complete(contact.configuration), atol=1e-9)
    for joints, contact in ((moves[0].joints[0], on_paper[0]), (moves[-1].joints[-1], on_paper[-1])):
        np.testing.assert_allclose(tips_by_product(arm, joints[None])[0], [*contact.tip_mm, LIFT_MM], atol=1e-6)


def test_the_tip_goes_straight_up_and_down_near_the_paper(flight: tuple[Arm, list[Contact], list[TravelMove]]) -> None:
    arm, on_paper, moves = flight
    for before, after, move in zip([None, *on_paper], [*on_paper, None], moves, strict=True):
        tips = tips_by_product(arm, move.joints)
        assert tips[:, 2].min() >= -1e-6 and tips[:, 2].max() <= LIFT_MM + 1e-6
        top = int(np.argmax(tips[:, 2]))
        assert tips[top, 2] > CLEARANCE_MM
        low = np.flatnonzero(tips[:, 2] < CLEARANCE_MM)
        for contact, part in ((before, low[low < top]), (after, low[low > top])):
            assert (len(part) > 0) == (contact is not None)
            if contact is not None:
                assert np.abs(tips[part, :2] - contact.tip_mm).max() < 0.01


def test_limits_hold_and_travel_moves_begin_and_end_at_rest(
    flight: tuple[Arm, list[Contact], list[TravelMove]],
) -> None:
    """With the samples before and after held, as on the paper: a start that is not at rest shows as a jolt."""
    arm, _, moves = flight
    for move in moves:
        held = np.concatenate((move.joints[:1],) * 3 + (move.joints,) + (move.joints[-1:],) * 3)
        assert (share_of_limits(held, 0.01, Limits.of(arm)) <= 1.001).all()
        assert (move.joints >= arm.minimum - 1e-9).all() and (move.joints <= arm.maximum + 1e-9).all()


def test_limits_hold_at_ten_times_the_samples() -> None:
    arm = load_once("drawing_arm")
    on_paper = contacts(arm, PLACES["drawing_arm"][:3])
    for start, end in pairwise(on_paper):
        samples = move(arm, start, end, rules(1000.0)).joints
        assert (share_of_limits(samples, 0.001, Limits.of(arm)) <= 1.002).all()


def test_a_travel_move_takes_the_same_time_whatever_the_rate_of_samples() -> None:
    arm = load_once("drawing_arm")
    first, second = contacts(arm, PLACES["drawing_arm"][:2])
    times = [(len(move(arm, first, second, rules(rate)).joints) - 1) / rate for rate in (100.0, 500.0, 2000.0)]
    assert max(times) - min(times) < 0.012


def test_a_hop_on_the_spot_goes_up_and_down_only() -> None:
    arm = load_once("drawing_arm")
    (contact,) = contacts(arm, np.array([[100.0, 20.0]]))
    tips = tips_by_product(arm, move(arm, contact, contact, rules()).joints)
    assert np.abs(tips[:, :2] - contact.tip_mm).max() < 1e-6
    assert CLEARANCE_MM < tips[:, 2].max() < LIFT_MM


def test_lowering_keeps_to_its_speed() -> None:
    arm = load_once("drawing_arm")
    (contact,) = contacts(arm, np.array([[100.0, 20.0]]))
    slow, fast = (
        tips_by_product(arm, move(arm, None, contact, rules(lowering_mm_s=speed)).joints)[:, 2]
        for speed in (10.0, 60.0)
    )
    assert np.diff(slow).min() >= -0.1 * 1.001 and len(slow) > len(fast)


def test_a_lift_as_high_as_the_clearance_is_enough() -> None:
    arm = load_once("drawing_arm")
    one, other = contacts(arm, PLACES["drawing_arm"][:2])
    low = move(arm, one, other, rules(lift_mm=CLEARANCE_MM))
    tips = tips_by_product(arm, low.joints)
    assert low.exact and tips[:, 2].max() <= CLEARANCE_MM + 1e-6
    away = np.minimum(*(np.hypot(*(tips[:, :2] - contact.tip_mm).T) for contact in (one, other)))
    assert tips[away > 0.01, 2].min() > CLEARANCE_MM - 1e-6


def test_a_travel_move_does_not_depend_on_the_others() -> None:
    arm, on_paper, moves = travel_moves_of("drawing_arm")
    for index in (0, 2, 5):
        alone = move(arm, on_paper[index - 1] if index else None, on_paper[index], rules())
        np.testing.assert_allclose(alone.joints, moves[index].joints, atol=1e-12)


def test_short_travel_moves_come_near_the_bound_of_their_parts() -> None:
    """No travel move is sooner up than by jerk alone, sooner down than by the cap, or sooner over than at full jerk: a
    travel move that rested at its top, or gave each motion a fixed share, would take a quarter longer than these
    together."""
    arm, limits = load_once("drawing_arm"), Limits.of(load_once("drawing_arm"))
    one, other = contacts(arm, np.array([[110.0, 0.0], [110.0, 1.0]]))
    made = move(arm, one, other, rules(1000.0))
    lift = np.abs(
        arm.complete(quickest_lifts(kinematics_of(arm), limits.jerk, one.configuration[None])[0])
        - arm.complete(np.zeros(len(one.configuration)))
    )
    up_s = np.cbrt(6 * CLEARANCE_MM * (lift / limits.jerk).max())
    down_s = CLEARANCE_MM / 30.0
    over_s = np.cbrt(
        32
        * (
            np.abs(arm.complete(other.configuration - one.configuration) - arm.complete(0 * one.configuration))
            / limits.jerk
        ).max()
    )
    total = (len(made.joints) - 1) / 1000.0
    assert up_s + down_s + over_s <= total <= 1.25 * (up_s + down_s + over_s)


@pytest.mark.parametrize("name", DRAWING_ARMS)
def test_the_quickest_lift_goes_straight_up_and_no_other_way_is_quicker(name: str) -> None:
    arm = load_once(name)
    kinematics, jerk = kinematics_of(arm), Limits.of(arm).jerk
    configurations = np.stack([contact.configuration for contact in contacts(arm, PLACES[name])])
    lifts = quickest_lifts(kinematics, jerk, configurations)
    task, jacobian = kinematics.task_and_jacobian(configurations)
    moved = np.einsum("nij,nj->ni", jacobian, lifts)
    np.testing.assert_allclose(moved[:, :3], [[0.0, 0.0, 1.0]] * len(lifts), atol=1e-9)
    matrix = arm.coupling_matrix[0]
    null = np.linalg.svd(jacobian)[2][:, task.shape[1] :]

    def slowness(moves: FloatArray) -> FloatArray:
        worst: FloatArray = np.abs(moves @ matrix.T / jerk).max(axis=1)
        return worst

    for step in (-0.1, -1e-3, 1e-3, 0.1):
        for direction in range(null.shape[1]):
            other = lifts + step * np.abs(lifts).max() * null[:, direction]
            assert (slowness(lifts) <= slowness(other) * (1 + 1e-3)).all()


@settings(deadline=None, max_examples=50)
@given(st.floats(1.0, 100.0), st.floats(0.0, 1.0), st.floats(1.0, 30.0), st.floats(1e3, 1e6), st.floats(0.0, 1.0))
def test_moves_between_states_join_them_within_limits(
    up: float, braking: float, down: float, jerk: float, least_s: float
) -> None:
    start = (up, -braking * np.sqrt(2 * jerk * up))
    assume(abs(up - down) > 1e-3 * up or abs(start[1]) > 1e-3)  # ends that mirror each other are refused, see below
    move = between_states(1.0, start, (-down, 0.0), -30.001, (500.0, 1e4 + abs(start[1]), jerk), least_s)
    assert move.duration_s >= least_s - 1e-9
    np.testing.assert_allclose(move.at(np.array([0.0, move.duration_s])), 1.0, atol=1e-6)
    np.testing.assert_allclose(move.state_at(0.0), start, rtol=1e-9)
    np.testing.assert_allclose(move.state_at(move.duration_s)[0], -down, rtol=1e-4, atol=1e-4)
    assert move.lowest_velocity >= -30.002


@settings(deadline=None, max_examples=50)
@given(st.floats(0.0, 200.0), st.floats(1.0, 500.0), st.floats(10.0, 1e4), st.floats(100.0, 1e6))
def test_moves_from_rest_to_rest_keep_their_limits(
    distance: float, velocity: float, acceleration: float, jerk: float
) -> None:
    move = rest_to_rest(distance, velocity, acceleration, jerk)
    times = np.linspace(0.0, move.duration_s, 400)
    positions = move.at(times)
    scale = max(distance, 1e-9)
    near = max(1e-9 * scale, 1e-15)  # a move of rounding's length takes no time at all
    np.testing.assert_allclose(positions[[0, -1]], [0.0, distance], atol=near)
    np.testing.assert_allclose(move.at(np.array([-1.0, move.duration_s + 1.0])), [0.0, distance], atol=near)
    period = max(move.duration_s / 399, 1e-9)
    for order, limit in enumerate((velocity, acceleration, jerk), 1):
        noise = 1e-12 * scale * 2**order / period**order
        assert np.abs(np.diff(positions, order)).max() / period**order <= limit * (1 + 1e-6) + noise
    if distance > 1e-6:
        middle = move.time_at(distance / 2)
        np.testing.assert_allclose(move.at(np.array([middle]))[0], distance / 2, rtol=1e-6)
        np.testing.assert_allclose(middle, move.duration_s / 2, rtol=1e-6)  # there and back are alike


def _whole_s(arm: Arm, how: TravelRules) -> float:
    on_paper = contacts(arm, PLACES[arm.name])
    made = plan_travel_moves(kinematics_of(arm), Limits.of(arm), how, on_paper[:-1], on_paper[1:])
    return sum(len(one.joints) - 1 for one in made) / how.rate_hz


def _on_the_spot_s(arm: Arm) -> list[float]:
    """By the speed of lowering: a hop that goes nowhere has no motion over the paper to wait for."""
    (contact,) = contacts(arm, PLACES[arm.name][:1])
    return [
        len(move(arm, contact, contact, rules(1000.0, lowering_mm_s=speed)).joints)
        for speed in (10.0, 30.0, 90.0, 300.0)
    ]


@pytest.mark.parametrize("name", DRAWING_ARMS)
def test_laxer_rules_make_no_slower_travel_moves(name: str) -> None:
    arm = load_once(name)
    by_speed = [_whole_s(arm, rules(lowering_mm_s=speed)) for speed in (5.0, 10.0, 20.0, 30.0, 50.0, 80.0, 200.0)]
    by_clearance = [
        _whole_s(arm, TravelRules(clearance, LIFT_MM, 30.0, 100.0, 0.05))
        for clearance in (2.0, 1.0, 0.7, 0.5, 0.35, 0.25, 0.1)
    ]
    by_lift = [_whole_s(arm, rules(lift_mm=lift)) for lift in (1.5, 2.0, 3.0, 5.0, 8.0, 15.0)]
    by_tolerance = [
        _whole_s(arm, TravelRules(CLEARANCE_MM, LIFT_MM, 30.0, 100.0, tolerance))
        for tolerance in (0.005, 0.01, 0.05, 0.2, 1.0)
    ]
    for times in (by_speed, by_clearance, by_lift, by_tolerance, _on_the_spot_s(arm)):
        assert times == sorted(times, reverse=True)


def _relaxed(arm: Arm, data: st.DataObject) -> Limits:
    limits = Limits.of(arm)
    factors = st.lists(st.sampled_from([1.0, 1.0, 1.1, 2.0, 5.0]), min_size=arm.n_joints, max_size=arm.n_joints)
    return Limits(
        *(limit * np.array(data.draw(factors)) for limit in (limits.velocity, limits.acceleration, limits.jerk))
    )


@lru_cache
def _usual_samples(name: str, rate_hz: float) -> list[int]:
    arm = load_once(name)
    return _samples(arm, Limits.of(arm), rate_hz)


def _samples(arm: Arm, limits: Limits, rate_hz: float) -> list[int]:
    """How many sample periods travel moves over all places last."""
    on_paper = contacts(arm, PLACES[arm.name])
    made = plan_travel_moves(kinematics_of(arm), limits, rules(rate_hz), on_paper[:-1], on_paper[1:])
    return [len(one.joints) - 1 for one in made]


@pytest.mark.parametrize("name", DRAWING_ARMS)
@settings(deadline=None, max_examples=12)
@given(data=st.data())
def test_no_limit_of_a_joint_that_is_relaxed_costs_time(name: str, data: st.DataObject) -> None:
    """Across the whole paper up to two percent are left: formulas take joints to follow their slopes, and where those
    change on the way, more acceleration asks for more jerk, which slows the whole of the move."""
    arm = load_once(name)
    after = sum(_samples(arm, _relaxed(arm, data), 1000.0))
    assert after <= sum(_usual_samples(name, 1000.0)) * 1.02


@pytest.mark.parametrize("name", DRAWING_ARMS)
@settings(deadline=None, max_examples=12)
@given(data=st.data())
def test_nor_does_it_where_servos_take_few_samples(name: str, data: st.DataObject) -> None:
    """A quicker pen goes further between two samples, and is held back there: never by more than rounding each move to
    whole samples takes."""
    arm = load_once(name)
    before, after = _usual_samples(name, 50.0), _samples(arm, _relaxed(arm, data), 50.0)
    assert sum(after) <= sum(before) + len(before)


def test_more_jerk_costs_no_time_over_many_moves_where_servos_take_few_samples() -> None:
    """Moves of millimetres and centimetres, some a sample longer and more of them shorter."""
    arm = load_once("drawing_arm")
    random = np.random.default_rng(0)
    starts = random.uniform([55.0, -50.0], [105.0, 50.0], (30, 2))
    ways = random.normal(size=(30, 2)) * 10.0 ** random.uniform(-0.5, 1.0, (30, 1))
    start, end = (contacts(arm, places) for places in (starts, np.clip(starts + ways, [50.0, -60.0], [112.0, 60.0])))

    def lasting(jerk: float) -> IntArray:
        limits = replace(Limits.of(arm), jerk=jerk * Limits.of(arm).jerk)
        moves = plan_travel_moves(kinematics_of(arm), limits, rules(50.0), start, end)
        return np.array([len(one.joints) - 1 for one in moves])

    before, after = lasting(1.0), lasting(5.0)
    assert after.sum() <= before.sum() and (after <= before + 1).all()


@pytest.mark.parametrize("name", DRAWING_ARMS)
def test_one_limit_of_all_joints_that_is_relaxed_makes_no_travel_move_slower(name: str) -> None:
    """Short ones, as there are most of in a drawing: at a thousand samples a second by two of them at most, for what
    formulas only rank."""
    arm = load_once(name)
    limits = Limits.of(arm)
    middle = contacts(arm, PLACES[name][1:2] + np.array([[0.0, 0.0], [0.2, 0.2], [0.9, -0.4], [-1.1, 1.6], [2.0, 3.0]]))

    def lasting(limits: Limits) -> IntArray:
        moves = plan_travel_moves(kinematics_of(arm), limits, rules(1000.0), middle[:-1], middle[1:])
        return np.array([len(one.joints) - 1 for one in moves])

    before = lasting(limits)
    for key in ("velocity", "acceleration", "jerk"):
        for factor in (1.01, 1.2, 2.0, 5.0):
            laxer = replace(limits, **{key: factor * getattr(limits, key)})
            assert (lasting(laxer) <= before + 2).all()


def test_a_way_that_gets_quicker_makes_no_short_move_slower() -> None:
    """The first joint takes the pen over the paper, and nothing waits for it: once a rise that no fall follows was
    chosen there, and a travel move took a quarter longer."""
    arm = load_once("drawing_arm")
    limits = Limits.of(arm)
    on_paper = contacts(arm, np.array([[86.06, 73.56], [86.26, 73.32]]))
    quicker = replace(limits, jerk=limits.jerk * np.array([5.0, 1.0, 1.0, 1.0, 2.0]))
    before, after = (
        len(plan_travel_moves(kinematics_of(arm), each, rules(2000.0), on_paper[:1], on_paper[1:])[0].joints)
        for each in (limits, quicker)
    )
    assert after <= before


@pytest.mark.parametrize("name", DRAWING_ARMS)
def test_the_choice_is_near_the_best_of_a_dense_search(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    arm = load_once(name)
    chosen = _whole_s(arm, rules(1000.0))
    for key, value in (("_N_RISES", 24), ("_N_FALLS", 12), ("_SHARES", np.linspace(0.1, 1.0, 31))):
        monkeypatch.setattr(f"planner.travel.travel_choice.{key}", value)
    for key, wide in (("_TRIED", 500), ("_ABOUT", (0.9, 0.95, 1.0, 1.05, 1.1))):
        monkeypatch.setattr(f"planner.travel.travel_moves.{key}", wide)
    assert chosen <= _whole_s(arm, rules(1000.0)) * 1.02
