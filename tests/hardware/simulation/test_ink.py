from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hardware.playback.program import make_program
from hardware.simulation.ink import drawn_lines, write_svg
from planner.arms.arm import Arm
from planner.checking.drawing_error import drawing_error
from planner.drawing.flatten import flatten_all
from planner.drawing.svg import read_drawing
from planner.trajectory import Trajectory


def test_a_line_for_every_time_that_the_pen_is_down(arm: Arm, sketch: Trajectory, tmp_path: Path) -> None:
    made = make_program(arm, arm.from_file_units(sketch.positions), sketch.stroke, sketch.rate_hz)
    lines = drawn_lines(arm, made.positions)
    assert len(lines) == 3
    for line in lines:
        np.testing.assert_allclose(np.hypot(*line.T), 100, atol=1e-3)
        assert line[:, 1].min() == pytest.approx(-100 * np.sin(np.radians(40)), abs=1e-3)
        assert line[:, 1].max() == pytest.approx(100 * np.sin(np.radians(40)), abs=1e-3)
    # Read again, the SVG is those lines at their true size, far side up, arm y to the left.
    target = tmp_path / "drawn.svg"
    write_svg(lines, target)
    drawing = read_drawing(target)
    seen = flatten_all(drawing.outlines, np.eye(2, 3), 0.001)
    assert len(seen) == 3
    for line, found in zip(lines, seen, strict=True):
        assert drawing_error([-found[:, ::-1]], [line]).largest_mm < 1e-3
    assert 'mm" height="' in target.read_text()


def test_a_pen_that_was_never_down_leaves_an_empty_page(arm: Arm, tmp_path: Path) -> None:
    up = np.radians([[0.0, 90.0, -60.0, -60.0, -60.0]])
    assert drawn_lines(arm, up) == []
    write_svg([], tmp_path / "drawn.svg")
    assert "polyline" not in (tmp_path / "drawn.svg").read_text()
