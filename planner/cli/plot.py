"""`plan plot traj.csv -o FILE`: pictures of a trajectory, and of the workspace of an arm."""

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
Draw a trajectory: the profiles of its joints with their limits, or what the pen leaves on the paper.
Or, with --kind workspace and no trajectory, draw how well an arm moves over its paper."""

_EPILOG = """\
examples:
  plan plot traj.csv -o profiles.png
  plan plot traj.csv -o flower.svg --kind drawing --drawing flower.svg
  plan plot --kind workspace --arm scara -o scara.png

The suffix of FILE says the format: .png, .svg or .pdf."""


def plot(arguments: list[str]) -> int:
    """Draw one picture. Errors: PlannerError."""
    parser = Parser("plan plot", _DESCRIPTION, _EPILOG)
    parser.add_argument("trajectory", nargs="?", type=Path, metavar="traj.csv")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", required=True, help="the picture")
    parser.add_argument("--kind", choices=("profiles", "drawing", "workspace"), default="profiles",
                        help="joint position, velocity, acceleration and jerk; the paper; or how freely and how surely "
                             "an arm moves over its paper (default: %(default)s)")
    parser.add_argument("--drawing", type=Path, metavar="DRAWING.svg",
                        help="with --kind drawing: what was to be drawn, underneath")
    parser.add_argument("--arm", metavar="NAME|FILE", help="draw it for this arm (default: the one in the trajectory; "
                        "with --kind workspace drawing_arm)")
    options = parser.parse_args(arguments)
    if options.drawing and options.kind != "drawing":
        raise UsageError("--drawing goes with --kind drawing")
    if options.kind == "workspace":
        if options.trajectory:
            raise UsageError("--kind workspace is of an arm and takes no trajectory; name the arm with --arm")
        return _workspace(options.arm, options.output)
    if not options.trajectory:
        raise UsageError(f"--kind {options.kind} needs a trajectory (see plan plot --help)")
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


def _workspace(name: str | None, target: Path) -> int:
    check_target(target)

    from planner.arms.arm_file import DEFAULT_ARM, load_arm
    from planner.arms.paper_map import paper_map
    from planner.cli.workspace import paper_in_reach
    from planner.plots.figure_file import picture_format, save_figure
    from planner.plots.workspace import plot_workspace

    picture_format(target)
    arm = load_arm(name or DEFAULT_ARM)
    paper = paper_in_reach(arm)
    save_figure(plot_workspace(arm.name, paper_map(arm), paper.corners_arm_mm, paper.reach_mm), target)
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
