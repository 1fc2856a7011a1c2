"""The pictures of a trajectory by their kinds, and its film: what each needs is found here, and drawn by the plots."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

from planner.errors import PlanError, UsageError
from planner.settings import PlanSettings

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.figure import Figure

    from planner.arms.arm import Arm
    from planner.arrays import FloatArray
    from planner.drawing.drawing import Drawing
    from planner.plots.look import Look
    from planner.plots.motion import Motion
    from planner.progress import Report
    from planner.trajectory import Trajectory


class PlotKind(StrEnum):
    """What a picture of a trajectory shows."""

    SHEET = "sheet"
    PROFILES = "profiles"
    DRAWING = "drawing"
    SPEED = "speed"
    ERROR = "error"
    PHASE = "phase"
    TIMELINE = "timeline"


def figure_of(
    trajectory: Trajectory,
    arm: Arm,
    kind: PlotKind,
    look: Look,
    *,
    drawing: Drawing | None = None,
    tolerance_mm: float = PlanSettings().tolerance_mm,
    stroke: int | None = None,
    from_s: float | None = None,
    to_s: float | None = None,
) -> Figure:
    """One picture. drawing, tolerance_mm: what was wanted, for `drawing` and `error`. stroke: of `phase`, None for the
    one that takes longest. from_s, to_s: of `profiles` and `timeline`.

    Errors: UsageError where the kind needs what is not given or not there.
    """
    if kind is PlotKind.PROFILES:
        from planner.plots.profiles import plot_profiles

        return plot_profiles(trajectory, arm, look, from_s=from_s, to_s=to_s)
    tip_mm = _tip_mm(trajectory, arm)
    if kind is PlotKind.SHEET:
        from planner.plots.inked_sheet import plot_sheet

        return plot_sheet(trajectory, tip_mm, look)
    if kind is PlotKind.PHASE:
        from planner.plots.phase_plane import plot_phase_plane

        return plot_phase_plane(trajectory, arm, tip_mm, stroke, look)
    if kind is PlotKind.TIMELINE:
        from planner.plots.timeline import plot_timeline

        return plot_timeline(trajectory, tip_mm, arm.pen.clearance_mm, look, from_s=from_s, to_s=to_s)
    from planner.account import account_of

    canvas, reach_mm = _paper_of(arm)
    account = account_of(trajectory, tip_mm, arm.pen.clearance_mm)
    if kind is PlotKind.SPEED:
        from planner.plots.coloured_path import plot_speed

        return plot_speed(trajectory, tip_mm, account, canvas, reach_mm, look)
    if kind is PlotKind.ERROR:
        from planner.checking.coverage import distance_from_drawing
        from planner.plots.coloured_path import plot_error

        if drawing is None:
            raise UsageError("a picture of the error needs the drawing that the pen may be off")
        error_mm = distance_from_drawing(trajectory, drawing, tip_mm)
        return plot_error(trajectory, tip_mm, error_mm, tolerance_mm, canvas, reach_mm, look)
    from planner.plots.drawing import plot_drawing

    return plot_drawing(trajectory, tip_mm, account, drawing, canvas, reach_mm, look)


def workspace_figure(arm: Arm, look: Look) -> Figure:
    """How well an arm moves over its paper. Errors: PlanError where it cannot draw."""
    from planner.plots.workspace import plot_workspace
    from planner.redundancy.arm_model import ArmModel
    from planner.settings import CanvasKind
    from planner.workspace.canvas import canvas_of
    from planner.workspace.paper_map import paper_map
    from planner.workspace.reach import paper_in_reach

    model = ArmModel(arm)
    ring_mm = paper_in_reach(model).ring_mm
    canvases = {}
    for kind in CanvasKind:
        try:
            canvases[kind] = canvas_of(model, kind, arm.pen.lift_mm).corners_arm_mm
        except PlanError:  # a narrow ring has no documented canvas
            continue
    return plot_workspace(arm.name, paper_map(model), canvases, ring_mm, arm.paper, look)


def film_page(trajectory: Trajectory, arm: Arm) -> str:
    """The film as the text of one HTML page, at its usual speed."""
    from planner.plots.player import player_page

    return player_page(motion_for_film(trajectory, arm), *_paper_of(arm))


def film_to_file(motion: Motion, target: Path, look: Look, show: Report = lambda label, done, total: None) -> None:
    """The film in the format that the suffix names. Errors: UsageError, OutputError."""
    from planner.plots.film_file import save_film

    save_film(motion, target, *_paper_of(motion.arm), look, show)


def motion_for_film(
    trajectory: Trajectory,
    arm: Arm,
    *,
    speed_factor: float | None = None,
    fps: float | None = None,
    from_s: float | None = None,
    to_s: float | None = None,
) -> Motion:
    """As `motion_of`, with the tip found. Errors: UsageError."""
    from planner.plots.motion import motion_of

    tip_mm = _tip_mm(trajectory, arm)
    return motion_of(trajectory, arm, tip_mm, speed_factor=speed_factor, fps=fps, from_s=from_s, to_s=to_s)


def _paper_of(arm: Arm) -> tuple[FloatArray | None, tuple[float, float] | None]:
    """Canvas corners and reach; None for an arm without: a trajectory from elsewhere can be shown all the same."""
    from planner.redundancy.arm_model import ArmModel
    from planner.workspace.reach import paper_in_reach

    try:
        paper = paper_in_reach(ArmModel(arm))
    except PlanError:
        return None, None
    return paper.corners_arm_mm, paper.ring_mm


def _tip_mm(trajectory: Trajectory, arm: Arm) -> FloatArray:
    """(n_samples, 3)"""
    from planner.checking.chain import chain_poses

    return chain_poses(arm, arm.from_file_units(trajectory.positions), trajectory.pen_heights_mm).tip_mm.T
