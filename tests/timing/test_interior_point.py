"""What makes the iteration good, rather than right: curvature that saves steps, and limits lowered where jerk peaks."""

from __future__ import annotations

import pytest

from planner.motion.stroke_motion import _slowing_needed
from planner.timing.path_timing import minimum_time
from tests.timing.rig import LIMITS, LINES, polar_paths, problem_of

ENOUGH = 28
"""Steps; the path that needs most takes 23, and 33 without the curvature of the jerk limits."""
FAINT = 0.005
"""A motion that has to be slowed by no more has no peaks to speak of: smoothest paths have hardly any."""


def test_few_steps_lead_to_the_least_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("planner.timing.path_timing._MOST_ITERATIONS", ENOUGH)
    assert minimum_time(problem_of(polar_paths(list(LINES.values())))).converged.all()


@pytest.mark.parametrize("name", LINES)
def test_lowered_limits_leave_less_than_half_of_the_peaks_between_points(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = polar_paths([LINES[name]])

    def over() -> float:
        """How much the motion has to be slowed, as jerk exceeds its limit between the points."""
        return float(_slowing_needed(paths, minimum_time(problem_of(paths)).rates, LIMITS).max()) - 1.0

    lowered = over()
    monkeypatch.setattr("planner.timing.lowered_limits._LOWERED_BY", 0.0)
    assert lowered < max(0.5 * over(), FAINT)
