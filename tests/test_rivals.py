"""The rivals of benchmarks/table.py keep what they are said to keep: a rival that breaks a limit is none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from benchmarks.targets.axidraw import axidraw
from benchmarks.targets.saxi import saxi
from benchmarks.targets.strokes import untimed
from benchmarks.targets.trapezoids import speeds, way_s
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.execution.context import PlanContext
from planner.settings import PlanSettings

RATE_HZ, TOLERANCE_MM = 100.0, 0.05


def wavy(count: int) -> FloatArray:
    """Points with a corner in their middle."""
    x = np.linspace(0.0, 20.0, count)
    return np.column_stack((70.0 + x, 3.0 * np.abs(np.sin(np.pi * x / 20.0) - 0.5)))


def test_straight_lines_from_rest_to_rest_take_what_the_closed_form_says() -> None:
    long, short = np.array([[0.0, 0.0], [100.0, 0.0]]), np.array([[0.0, 0.0], [0.6, 0.8]])
    assert way_s(long, 80.0, 1000.0, 0.05) == pytest.approx(100.0 / 80.0 + 80.0 / 1000.0)
    assert way_s(short, 80.0, 1000.0, 0.05) == pytest.approx(2 * np.sqrt(1.0 / 1000.0))


def test_a_corner_is_taken_as_fast_as_the_circle_that_deviates_so_much_from_it() -> None:
    corner = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0]])
    radius_mm = 0.05 * np.sqrt(0.5) / (1 - np.sqrt(0.5))
    _, speed = speeds(corner, 80.0, 1000.0, 0.05)
    assert speed == pytest.approx([0.0, np.sqrt(1000.0 * radius_mm), 0.0])


@pytest.mark.parametrize("plotter", [axidraw(80.0), saxi(80.0)])
def test_plotters_keep_their_acceleration_and_their_cap(plotter) -> None:  # type: ignore[no-untyped-def]
    length, speed = speeds(wavy(300), plotter.down_mm_s, plotter.down_mm_s2, plotter.deviation_mm)
    assert speed.max() <= plotter.down_mm_s
    assert (np.abs(np.diff(speed**2)) <= 2 * plotter.down_mm_s2 * length * (1 + 1e-9)).all()
    assert speed.max() > 0.3 * plotter.down_mm_s


def test_a_gap_is_hopped_over_where_it_is_too_wide_to_be_drawn_across() -> None:
    one, near, far = (np.array([[x, 0.0], [x + 10.0, 0.0]]) for x in (0.0, 10.1, 11.0))
    plotter = axidraw(80.0)
    lifts_s = plotter.lower_s + plotter.raise_s
    ink_s, whole_s = plotter.ink_and_whole_s([one, near])
    assert whole_s == pytest.approx(ink_s + lifts_s)
    ink_s, whole_s = plotter.ink_and_whole_s([one, far])
    assert whole_s == pytest.approx(ink_s + 2 * lifts_s + 2 * np.sqrt(1.0 / plotter.up_mm_s2))


def test_toppra_s_followers_keep_all_limits_and_the_tolerance() -> None:
    from benchmarks.targets import toppra_ruckig, toppra_slowed
    from benchmarks.targets.toppra_profile import profile_of

    stroke = wavy(80)
    settings = replace(PlanSettings(cache=False), rate_hz=RATE_HZ, tolerance_mm=TOLERANCE_MM)
    context = PlanContext.of(load_arm(settings.arm), settings)
    (path,) = untimed(context, [stroke])
    profile = profile_of(path)
    assert profile is not None
    _, velocity, acceleration = profile.at(profile.time_s)
    assert np.abs(velocity / path.limits.velocity).max() <= 1 + 1e-6
    assert 0.9 < np.abs(acceleration / path.limits.acceleration).max() <= 1.02

    samples = toppra_slowed.slowed(profile, RATE_HZ)
    for order, limit in enumerate((path.limits.velocity, path.limits.acceleration, path.limits.jerk), 1):
        held = np.concatenate((3 * [samples[0]], samples, 3 * [samples[-1]]))
        assert (np.abs(np.diff(held, order, axis=0)) * RATE_HZ**order <= limit * (1 + 1e-9)).all()
    assert (len(samples) - 1) / RATE_HZ > profile.duration_s

    kinematics = context.model.kinematics
    way = toppra_ruckig.smoothed(profile, stroke, kinematics, TOLERANCE_MM)
    assert profile.duration_s < way.duration_s < 4 * profile.duration_s
    tips = kinematics.tip_mm(kinematics.independent_of(way.joints[:, 0]))
    assert shapely.distance(shapely.LineString(stroke), shapely.points(tips[:, :2])).max() <= TOLERANCE_MM
    for order, limit in enumerate((path.limits.velocity, path.limits.acceleration), 1):
        assert np.abs(way.joints[:, order] / limit).max() <= 1 + 1e-6
