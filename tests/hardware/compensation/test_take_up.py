"""Slack that is taken up: joints behind it follow what is planned, and no limit is broken."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.compensation.reversals import drive
from hardware.compensation.servo_values import own_calibration
from hardware.compensation.take_up import taken_up
from hardware.playback.compensated import compensated, led
from hardware.playback.program import Program
from planner.arms.accuracy import Accuracy
from planner.arms.arm_file import load_arm
from planner.arms.slack import half_slack, leads_s
from planner.arrays import FloatArray

PERIOD_S = 0.01
REST = 60
MAX_VELOCITY, MAX_ACCELERATION = 7.0, 90.0


def planned(turns: list[float], seconds: list[float]) -> FloatArray:
    """(n,) a joint that goes from one angle to the next, from rest to rest, and rests before and after."""
    ways = [np.full(REST, turns[0])]
    for begin, end, duration_s in zip(turns[:-1], turns[1:], seconds, strict=False):
        u = np.arange(1, round(duration_s / PERIOD_S) + 1) / round(duration_s / PERIOD_S)
        ways.append(begin + (end - begin) * u**3 * (10 - 15 * u + 6 * u**2))
    return np.concatenate([*ways, np.full(REST, turns[-1])])


def followed(told: FloatArray, slack: float, start: float) -> FloatArray:
    """(n,) where a joint with slack goes that stands at `start`."""
    stands, way = start, []
    for u in told:
        stands = min(max(stands, u - slack), u + slack)
        way.append(stands)
    return np.array(way)


def take_up(positions: FloatArray, slack: float) -> FloatArray:
    return taken_up(
        positions[:, None], np.array([slack]), np.array([MAX_VELOCITY]), np.array([MAX_ACCELERATION]), PERIOD_S, REST
    )[:, 0]


courses = st.lists(st.floats(-1.0, 1.0), min_size=2, max_size=8)
durations = st.lists(st.floats(0.4, 1.2), min_size=8, max_size=8)
slacks = st.floats(0.002, 0.05)


@settings(max_examples=60, deadline=None)
@given(turns=courses, seconds=durations, slack=slacks, where=st.floats(-1.0, 1.0))
def test_a_joint_with_slack_goes_where_it_is_meant_to_but_about_its_turns(
    turns: list[float], seconds: list[float], slack: float, where: float
) -> None:
    positions = planned(turns, seconds)
    joint = followed(take_up(positions, slack), slack, positions[0] + where * slack)
    off = np.abs(joint - positions)[REST:]
    assert off.max() <= 2 * slack + 1e-9
    moves = [abs(b - a) for a, b in itertools.pairwise(turns)]
    if min(moves) > 8 * slack:  # or turns follow each other too quickly
        assert np.quantile(off, 0.5) < 0.02 * slack + 1e-9


@settings(max_examples=60, deadline=None)
@given(turns=courses, seconds=durations, slack=slacks)
def test_limits_hold_where_they_held_before(turns: list[float], seconds: list[float], slack: float) -> None:
    positions = planned(turns, seconds)
    told = take_up(positions, slack)
    for order, limit in ((1, MAX_VELOCITY), (2, MAX_ACCELERATION)):
        before, after = (np.abs(np.diff(way, order)).max() / PERIOD_S**order for way in (positions, told))
        assert after <= max(limit, before) * (1 + 1e-6)
    assert told[0] == positions[0]
    assert told[-1] == pytest.approx(positions[-1], abs=1e-9)


def test_turning_back_by_next_to_nothing_is_no_turn() -> None:
    positions = np.array([0.0, 1.0, 0.99, 2.0, 1.0, 1.01, 0.0])
    course = drive(positions, least=0.1)
    assert course.begins.tolist() == [0, 3]
    assert course.way.tolist() == [1, -1]
    assert len(drive(np.zeros(5), 0.1).begins) == 0


def test_leading_keeps_the_last_and_is_straight_between_rows() -> None:
    np.testing.assert_allclose(led(np.arange(5.0)[:, None], np.array([1.5]))[:, 0], [1.5, 2.5, 3.5, 4.0, 4.0])


def program(positions: FloatArray) -> Program:
    n = len(positions)
    return Program(positions, np.zeros(n, dtype=np.int64), np.arange(n, dtype=float), 100.0, 0, 0)


def test_a_programme_is_led_and_kept_within_what_servos_may_be_told() -> None:
    arm = replace(load_arm("drawing_arm"), accuracy=Accuracy(49, 0.1, 0.1, (0.001,) * 5))
    low = arm.minimum[0]
    positions = np.tile(arm.from_file_units([0.0, 90.0, -90.0, 0.0, -90.0]), (400, 1))
    positions[:, 0] = low + 0.3 * (1 + np.cos(np.linspace(0, 4 * np.pi, 400)))  # to its limit and back, twice
    calibration = own_calibration(arm)
    made = compensated(arm, program(positions), calibration)
    calibration.to_servos(made.positions)  # refuses what is outside
    assert len(made.positions) == len(made.meant) == len(made.stroke)
    rest = made.approach
    assert rest == made.retreat
    np.testing.assert_array_equal(made.meant[rest:-rest], positions)
    assert (made.stroke[:rest] == -1).all()
    assert (made.positions[0] == positions[0]).all()
    np.testing.assert_allclose(made.positions[-1], positions[-1], atol=1e-12)
    # Half-way up, the servo is told to be where the joint is to be its delay and half a set point later, and its slack
    # further.
    k = rest + 150
    lead = 100 * leads_s(arm, 0.01)[0]
    assert lead == pytest.approx(100 * 0.03 + 0.5)
    assert made.positions[k, 0] == pytest.approx(
        np.interp(k + lead, np.arange(len(made.meant)), made.meant[:, 0]) + half_slack(arm)[0], abs=1e-9
    )


def test_an_arm_that_nobody_calibrated_is_sent_where_it_is_meant_to_go() -> None:
    arm = load_arm("drawing_arm")
    plan = program(np.zeros((10, arm.n_joints)))
    assert compensated(arm, plan, own_calibration(arm)) is plan
