"""What servos see of a path that they take some samples of."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner import check
from planner.arms.arm_file import load_arm
from planner.as_servos_see import cut_corners_mm, samples_a_set_point
from planner.cli import main
from planner.trajectory import Trajectory
from tests.drawn_shapes import lines_svg

_TURNS = np.linspace(0.0, 6.0 * np.pi, 200)
_FLOWER = 30.0 + 14.0 * np.column_stack(
    (np.cos(_TURNS) + np.cos(11.0 / 3.0 * _TURNS), np.sin(_TURNS) - np.sin(11.0 / 3.0 * _TURNS))
)
CURVES = lines_svg(
    f'<path d="M{" L".join(f"{x:.2f} {y:.2f}" for x, y in _FLOWER.tolist())} Z"/><circle cx="30" cy="30" r="9"/>'
    '<path d="M2 58 q4 -8 8 0 t8 0 t8 0"/><path d="M40 58 L50 50 L58 58"/>',
    'viewBox="0 0 60 60"',
)
"""Smooth ones, which are drawn fast, and corners."""


@pytest.mark.parametrize("name", ["drawing_arm", "drawing_arm_2022", "so101"])
def test_what_servos_see_of_a_plan_keeps_its_promise(name: str, tmp_path: Path) -> None:
    """Nobody says a rate: the set points that the servos take, with straight lines between, draw the drawing."""
    drawing, path = tmp_path / "curves.svg", tmp_path / "traj.csv"
    drawing.write_text(CURVES)
    assert main([str(drawing), "--arm", name, "-o", str(path), "--quiet"]) == 0
    trajectory, period_s = Trajectory.load(path), load_arm(name).set_point_period_s
    assert period_s is not None
    every = round(period_s * trajectory.rate_hz)
    seen = replace(
        trajectory,
        rate_hz=1 / period_s,
        positions=trajectory.positions[::every],
        pen=trajectory.pen[::every],
        stroke=trajectory.stroke[::every],
        decimals=None if trajectory.decimals is None else trajectory.decimals[::every],
    )
    result = check(seen, drawing)
    assert result.passed, str(result)


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
