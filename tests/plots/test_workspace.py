"""The workspace picture: the figures where the arm has them, the ring, the canvas, the right way round."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.collections import QuadMesh

from planner.arms.arm_file import load_arm
from planner.arms.paper_pose import PaperPose
from planner.kinematics.sensitivity import sideways_error
from planner.plots.workspace import plot_workspace
from planner.settings import CanvasKind
from planner.workspace.paper_map import paper_map
from tests.arms.chains import model_of

SCARA = load_arm("scara")
CANVASES_MM = {
    kind: np.array([[near + height, width / 2], [near + height, -width / 2], [near, -width / 2], [near, width / 2]])
    for kind, near, width, height in (
        (CanvasKind.DOCUMENTED, 60.0, 120.0, 130.0),
        (CanvasKind.OPTIMAL, 60.0, 240.0, 90.0),
        (CanvasKind.USABLE, 70.0, 200.0, 80.0),
    )
}


def test_figures_are_those_of_the_configurations_the_arm_draws_with() -> None:
    figures = paper_map(model_of(SCARA))
    kept = np.isfinite(figures.manipulability)
    assert 0.5 < kept.mean() < 1.0  # the shoulder's limit is in the way on one side
    np.testing.assert_array_equal(kept, np.isfinite(figures.sideways_error_mm))
    radius = np.hypot(figures.x_mm, figures.y_mm)
    a1, a2 = (joint.a_mm for joint in SCARA.joints[:2])
    cosine = (radius**2 - a1**2 - a2**2) / (2 * a1 * a2)
    np.testing.assert_allclose(figures.manipulability[kept], a1 * a2 * np.sqrt(1 - cosine[kept] ** 2), rtol=1e-6)
    places = np.column_stack((figures.x_mm[kept], figures.y_mm[kept], np.zeros(kept.sum())))[::97]
    configurations, _ = model_of(SCARA).configuration_map().configurations_at(places)
    np.testing.assert_allclose(figures.sideways_error_mm[kept][::97], sideways_error(SCARA, configurations), rtol=1e-9)


def test_both_maps_show_figures_ring_canvas_and_base_seen_from_behind_the_base() -> None:
    figures = paper_map(model_of(SCARA))
    figure = plot_workspace("scara", figures, CANVASES_MM, (60.0, 198.0), PaperPose())
    ring, *maps = [axes for axes in figure.axes if axes.get_xlabel() == "arm y (mm)"]
    assert len(maps) == 2
    for axes, values in zip(
        maps, (figures.manipulability / np.nanmax(figures.manipulability), figures.sideways_error_mm), strict=True
    ):
        (mesh,) = [item for item in axes.collections if isinstance(item, QuadMesh)]
        shown = np.ma.filled(mesh.get_array(), np.nan)
        corners = np.stack((values[:-1, :-1], values[1:, :-1], values[:-1, 1:], values[1:, 1:]))
        np.testing.assert_allclose(shown.reshape(corners.shape[1:]), corners.mean(axis=0))
        assert np.nanmax(shown) == pytest.approx(np.nanmax(values), rel=0.05)
        places = mesh.get_coordinates()
        np.testing.assert_array_equal(places, np.stack((figures.y_mm, figures.x_mm), axis=-1))
        shapes = {patch.get_label(): patch for patch in axes.patches}
        np.testing.assert_array_equal(shapes["canvas"].get_xy()[:4, ::-1], CANVASES_MM[CanvasKind.USABLE])
        assert "reach of the pen" in shapes
        left, right = axes.get_xlim()
        low, high = axes.get_ylim()
        assert left > 198 > -198 > right
        assert low < 0 < 198 < high
    shapes = {patch.get_label(): patch for patch in ring.patches}
    assert set(shapes) == {
        "reach of the pen",
        "documented canvas, 120 × 130 mm",
        "optimal canvas, 240 × 90 mm",
        "usable canvas, 200 × 80 mm",
    }
    for kind, corners in CANVASES_MM.items():
        (shape,) = [patch for label, patch in shapes.items() if label.startswith(kind)]
        np.testing.assert_array_equal(shape.get_xy()[:4, ::-1], corners)
    figure.draw_without_rendering()
