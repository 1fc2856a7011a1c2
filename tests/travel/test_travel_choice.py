"""The formulas that rank travel moves, against Ruckig's moves and against a search through all of them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.kinematics.limits import Limits
from planner.travel.ruckig_profile import NoSuchMove, RestToRest, between_states, rest_to_rest
from planner.travel.travel_choice import (
    _AIMS,
    _N_FALLS,
    _N_RISES,
    _SHARES,
    Slopes,
    _brake,
    _rise,
    coordinate_limits,
    quickest_candidates,
    rest_of,
    rest_to_rest_s,
    turning_acceleration,
)

_AMPLE = 1e9
"""A limit that no move comes near."""
jerks = st.floats(1e3, 1e6)
heights = st.floats(0.5, 20.0)


def rise(top_mm: float, jerk: float, speed: float) -> RestToRest:
    turning = float(turning_acceleration(np.array(top_mm), np.array(jerk), speed))
    return rest_to_rest(top_mm, min(speed, _AMPLE), _AMPLE, jerk, turning * (1 - 1e-9))


@given(st.floats(1e-2, 1e3), st.floats(1e-1, 1e4), st.floats(1.0, 1e6))
def test_moves_from_rest_to_rest_last_as_long_as_ruckigs(velocity: float, acceleration: float, jerk: float) -> None:
    limits = Limits(*(np.array(limit) for limit in (velocity, acceleration, jerk)))
    wanted = rest_to_rest(1.0, velocity, acceleration, jerk).duration_s
    assert float(rest_to_rest_s(limits)) == pytest.approx(wanted, rel=2e-3)  # where jerk hardly counts, Ruckig has less


@given(heights, jerks, st.one_of(st.just(np.inf), st.floats(1.0, 200.0)), st.floats(1.02, 1.94))
def test_a_rise_passes_the_clearance_when_and_as_ruckigs_does(
    clearance_mm: float, jerk: float, speed: float, aim: float
) -> None:
    top = aim * clearance_mm
    time_s, velocity, acceleration = (
        float(value[0, 0]) for value in _rise(np.array([top]), clearance_mm, np.array([[jerk]]), speed)
    )
    wanted = rise(top, jerk, speed)
    assert time_s == pytest.approx(wanted.time_at(clearance_mm), rel=2e-3)
    at = wanted.state_at(wanted.time_at(clearance_mm))
    assert velocity == pytest.approx(at[0], rel=5e-3)
    assert acceleration == pytest.approx(at[1], rel=2e-2, abs=1e-3 * jerk * wanted.duration_s)


@given(heights, jerks)
def test_no_rise_to_a_turn_is_quicker_with_more_or_less_braking_left(top_mm: float, jerk: float) -> None:
    """The turn that the formulas choose is the quickest way to pass a height and come to no speed at the top."""
    turning = float(turning_acceleration(np.array(top_mm), np.array(jerk), np.inf))
    chosen = rest_to_rest(top_mm, _AMPLE, _AMPLE, jerk, turning * (1 - 1e-9)).duration_s
    for share in (0.0, 0.5, 0.9, 0.97):
        assert chosen <= rest_to_rest(top_mm, _AMPLE, _AMPLE, jerk, share * turning).duration_s * (1 + 1e-6)


@given(st.floats(0.1, 100.0), st.floats(0.0, 1.0), jerks)
def test_braking_ends_at_no_speed_where_its_jerk_leads(velocity: float, share: float, jerk: float) -> None:
    acceleration = -share * np.sqrt(2 * jerk * velocity)
    time_s, height_mm = (float(value) for value in _brake(*map(np.array, (velocity, acceleration, jerk))))
    # Its jerk is constant: so is the third derivative of the height.
    course = np.polynomial.Polynomial([0.0, velocity, acceleration / 2, -jerk / 6])
    assert time_s > 0
    assert float(course.deriv()(time_s)) == pytest.approx(0.0, abs=1e-6 * velocity)
    assert height_mm == pytest.approx(float(course(time_s)), rel=1e-6, abs=1e-12)


class Search:
    """What a travel move of one arm lasts by Ruckig's moves."""

    def __init__(self, seed: int) -> None:
        random = np.random.default_rng(seed)
        self.limits = Limits(np.array([3.0, 4.0, 5.0]), np.full(3, 1e6), np.array([400.0, 500.0, 300.0]))
        self.slopes = Slopes(*10.0 ** random.uniform(-3.0, -1.0, (3, 1, 3)))
        self.lift_mm, self.cap_mm_s = float(random.uniform(2.2, 8.0)), float(random.uniform(5.0, 60.0))
        self.up_jerk, self.down_jerk = (
            float(coordinate_limits(slope, self.limits).jerk[0])
            for slope in (self.slopes.lifting, self.slopes.lowering)
        )
        self.below, self.over_s = lru_cache(maxsize=None)(self._below), lru_cache(maxsize=None)(self._over_s)

    def _below(self, top_mm: float, handover_mm: float, jerk: float, speed: float) -> tuple[float, float, float]:
        made = rise(top_mm, jerk, speed)
        time_s = made.time_at(handover_mm)
        return (time_s, *made.state_at(time_s))

    def _over_s(self, share: float) -> float:
        rest = rest_of(self.slopes, self.limits, np.array([share]))
        one = coordinate_limits(self.slopes.along, rest)
        return rest_to_rest(1.0, *(float(limit[0]) for limit in (one.velocity, one.acceleration, one.jerk))).duration_s

    def seconds(
        self,
        share: float,
        handover_mm: float,
        rise_mm: float,
        fall_mm: float,
        speed: float,
        cap: float,
        allowed_mm: float = 0.0,
    ) -> float:
        """inf where there is no such travel move, by more than so many mm."""
        up = self.below(rise_mm, handover_mm, self.up_jerk, np.inf)
        down = self.below(fall_mm, handover_mm, self.down_jerk, speed)
        jerk = share * min(self.up_jerk, self.down_jerk)
        push = max(abs(up[2]), abs(down[2]))
        try:
            above = between_states(
                handover_mm, up[1:], (-down[1], down[2]), -cap * (1 + 1e-6), (_AMPLE, 10 * push, jerk), 0.0
            )
        except NoSuchMove:
            return np.inf
        heights = above.at(np.linspace(0.0, above.duration_s, 200))
        if heights.min() < handover_mm - allowed_mm or heights.max() > self.lift_mm + allowed_mm:
            return np.inf
        return up[0] + down[0] + max(self.over_s(share), above.duration_s)


