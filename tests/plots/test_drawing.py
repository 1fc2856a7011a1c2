"""The picture of the drawing shows the tip's path where the pen is down, over the outlines, the right way round."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection

from planner.account import Account, account_of
from planner.arrays import FloatArray
from planner.drawing.drawing import Drawing, Outline
from planner.plots.drawing import plot_drawing
from planner.trajectory import Trajectory

MakeTrajectory = Callable[..., Trajectory]
CANVAS_MM = np.array([[40.0, -60.0], [40.0, 60.0], [120.0, 60.0], [120.0, -60.0]])


def tip_path(trajectory: Trajectory) -> FloatArray:
    """(n, 3): a spiral, which never comes back to where it was."""
    s = np.linspace(0, 1, trajectory.n_samples)
    return np.column_stack((80 + 30 * s * np.cos(9 * s), 30 * s * np.sin(9 * s), 5.0 * ~trajectory.pen))


def line(axes: Axes, label: str) -> FloatArray:
    """(n, 2) arm x and y of the line with that label, NaN between its pieces."""
    (found,) = [item for item in axes.lines if item.get_label() == label]
    return np.column_stack((found.get_ydata(), found.get_xdata())).astype(np.float64)


def pieces(points: FloatArray) -> list[FloatArray]:
    gaps = np.flatnonzero(np.isnan(points[:, 0]))
    return [part[~np.isnan(part[:, 0])] for part in np.split(points, gaps + 1)[:-1]]


def labels(axes: Axes) -> set[str]:
    return set(axes.get_legend_handles_labels()[1])


def straight(start: tuple[float, float], end: tuple[float, float]) -> Outline:
    ends = np.array([start, end], dtype=np.float64)
    return Outline((ends[0] + np.array([0, 1, 2, 3])[:, np.newaxis] / 3 * (ends[1] - ends[0]))[np.newaxis])


def account(trajectory: Trajectory) -> Account:
    return account_of(trajectory, tip_path(trajectory), 1.0)


def inked(axes: Axes) -> list[FloatArray]:
    (lines,) = (one for one in axes.collections if isinstance(one, LineCollection))
    return [np.asarray(segment)[:, ::-1] for segment in lines.get_segments()]


def taps(axes: Axes) -> FloatArray:
    (dots,) = (one for one in axes.collections if isinstance(one, EllipseCollection))
    return np.asarray(dots.get_offsets())[:, ::-1]


def test_strokes_are_drawn_sample_by_sample_and_travels_join_them(make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory()
    tip_mm = tip_path(trajectory)
    (axes,) = plot_drawing(trajectory, tip_mm, account(trajectory)).axes
    drawn = inked(axes)
    assert len(drawn) == 2
    for piece, stroke in zip(drawn, (0, 2), strict=True):
        np.testing.assert_array_equal(piece, tip_mm[trajectory.stroke == stroke, :2])
    np.testing.assert_array_equal(taps(axes), tip_mm[trajectory.stroke == 1, :2])
    # no step between samples is lost or told twice
    steps = sum(len(piece) - 1 for piece in drawn + pieces(line(axes, "travel, pen up")))
    assert steps == trajectory.n_samples - 1


def test_touching_strokes_stay_apart_where_the_pen_never_lifts(make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory(n_samples=10)
    trajectory.pen[:] = True
    trajectory.stroke[:] = [0] * 4 + [1] * 6
    (axes,) = plot_drawing(trajectory, tip_path(trajectory), account(trajectory)).axes
    assert [len(piece) for piece in inked(axes)] == [4, 6]


def test_outlines_lie_where_the_trajectory_s_map_puts_them(make_trajectory: MakeTrajectory) -> None:
    outlines = (straight((0, 0), (30, 10)), straight((5, 50), (5, 50)))
    drawing = Drawing("flower.svg", outlines, np.eye(2, 3), (100.0, 100.0))
    trajectory = make_trajectory()  # x = 120 - v, y = 40 - u
    (axes,) = plot_drawing(trajectory, tip_path(trajectory), account(trajectory), drawing).axes
    np.testing.assert_allclose(pieces(line(axes, "wanted"))[0], [[120, 40], [110, 10]])
    np.testing.assert_allclose(line(axes, "tap wanted"), [[70, 35]])


def test_the_drawing_reads_as_on_a_screen_for_who_sits_behind_the_base(make_trajectory: MakeTrajectory) -> None:
    """With the planner's map, SVG u to the right and v down are right and down in the picture."""
    drawing = Drawing("flower.svg", (straight((0, 0), (30, 10)),), np.eye(2, 3), (100.0, 100.0))
    figure = plot_drawing(
        make_trajectory(), tip_path(make_trajectory()), account(make_trajectory()), drawing, CANVAS_MM, (33.0, 149.0)
    )
    (axes,) = figure.axes
    start, end = (axes.transData.transform(point[::-1]) for point in pieces(line(axes, "wanted"))[0])
    assert end[0] > start[0]
    assert end[1] < start[1]
    (base,) = axes.transData.transform([[0.0, 0.0]])
    assert base[1] < min(start[1], end[1])
    figure.draw_without_rendering()
    unit = axes.transData.transform([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    assert abs(unit[1, 0] - unit[0, 0]) == pytest.approx(abs(unit[2, 1] - unit[0, 1]))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("arm y (mm)", "arm x (mm)")


def test_canvas_ring_and_base_are_there_and_in_view(make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory()
    (axes,) = plot_drawing(trajectory, tip_path(trajectory), account(trajectory), None, CANVAS_MM, (33.0, 149.0)).axes
    assert {"base of the arm", "canvas", "reach of the pen"} <= labels(axes)
    shapes = {patch.get_label(): patch for patch in axes.patches}
    np.testing.assert_array_equal(shapes["canvas"].get_xy()[:4, ::-1], CANVAS_MM)
    ring = shapes["reach of the pen"].get_path()
    assert ring.get_extents().extents == pytest.approx([-149, 0, 149, 149], abs=0.1)
    assert [bool(ring.contains_point(point)) for point in ((0, 32), (0, 34), (100, 100), (110, 110))] == [
        False,
        True,
        True,
        False,
    ]
    assert axes.get_xlim()[0] > 149 > -149 > axes.get_xlim()[1]
    assert axes.get_ylim()[0] < 0 < 149 < axes.get_ylim()[1]


def test_what_was_not_given_is_not_in_the_legend(make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory()
    (axes,) = plot_drawing(trajectory, tip_path(trajectory), account(trajectory)).axes
    assert labels(axes) == {"base of the arm", "paper", "travel, pen up"}


def test_a_path_outside_the_ring_is_still_in_view(make_trajectory: MakeTrajectory) -> None:
    trajectory = make_trajectory()
    (axes,) = plot_drawing(
        trajectory, tip_path(trajectory) - [400, 0, 0], account(trajectory), None, None, (33.0, 149.0)
    ).axes
    assert axes.get_ylim()[0] < -320
