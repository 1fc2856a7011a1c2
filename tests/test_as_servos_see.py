"""What servos see of a path that they take some samples of."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from planner.as_servos_see import cut_corners_mm, samples_a_set_point


@given(st.integers(2, 8), st.floats(1.0, 100.0), st.floats(0.001, 0.05))
def test_a_circle_is_cut_by_its_sagitta(every: int, radius_mm: float, step_rad: float) -> None:
    angle = step_rad * np.arange(100)
    tip_mm = radius_mm * np.stack((np.cos(angle), np.sin(angle), np.zeros(100)), axis=1)
    down = np.ones(100, dtype=np.bool_)
    most = radius_mm * (1 - np.cos(every * step_rad / 2))
    cut_mm, _ = cut_corners_mm(tip_mm, down, every)
    assert cut_mm <= most * (1 + 1e-6)
    if every % 2 == 0:
        assert cut_mm >= most * (1 - 1e-6)
    assert cut_corners_mm(tip_mm, ~down, every) == (0.0, 0)
    assert cut_corners_mm(tip_mm, down, 1) == (0.0, 0)


def test_how_many_samples_servos_pass_over() -> None:
    assert samples_a_set_point(100.0, None) == 1
    assert samples_a_set_point(100.0, 0.02) == 2
    assert samples_a_set_point(50.0, 0.02) == 1
    assert samples_a_set_point(250.0, 0.02) == 5
    assert samples_a_set_point(120.0, 0.02) == 3
