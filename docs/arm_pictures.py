"""The included arms as they draw, for the gallery: `make_figures.py` takes the pictures from here."""

from __future__ import annotations

from pathlib import Path

from planner.arms.arm_file import known_arms, load_arm
from planner.plots.figure_file import save_figure
from planner.plots.poses import plot_poses
from planner.redundancy.arm_model import ArmModel
from planner.report.arm_page import configurations_on_canvas
from planner.workspace.reach import paper_in_reach


def arm_pictures(folder: Path) -> None:
    """arm-NAME.png of every included arm."""
    for name in known_arms():
        arm = load_arm(name)
        model = ArmModel(arm)
        corners = paper_in_reach(model).corners_arm_mm
        save_figure(plot_poses(arm, configurations_on_canvas(model, corners), corners), folder / f"arm-{name}.png")
