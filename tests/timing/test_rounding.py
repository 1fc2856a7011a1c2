"""Limits at rates at which rounding and peaks between checks are seen: they hold, and no defect is claimed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from planner.checking.check import check_trajectory
from planner.kinematics.limits import Limits
from planner.pipeline import plan
from planner.settings import PlanSettings
from tests.arms.chains import load_once
from tests.drawn_shapes import polyline, svg_of


@pytest.mark.parametrize("rate_hz", [5000.0, 10_000.0])
def test_a_plan_at_a_high_rate_keeps_its_limits(tmp_path: Path, rate_hz: float) -> None:
    drawing = tmp_path / "corner.svg"
    drawing.write_text(svg_of([polyline((2, 2), (20, 25), (38, 4))], 'viewBox="0 0 40 30"'))
    made = plan(drawing, PlanSettings(rate_hz=rate_hz), lambda *_: None)
    assert check_trajectory(made.trajectory, load_once("drawing_arm"), made.drawing).passed


def test_rounding_is_allowed_and_no_more() -> None:
    rate_hz = 10_000.0
    limits = Limits(np.array([1.0]), np.array([10.0]), np.array([100.0]))
    at_limit = 100.0 * (np.arange(400) / rate_hz) ** 3 / 6 + 2.0
    rounded = np.round(at_limit, 12)[:, None]
    off = np.full(1, 0.5e-12 + 4 * np.finfo(float).eps * 2.0)
    assert limits.slowing_of(rounded, 1 / rate_hz) > 1 + 1e-6
    assert limits.slowing_of(rounded, 1 / rate_hz, off) <= 1 + 1e-9
    assert limits.slowing_of(1.2 * (rounded - 2.0) + 2.0, 1 / rate_hz, off) > 1.0
