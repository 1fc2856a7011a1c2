"""The colours along the pen's path are its speed, or how far it is off the drawing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from planner.account import account_of
from planner.arrays import FloatArray
from planner.errors import UsageError
from planner.plots.coloured_path import N_LEVELS, plot_error, plot_speed
from planner.plots.look import Look
from planner.trajectory import Trajectory

MakeTrajectory = Callable[..., Trajectory]


def tip_path(trajectory: Trajectory) -> FloatArray:
    """(n, 3): a spiral that is gone along ever faster."""
    s = np.linspace(0, 1, trajectory.n_samples) ** 2
    return np.column_stack((80 + 30 * s * np.cos(9 * s), 30 * s * np.sin(9 * s), 5.0 * ~trajectory.pen))


def coloured_steps(figure: Figure) -> dict[tuple[float, ...], int]:
    """Level of colour of each step that is drawn, by its two ends."""
    axes: Axes = figure.axes[0]
    level_of = {to_hex(colour): level for level, colour in enumerate(Look.of().colours.colour_map(N_LEVELS).colors)}
    steps: dict[tuple[float, ...], int] = {}
    for line in axes.lines:
        if line.get_color() == Look.of().colours.ink or to_hex(line.get_color()) not in level_of:
            continue
        points = np.column_stack((line.get_ydata(), line.get_xdata()))
        for begin, end in pairwise(points):
            if not np.isnan([begin, end]).any():
                key = (*begin.tolist(), *end.tolist())
                assert key not in steps
                steps[key] = level_of[to_hex(line.get_color())]
    return steps


def test_the_colour_of_every_step_is_its_finite_difference(make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory()
    tip_mm = tip_path(trajectory)
    figure = plot_speed(trajectory, tip_mm, account_of(trajectory, tip_mm, 1.0))
    steps = coloured_steps(figure)
    drawn = [
        k
        for k in range(trajectory.n_samples - 1)
        if trajectory.stroke[k] >= 0 and trajectory.stroke[k] == trajectory.stroke[k + 1]
    ]
    assert len(steps) == len(drawn)
    speeds = [float(np.hypot(*(tip_mm[k + 1, :2] - tip_mm[k, :2]))) * trajectory.rate_hz for k in drawn]
    top = max(speeds)
    for k, speed in zip(drawn, speeds, strict=True):
        level = steps[(*tip_mm[k, :2].tolist(), *tip_mm[k + 1, :2].tolist())]
        assert level * top / N_LEVELS <= speed * (1 + 1e-12)
        assert speed <= (level + 1) * top / N_LEVELS * (1 + 1e-12)
    bar = figure.axes[1]
    assert bar.get_ylabel() == "speed of the pen (mm/s)"
    assert bar.get_ylim() == pytest.approx((0, top))
    assert f"at most {top:.1f} mm/s" in figure.texts[1].get_text()


def test_the_error_is_shown_over_the_way_with_the_tolerance_and_its_worst_place(
    make_trajectory: MakeTrajectory,
) -> None:
    trajectory = make_trajectory()
    tip_mm = tip_path(trajectory)
    error_mm = np.abs(np.sin(np.arange(trajectory.n_samples))) * 0.04
    worst = int(np.flatnonzero(trajectory.pen)[17])
    error_mm[worst] = 0.07
    error_mm[~trajectory.pen] = 9.0
    figure = plot_error(trajectory, tip_mm, error_mm, 0.05)
    paper, bar, below = figure.axes
    (curve,) = [line for line in below.lines if line.get_label() == "distance from the drawing"]
    np.testing.assert_array_equal(curve.get_ydata(), error_mm[trajectory.pen])
    way_mm = np.asarray(curve.get_xdata())
    drawn_mm = sum(
        float(np.linalg.norm(np.diff(tip_mm[trajectory.stroke == k, :2], axis=0), axis=1).sum()) for k in (0, 2)
    )
    assert (way_mm[0], way_mm[-1]) == pytest.approx((0.0, drawn_mm))
    assert np.all(np.diff(way_mm) >= 0)
    (tolerance,) = [line for line in below.lines if line.get_label() == "tolerance"]
    assert set(tolerance.get_ydata()) == {0.05}
    assert below.get_ylim()[1] > 0.07
    assert "mm" in below.get_xlabel()
    assert "mm" in below.get_ylabel()
    (mark,) = [line for line in paper.lines if line.get_label() == "farthest off"]
    assert (mark.get_ydata()[0], mark.get_xdata()[0]) == tuple(tip_mm[worst, :2])
    assert bar.get_ylim() == pytest.approx((0, 0.07))
    assert max(coloured_steps(figure).values()) == N_LEVELS - 1


def test_a_trajectory_without_a_line_has_no_speed_to_show(make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory()
    still = replace(trajectory, pen=np.zeros_like(trajectory.pen), stroke=np.full_like(trajectory.stroke, -1))
    with pytest.raises(UsageError, match="draws no line"):
        plot_speed(still, tip_path(trajectory), account_of(still, tip_path(trajectory), 1.0))
