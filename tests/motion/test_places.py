"""Where a stroke is at each sample: by Newton's method, and by bisection where that does not get there."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.motion import stroke_motion
from planner.timing.path_timing import minimum_time
from tests.timing.rig import LIMITS, LINES, polar_paths, problem_of

rates = st.lists(
    st.tuples(st.floats(0.05, 20.0), st.floats(0.05, 20.0), st.floats(0.05, 20.0), st.floats(0.05, 20.0)),
    min_size=1,
    max_size=8,
).map(np.array)


def cubics(bernstein: FloatArray) -> FloatArray:
    """(n, 4) powers of the cubics with these control values: positive where they are."""
    p0, p1, p2, p3 = bernstein.T
    return np.column_stack((p0, 3 * (p1 - p0), 3 * (p2 - 2 * p1 + p0), p3 - 3 * p2 + 3 * p1 - p0))


@settings(deadline=None)
@given(rates, st.floats(0.0, 1.0), st.sampled_from([0, 1, 8]))
def test_the_fraction_after_a_time_takes_that_time(controls: FloatArray, share: float, newton_rounds: int) -> None:
    b = cubics(controls)
    cell_s = stroke_motion._until(b, np.ones(len(b)))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stroke_motion, "_NEWTON_ROUNDS", newton_rounds)
        fraction = stroke_motion._fraction_after(b, share * cell_s, cell_s)
    np.testing.assert_allclose(stroke_motion._until(b, fraction), share * cell_s, rtol=1e-9, atol=1e-12)


def test_samples_by_bisection_are_those_by_newton_s_method(monkeypatch: pytest.MonkeyPatch) -> None:
    paths = polar_paths(list(LINES.values()))
    motion = stroke_motion.motions(paths, minimum_time(problem_of(paths)).rates, LIMITS, 100.0)
    quick = motion.samples()
    monkeypatch.setattr(stroke_motion, "_NEWTON_ROUNDS", 0)
    for one, other in zip(quick, motion.samples(), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)
