"""The pictures of a report, as data that stands in the page itself, each for a light and for a dark one."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from planner.account import Account
from planner.arrays import FloatArray
from planner.checking.coverage import distance_from_drawing
from planner.drawing.drawing import Drawing
from planner.error_model.prediction import Prediction
from planner.plots.coloured_path import plot_error, plot_speed
from planner.plots.drawing import plot_drawing
from planner.plots.expected import plot_expected
from planner.plots.figure_file import write_figure
from planner.plots.ink import inks_of
from planner.plots.inked import draw_inks
from planner.plots.inked_sheet import plot_sheet
from planner.plots.look import Look, Theme
from planner.plots.paper import paper_patch
from planner.plots.paper_extent import paper_sides_mm
from planner.plots.profiles import plot_profiles
from planner.plots.samples import joined_while_drawing
from planner.plots.timeline import plot_timeline
from planner.plots.workspace import plot_workspace
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings
from planner.trajectory import Trajectory
from planner.workspace.canvas import canvas_of
from planner.workspace.paper_map import paper_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DPI = 110  # 1408 pixels wide: sharp on a page that is at most 1216 wide


@dataclass(frozen=True, slots=True)
class Picture:
    """name: that a link leads to it by. sources: a `data:` address for each theme."""

    name: str
    heading: str
    caption: str
    sources: Mapping[Theme, str]


def sheet_picture(trajectory: Trajectory, tip_mm: FloatArray) -> Picture:
    """The sheet, with which the page opens. tip_mm: (n_samples, 3)."""
    return picture(
        "sheet",
        "The sheet",
        "The paper as it will look: ink in its colours and as wide as the pens draw, seen from behind the arm.",
        lambda look: plot_sheet(trajectory, tip_mm, look),
    )


def expected_picture(prediction: Prediction, heading: str) -> Picture:
    """How well the arm is expected to draw."""
    return picture(
        "accuracy",
        "Expected accuracy",
        "The lines with the band that 95 of 100 arms like this one draw in, where ink may be missing, and what the "
        "error comes from, as plan predict tells it.",
        lambda look: plot_expected(prediction, heading, prediction.summary(), look),
    )


def pictures(
    trajectory: Trajectory,
    account: Account,
    model: ArmModel,
    drawing: Drawing,
    tip_mm: FloatArray,
    reach_mm: tuple[float, float] | None,
    settings: PlanSettings,
) -> Iterator[Picture]:
    """The others, in the order of the page. account: of the trajectory. tip_mm: (n_samples, 3). reach_mm: inner and
    outer radius on the paper."""
    arm = model.arm
    lift_mm = arm.pen.lift_mm if settings.lift_mm is None else settings.lift_mm
    canvas_mm = canvas_of(model, settings.canvas, lift_mm).corners_arm_mm
    drawn = joined_while_drawing(trajectory)
    yield picture(
        "drawing",
        "Drawing",
        "What the pens draw, over what was to be drawn, on the paper in front of the arm, and their way above it.",
        lambda look: plot_drawing(trajectory, tip_mm, account, drawing, canvas_mm, reach_mm, look),
    )
    if drawn.any():
        error_mm = distance_from_drawing(trajectory, drawing, tip_mm)
        yield picture(
            "speed",
            "Speed",
            "The speed of the pen along its path. It slows down in corners and where joints are at their limits.",
            lambda look: plot_speed(trajectory, tip_mm, account, canvas_mm, reach_mm, look),
        )
        yield picture(
            "error",
            "Error of the plan",
            "The distance of the planned pen from the drawing, on the paper and along the way.",
            lambda look: plot_error(trajectory, tip_mm, error_mm, settings.tolerance_mm, canvas_mm, reach_mm, look),
        )
    yield picture(
        "timeline",
        "Where the time goes",
        "When the arm lowers the pen, rests, draws, lifts and travels, told from the height of the tip at the samples.",
        lambda look: plot_timeline(trajectory, tip_mm, arm.pen.clearance_mm, look),
    )
    yield picture(
        "profiles",
        "Joints over time",
        "Position, velocity, acceleration and jerk of every joint, with the arm's limits.",
        lambda look: plot_profiles(trajectory, arm, look),
    )
    maps = paper_map(model)
    sides_mm, inks = paper_sides_mm(trajectory, tip_mm[:, :2]), inks_of(trajectory, tip_mm[:, 1::-1])

    def workspace(look: Look) -> Figure:
        figure = plot_workspace(arm.name, maps, {settings.canvas: canvas_mm}, reach_mm, arm.paper, look)
        axes = figure.axes[0]
        axes.add_patch(paper_patch(sides_mm, look.colours))
        width_pt = 72.0 * figure.get_size_inches()[0] * axes.get_position().width
        draw_inks(axes, inks, width_pt / abs(float(np.diff(axes.get_xlim())[0])), zorder=3.0)
        return figure

    yield picture(
        "workspace",
        "Workspace",
        "The drawing on the canvas within the arm's reach; how freely the pen moves there, and how far it strays where "
        "a joint is off.",
        workspace,
    )


def picture(name: str, heading: str, caption: str, figure: Callable[[Look], Figure]) -> Picture:
    """Drawn for every theme."""
    looks = {theme: Look.of(theme, dpi=_DPI) for theme in Theme}
    return Picture(name, heading, caption, {theme: _address(figure(look), look) for theme, look in looks.items()})


def _address(figure: Figure, look: Look) -> str:
    file = io.BytesIO()
    write_figure(figure, file, "png", look)
    return f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode('ascii')}"
