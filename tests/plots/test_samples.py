"""Laws of the derivatives, envelopes and pen-down spans that the pictures show."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.plots.samples import finite_difference, min_max_envelope, pen_down_spans


@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_difference_of_a_cubic_is_its_derivative_at_the_stated_time(order: int) -> None:
    rate_hz = 50.0
    cubic = np.polynomial.Polynomial([1.0, -2.0, 3.0, 0.5])
    t = np.arange(40) / rate_hz
    times_s, values = finite_difference(cubic(t)[:, np.newaxis], rate_hz, order)
    inside = slice(order, -order)
    # the second-order central error of a first difference of a cubic is its third derivative times h^2/24
    error = 3.0 / (24 * rate_hz**2) if order == 1 else 0.0
    np.testing.assert_allclose(values[inside, 0], cubic.deriv(order)(times_s[inside]) + error, atol=1e-8)


def test_a_difference_sees_a_start_that_is_not_at_rest() -> None:
    _, velocity = finite_difference(np.arange(5.0)[:, np.newaxis], 10.0, 1)
    assert velocity[:, 0].tolist() == [0.0, 10.0, 10.0, 10.0, 10.0, 0.0]
    _, acceleration = finite_difference(np.arange(5.0)[:, np.newaxis], 10.0, 2)
    assert acceleration[1, 0] == pytest.approx(100.0)


@given(st.lists(st.floats(-1, 1), min_size=2, max_size=60))
def test_no_limit_that_the_motion_keeps_is_shown_broken(jerks: list[float]) -> None:
    """Piecewise constant jerk within 1, integrated exactly, from rest and with the state left as it is."""
    state = np.zeros(3)
    positions = [0.0]
    reached = [state]
    h = 0.1
    for jerk in jerks:
        q, v, a = state
        state = np.array([q + v * h + a * h**2 / 2 + jerk * h**3 / 6, v + a * h + jerk * h**2 / 2, a + jerk * h])
        positions.append(state[0])
        reached.append(state)
    _, shown = finite_difference(np.array(positions)[:, np.newaxis], 1 / h, 3)
    assert np.abs(shown[:-3]).max() <= 1 + 1e-7
    _, acceleration = finite_difference(np.array(positions)[:, np.newaxis], 1 / h, 2)
    assert np.abs(acceleration[:-2]).max() <= np.abs(np.array(reached)[:, 2]).max() + 1e-7


@given(st.integers(1, 400), st.integers(1, 30), st.integers(0, 2**32 - 1))
def test_an_envelope_keeps_the_ends_and_every_extreme(n: int, n_bins: int, seed: int) -> None:
    values = np.random.default_rng(seed).normal(size=n)
    times_s = np.arange(n) / 7
    kept_s, kept = min_max_envelope(times_s, values, n_bins)
    assert len(kept) <= 2 * n_bins + 2
    assert (kept.min(), kept.max()) == (values.min(), values.max())
    assert (kept_s[0], kept_s[-1]) == (times_s[0], times_s[-1])
    assert np.all(np.diff(kept_s) > 0)
    np.testing.assert_array_equal(kept, values[np.rint(kept_s * 7).astype(int)])


def test_an_envelope_shows_a_peak_of_one_sample_where_it_is() -> None:
    values = np.zeros(100_000)
    values[61_803] = 5.0
    times_s, kept = min_max_envelope(np.arange(100_000) / 100, values, 50)
    assert times_s[kept == 5.0].tolist() == [618.03]
    assert len(kept) <= 102


@given(st.lists(st.booleans(), min_size=1, max_size=300), st.integers(1, 400))
def test_spans_account_for_all_the_time_that_the_pen_is_down(pen: list[bool], n_spans: int) -> None:
    spans = pen_down_spans(np.array(pen), 20.0, n_spans)
    assert len(spans) <= n_spans
    assert float(((spans[:, 1] - spans[:, 0]) * spans[:, 2]).sum()) == pytest.approx(sum(pen) / 20)
    assert np.all(spans[1:, 0] >= spans[:-1, 1] - 1e-12)
    assert np.all((spans[:, 2] > 0) & (spans[:, 2] <= 1))
    for start, end, share in spans:
        inside = pen[round(start * 20 + 0.5) : round(end * 20 + 0.5)]
        assert sum(inside) == pytest.approx(share * len(inside))
