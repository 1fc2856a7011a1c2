"""Where the solver does not get to the least time, a motion that keeps the limits is taken all the same, and said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.motion.stroke_motion import motions
from planner.pipeline import plan
from planner.settings import PlanSettings
from planner.timing import interior_point, newton_system, path_timing
from planner.timing.path_timing import minimum_time
from tests.drawn_shapes import lines_svg
from tests.timing.rig import LIMITS, LINES, joint_curve, polar_paths, problem_of, rate_curve, rates_by_formula
from tests.timing.test_path_timing import FINE_HZ, lines_made, steady_s

TWO_LINES = lines_svg(
    """<path d="M10 10 L60 12 L80 50"/><path d="M20 40 L40 55"/>""", 'width="100mm" height="60mm" viewBox="0 0 100 60"'
)


@settings(deadline=None, max_examples=12)
@given(lines_made, st.integers(0, 6))
def test_stopped_early_a_timing_keeps_the_limits_and_is_never_slower_than_a_steady_pace(
    line: FloatArray, iterations: int
) -> None:
    paths = polar_paths([line])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(path_timing, "_MOST_ITERATIONS", iterations)
        timing = minimum_time(problem_of(paths))
    assert not timing.converged.any()
    motion = motions(paths, timing.rates, LIMITS, FINE_HZ)
    assert motion.n_periods[0] / FINE_HZ <= steady_s(paths, LIMITS) * (1 + 1e-3)
    n_cells = int(paths.n_cells[0])
    within = (np.arange(n_cells)[:, None] + np.linspace(1e-9, 1 - 1e-9, 21)).ravel()
    rates = rates_by_formula(joint_curve(paths, 0), rate_curve(motion, 0), within)
    for rate, limit in zip(rates, (LIMITS.velocity, LIMITS.acceleration, LIMITS.jerk), strict=True):
        assert (np.abs(rate) / limit).max() <= 1 + 1e-6


@pytest.mark.parametrize("lost", range(len(LINES)))
def test_a_path_whose_newton_system_fails_leaves_the_others_as_they_were(
    lost: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = polar_paths(list(LINES.values()))
    problem = problem_of(paths)
    whole = minimum_time(problem)
    assert whole.converged.all()
    unknown = int((2 * paths.n_cells[:lost] + 2).sum()) + 3
    factorise, calls = newton_system.dpbtrf, iter([unknown])

    def fail_once(band: FloatArray, lower: int) -> tuple[FloatArray, int]:
        factor, info = factorise(band, lower=lower)
        return factor, next(calls, info)

    monkeypatch.setattr(newton_system, "dpbtrf", fail_once)
    timing = minimum_time(problem)
    assert timing.converged.tolist() == [index != lost for index in range(len(LINES))]
    others = np.repeat(timing.converged, paths.n_cells)
    np.testing.assert_allclose(timing.rates[others], whole.rates[others], rtol=1e-2, atol=1e-2 * whole.rates.max())
    assert np.isfinite(timing.rates).all()


def test_a_plan_counts_the_strokes_that_the_fallback_times(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawing = tmp_path / "two.svg"
    drawing.write_text(TWO_LINES)
    assert plan(drawing, PlanSettings(), lambda *_: None).summary.warnings == []
    monkeypatch.setattr(path_timing, "_MOST_ITERATIONS", 1)
    warnings = plan(drawing, PlanSettings(), lambda *_: None).summary.warnings
    assert warnings == ["timed by the fallback, slower than the least time: 2 strokes"]


def test_a_path_whose_steps_all_break_a_limit_is_left_where_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    """Never called near the least time, though the gap would close: multipliers alone move there."""
    paths = polar_paths([LINES["corner"]])
    best = minimum_time(problem_of(paths))
    monkeypatch.setattr(interior_point, "_KEPT_AT_LEAST", 1e9)
    timing = minimum_time(problem_of(paths))
    assert best.converged.all() and not timing.converged.any()
    motion = motions(paths, timing.rates, LIMITS, FINE_HZ)
    assert motion.n_periods[0] / FINE_HZ <= steady_s(paths, LIMITS) * (1 + 1e-3)
