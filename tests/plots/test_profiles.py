"""The picture of the profiles holds what the trajectory and the arm hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from planner.arms.arm import Arm
from planner.errors import UsageError
from planner.plots.profiles import plot_profiles
from planner.plots.samples import finite_difference
from planner.trajectory import Trajectory

MakeTrajectory = Callable[..., Trajectory]


def panel(figure: Figure, arm: Arm, joint: int, order: int) -> Axes:
    assert len(figure.axes) == 4 * arm.n_joints
    return figure.axes[4 * joint + order]


def limits_drawn(axes: Axes) -> list[float]:
    return sorted(float(line.get_ydata()[0]) for line in axes.lines if list(line.get_xdata()) == [0, 1])


def curve(axes: Axes) -> tuple[np.ndarray, np.ndarray]:
    line = axes.lines[0]
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata())


def test_every_joint_has_its_samples_derivatives_limits_and_units(arm: Arm, make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory()
    figure = plot_profiles(trajectory, arm)
    for k, (joint, low, high) in enumerate(zip(arm.joints, (-90, -5, -100), (80, 30, 100), strict=True)):
        for order, (per_time, factor) in enumerate([("", 1), ("/s", 10), ("/s²", 100), ("/s³", 1000)]):
            axes = panel(figure, arm, k, order)
            times_s, values = finite_difference(trajectory.positions, trajectory.rate_hz, order)
            np.testing.assert_array_equal(curve(axes)[0], times_s)
            np.testing.assert_array_equal(curve(axes)[1], values[:, k])
            assert limits_drawn(axes) == pytest.approx([low if order == 0 else -factor * high, factor * high])
            assert joint.file_unit + per_time in axes.get_ylabel()
            assert axes.get_ylim()[0] < limits_drawn(axes)[0] < limits_drawn(axes)[1] < axes.get_ylim()[1]
        assert joint.name in panel(figure, arm, k, 0).get_ylabel()
    assert [panel(figure, arm, 0, order).texts[0].get_text() for order in range(4)] == [
        "Position",
        "Velocity",
        "Acceleration",
        "Jerk",
    ]
    assert all(panel(figure, arm, arm.n_joints - 1, order).get_xlabel() == "time (s)" for order in range(4))


def test_tick_labels_in_thousands_say_so(arm: Arm, make_trajectory: MakeTrajectory) -> None:
    jerk = panel(plot_profiles(make_trajectory(), arm), arm, 0, 3)
    assert jerk.get_ylabel() == "10³ deg/s³"
    assert jerk.yaxis.get_major_formatter()(-80_000.0, None) == "\N{MINUS SIGN}80"


def test_the_shading_is_where_the_pen_is_down(arm: Arm, make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory()
    figure = plot_profiles(trajectory, arm)
    for axes in figure.axes:
        (shading,) = [item for item in axes.collections if isinstance(item, PolyCollection)]
        spans = [path.get_extents() for path in shading.get_paths()]
        shaded = np.any([(span.x0 < trajectory.times_s) & (trajectory.times_s < span.x1) for span in spans], axis=0)
        np.testing.assert_array_equal(shaded, trajectory.pen)
        assert all((span.y0, span.y1) == (0, 1) for span in spans)


def test_a_broken_limit_is_named_and_marked_and_a_kept_one_is_not(arm: Arm, make_trajectory: MakeTrajectory) -> None:
    kept = panel(plot_profiles(make_trajectory(), arm), arm, 0, 0)
    assert kept.get_title("right") == "50.0 deg to spare"
    assert len(kept.lines) == 3
    trajectory = make_trajectory(swing=3.0)
    broken = panel(plot_profiles(trajectory, arm), arm, 0, 0)
    assert broken.get_title("right") == "10.0 deg too far"
    assert float(broken.lines[-1].get_ydata()[0]) == trajectory.positions[:, 0].max()
    assert broken.get_ylim()[1] > trajectory.positions[:, 0].max()


@pytest.mark.parametrize(
    ("share", "remark"), [(0.5, "peak 50 % of limit"), (1.5, "peak 150 % of limit"), (20.0, "peak 20 times the limit")]
)
def test_the_peak_is_told_as_a_share_of_the_limit(
    arm: Arm, make_trajectory: MakeTrajectory, share: float, remark: str
) -> None:
    velocity = finite_difference(make_trajectory().positions, 100.0, 1)[1][:, 0]
    trajectory = make_trajectory(swing=share * 800 / np.abs(velocity).max())
    assert panel(plot_profiles(trajectory, arm), arm, 0, 1).get_title("right") == remark


def test_a_long_trajectory_is_thinned_with_its_peaks(arm: Arm, make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory(n_samples=60_000)
    trajectory.positions[31_415, 1] += 0.001
    figure = plot_profiles(trajectory, arm)
    for order in range(4):
        _, values = finite_difference(trajectory.positions, trajectory.rate_hz, order)
        _, drawn = curve(panel(figure, arm, 1, order))
        assert len(drawn) < 1300
        assert (drawn.min(), drawn.max()) == (values[:, 1].min(), values[:, 1].max())


@pytest.mark.parametrize("n_samples", [1, 2, 5])
def test_the_shortest_trajectories_have_a_picture(arm: Arm, n_samples: int) -> None:
    still = Trajectory(
        "three",
        "dot.svg",
        "path",
        100.0,
        arm.column_names,
        np.zeros((n_samples, 3)),
        np.zeros(n_samples, dtype=bool),
        np.full(n_samples, -1),
        (1, 0, 0, 1, 0, 0),
    )
    assert panel(plot_profiles(still, arm), arm, 0, 1).get_title("right") == "peak 0 % of limit"


def test_another_arm_s_trajectory_is_refused(arm: Arm, make_trajectory: MakeTrajectory) -> None:
    other = replace(make_trajectory(), columns=("q1_deg", "q2_deg", "q3_deg"))
    with pytest.raises(UsageError, match=r"q2_deg.*'three'.*d2_mm"):
        plot_profiles(other, arm)


def test_a_long_name_leaves_the_legend_its_room(arm: Arm, make_trajectory: MakeTrajectory) -> None:
    figure = plot_profiles(make_trajectory(swing=50.0, drawing="W" * 300 + ".svg"), arm)
    figure.draw_without_rendering()
    heading, legend = figure.texts[0].get_window_extent(), figure.legends[0].get_window_extent()
    assert heading.x1 < figure.bbox.x1
    assert legend.y1 < heading.y0
