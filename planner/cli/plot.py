"""`plan plot traj.csv -o FILE`: pictures of a trajectory."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.errors import PlanError, UsageError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from planner.arms.arm import Arm
    from planner.trajectory import Trajectory

_DESCRIPTION = """\
Draw a trajectory: the profiles of its joints with their limits, or what the pen leaves on the paper."""

_EPILOG = """\
examples:
  plan plot traj.csv -o profiles.png
  plan plot traj.csv -o flower.svg --kind drawing --drawing flower.svg

The suffix of FILE says the format: .png, .svg or .pdf."""


def plot(arguments: list[str]) -> int:
    """Draw one picture. Errors: PlannerError."""
    parser = Parser("plan plot", _DESCRIPTION, _EPILOG)
    parser.add_argument("trajectory", type=Path, metavar="traj.csv")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", required=True, help="the picture")
    parser.add_argument("--kind", choices=("profiles", "drawing"), default="profiles",
                        help="joint position, velocity, acceleration and jerk, or the paper (default: %(default)s)")
    parser.add_argument("--drawing", type=Path, metavar="DRAWING.svg",
                        help="with --kind drawing: what was to be drawn, underneath")
    parser.add_argument("--arm", metavar="NAME|FILE", help="draw it for this arm (default: the one in the trajectory)")
    options = parser.parse_args(arguments)
    if options.drawing and options.kind != "drawing":
        raise UsageError("--drawing goes with --kind drawing")
    check_target(options.output, options.trajectory, *([options.drawing] if options.drawing else []))

    from planner.arms.arm_file import load_arm
    from planner.plots.figure_file import picture_format, save_figure
    from planner.trajectory import read_trajectory

    picture_format(options.output)
    trajectory = read_trajectory(options.trajectory)
    arm = load_arm(options.arm or trajectory.arm)
    if options.kind == "profiles":
        from planner.plots.profiles import plot_profiles

        figure = plot_profiles(trajectory, arm)
    else:
        figure = _paper(trajectory, arm, options.drawing)
    save_figure(figure, options.output)
    return 0


def _paper(trajectory: Trajectory, arm: Arm, drawing: Path | None) -> Figure:
    from planner.checking.chain import chain_poses
    from planner.cli.workspace import paper_in_reach
    from planner.drawing.svg import read_drawing
    from planner.plots.drawing import plot_drawing

    if trajectory.columns != arm.column_names:
        raise UsageError(f"the trajectory moves {', '.join(trajectory.columns)}; "
                         f"arm '{arm.name}' has {', '.join(arm.column_names)}")
    tip_mm = chain_poses(arm, arm.from_file_units(trajectory.positions)).tip_mm.T
    wanted = read_drawing(drawing) if drawing else None
    try:
        paper = paper_in_reach(arm)
    except PlanError:  # a trajectory from elsewhere can be shown all the same
        return plot_drawing(trajectory, tip_mm, wanted)
    return plot_drawing(trajectory, tip_mm, wanted, paper.corners_arm_mm, paper.reach_mm)