@pytest.mark.parametrize("seed", range(5))
def test_the_quickest_are_those_of_a_search_through_all_of_them(seed: int) -> None:
    search = Search(seed)
    found = quickest_candidates(search.slopes, search.limits, 1.0, search.lift_mm, search.cap_mm_s)
    possible = int(np.isfinite(found.seconds).sum())
    assert possible and (np.diff(found.seconds[0, :possible]) >= 0).all()
    looked_at = range(0, possible, 7)
    made = 0
    for index in looked_at:
        share, handover_mm, rise_mm, fall_mm, speed, cap, told = (
            float(getattr(found, key)[0, index])
            for key in ("share", "handover_mm", "rise_mm", "fall_mm", "fall_mm_s", "cap_mm_s", "seconds")
        )
        seconds = search.seconds(share, handover_mm, rise_mm, fall_mm, speed, cap, 0.01 * handover_mm)
        assert told == pytest.approx(seconds, rel=1e-2) or seconds == np.inf
        made += seconds < np.inf
        assert speed <= cap <= search.cap_mm_s
    assert made >= 0.8 * len(looked_at)  # there are others that have to turn higher, or to brake in two goes
    best = min(
        search.seconds(share, 1.0, rise_mm, fall_mm, search.cap_mm_s, search.cap_mm_s)
        for share in _SHARES.tolist()
        for rise_mm in np.linspace(*_AIMS, _N_RISES).tolist()
        for fall_mm in np.linspace(*_AIMS, _N_FALLS).tolist()
    )
    assert float(found.seconds[0, 0]) <= best * 1.01


@given(st.lists(st.floats(1e-4, 1.0), min_size=3, max_size=3), st.floats(0.0, 1.0))
def test_height_and_move_share_the_limits_between_them(slope: list[float], share: float) -> None:
    limits = Limits(np.full(3, 3.0), np.full(3, 40.0), np.full(3, 500.0))
    slopes = Slopes(*(np.array([slope]) for _ in range(3)))
    rest = rest_of(slopes, limits, np.array([share]))
    height = coordinate_limits(slopes.lifting, limits)
    for key in ("acceleration", "jerk"):
        taken: FloatArray = share * np.array(slope) * float(getattr(height, key)[0])
        whole = taken + getattr(rest, key)[0]
        limit = getattr(limits, key)
        assert (whole <= limit * (1 + 2e-3)).all() and (whole >= limit * (1 - 1e-9)).all()
