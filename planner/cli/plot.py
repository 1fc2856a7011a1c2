"""`plan plot traj.csv -o FILE`: pictures and films of a trajectory, and pictures of the workspace of an arm."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from planner.cli.files import input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import MIN_TOLERANCE_MM, length_mm, number
from planner.cli.terminal import progress
from planner.errors import PlanError, UsageError
from planner.settings import PlanSettings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from planner.arms.arm import Arm
    from planner.arrays import FloatArray
    from planner.plots.look import Look
    from planner.trajectory import Trajectory

_DESCRIPTION = """\
Draw a trajectory, or play it in a film. Or, with --kind workspace and no trajectory, draw how well an arm moves over
its paper.

kinds:
  profiles   position, velocity, acceleration and jerk of every joint, with their limits
  drawing    what the pen draws, over what was to be drawn
  speed      the pen's path with its speed as colour
  error      how far the pen is off the drawing, on the paper and along the way
  phase      the pen's speed along one stroke, under what the joints allow on that path
  timeline   when the arm lowers, rests, draws, lifts and travels, with totals
  film       the arm as it draws, from above and from the side
  workspace  the reach of an arm, its canvases, and how freely and how surely the pen moves"""

_EPILOG = """\
examples:
  plan plot traj.csv -o profiles.png
  plan plot traj.csv -o start.png --from 0 --to 2.5
  plan plot traj.csv -o flower.svg --kind drawing --drawing flower.svg
  plan plot traj.csv -o speed.pdf --kind speed --size paper
  plan plot traj.csv -o error.png --kind error --drawing flower.svg --tolerance 0.05mm
  plan plot traj.csv -o phase.png --kind phase --stroke 3
  plan plot traj.csv -o timeline.png --kind timeline --theme dark
  plan plot traj.csv -o film.html
  plan plot traj.csv -o film.gif --speed-factor 4 --fps 20
  plan plot -o scara.png --kind workspace --arm scara

The suffix of FILE says the format: .png, .svg or .pdf; of a film .html (one file with a player in it), .gif or .mp4.
- is standard output, to which a picture goes as .png and a film as .gif.
A film's name is enough to ask for one."""

_WITHOUT_TRAJECTORY = "workspace"
_GOES_WITH = {
    "drawing": ("drawing", "error"),
    "tolerance": ("error",),
    "stroke": ("phase",),
    "from_s": ("profiles", "timeline", "film"),
    "to_s": ("profiles", "timeline", "film"),
    "speed_factor": ("film",),
    "fps": ("film",),
}
_KINDS = ("profiles", "drawing", "speed", "error", "phase", "timeline", "film", "workspace")
_FILM_SUFFIXES = (".html", ".gif", ".mp4")
_FILM_DPI = 75


def plot(arguments: list[str]) -> int:
    """Draw one picture or film. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    target: Path = options.output
    kind = options.kind or ("film" if target.suffix.lower() in _FILM_SUFFIXES else "profiles")
    _refuse_what_means_nothing(options, kind)
    check_target(target, *filter(None, (options.trajectory, options.drawing)))

    from planner.arms.arm_file import DEFAULT_ARM, load_arm
    from planner.plots.look import Look, Size, Theme
    from planner.plots.samples import require_joints
    from planner.trajectory import read_trajectory

    look = Look.of(Theme(options.theme), Size(options.size), options.dpi or (_FILM_DPI if kind == "film" else None))
    _check_format(target, kind)
    if kind == _WITHOUT_TRAJECTORY:
        figure = _workspace(load_arm(options.arm or DEFAULT_ARM), look)
    else:
        trajectory = read_trajectory(options.trajectory)
        arm = load_arm(options.arm or trajectory.arm)
        require_joints(trajectory, arm)
        if kind == "film":
            _film(trajectory, arm, options, look)
            return 0
        figure = _figure(trajectory, arm, kind, options, look)

    from planner.plots.figure_file import save_figure

    save_figure(figure, target, look)
    return 0


def _parser() -> Parser:
    parser = Parser("plan plot", _DESCRIPTION, _EPILOG)
    parser.add_argument("trajectory", nargs="?", type=input_file, metavar="traj.csv", help="- for standard input")
    parser.add_argument("-o", "--output", type=output_file, metavar="FILE", required=True, help="the picture or film")
    parser.add_argument(
        "--kind",
        choices=_KINDS,
        metavar="KIND",
        help="what to draw, see above (default: profiles, or film where FILE is one)",
    )
    parser.add_argument(
        "--arm",
        metavar="NAME|FILE",
        help="draw it for this arm (default: the one in the trajectory; with --kind workspace drawing_arm)",
    )
    parser.add_argument(
        "--drawing", type=input_file, metavar="DRAWING.svg", help="with --kind drawing or error: what was to be drawn"
    )
    parser.add_argument(
        "--tolerance",
        type=length_mm(minimum_mm=MIN_TOLERANCE_MM),
        metavar="LENGTH",
        help=f"with --kind error: how far the pen may be off (default: {PlanSettings().tolerance_mm:g} mm)",
    )
    parser.add_argument(
        "--stroke",
        type=_index,
        metavar="K",
        help="with --kind phase: which stroke, from 0 (default: the one that takes longest)",
    )
    parser.add_argument(
        "--from",
        dest="from_s",
        type=number(zero=True),
        metavar="SECONDS",
        help="with --kind profiles, timeline or film: begin there",
    )
    parser.add_argument(
        "--to", dest="to_s", type=number(), metavar="SECONDS", help="with --kind profiles, timeline or film: end there"
    )
    style = parser.add_argument_group("look")
    style.add_argument("--theme", choices=("light", "dark"), default="light", help="(default: %(default)s)")
    style.add_argument(
        "--size",
        choices=("screen", "paper"),
        default="screen",
        help="1920 pixels wide, or 180 mm for print (default: %(default)s)",
    )
    style.add_argument(
        "--dpi",
        type=number(minimum=30, maximum=1200),
        metavar="N",
        help="pixels to the inch of a .png or a film (default: 150 for a screen, 300 for paper, 75 for films)",
    )
    film = parser.add_argument_group("film")
    film.add_argument(
        "--speed-factor",
        type=number(minimum=0.01, maximum=10_000),
        metavar="X",
        help="times as fast as the arm (default: 1, or what makes it last 20 s)",
    )
    film.add_argument("--fps", type=number(minimum=1, maximum=50), metavar="N", help="pictures a second (default: 20)")
    film.add_argument("--quiet", action="store_true", help="no progress")
    return parser


def _index(text: str) -> int:
    if not text.isdecimal() or not text.isascii() or len(text) > 9:
        raise argparse.ArgumentTypeError(f"'{text}' is not the index of a stroke, a whole number from 0")
    return int(text)


def _refuse_what_means_nothing(options: argparse.Namespace, kind: str) -> None:
    for option, kinds in _GOES_WITH.items():
        if getattr(options, option) is not None and kind not in kinds:
            name = option.removesuffix("_s").replace("_", "-")
            raise UsageError(f"--{name} goes with --kind {' or '.join(kinds)}, not {kind}")
    if kind == _WITHOUT_TRAJECTORY:
        if options.trajectory:
            raise UsageError("--kind workspace is of an arm and takes no trajectory; name the arm with --arm")
    elif not options.trajectory:
        raise UsageError(f"--kind {kind} needs a trajectory (see plan plot --help)")
    if kind == "error" and not options.drawing:
        raise UsageError("--kind error needs --drawing DRAWING.svg, the drawing that the pen may be off")


def _check_format(target: Path, kind: str) -> None:
    if kind == "film":
        from planner.plots.film_file import film_format

        film_format(target)
    else:
        from planner.plots.figure_file import picture_format

        picture_format(target)


def _figure(trajectory: Trajectory, arm: Arm, kind: str, options: argparse.Namespace, look: Look) -> Figure:
    part = {"from_s": options.from_s, "to_s": options.to_s}
    if kind == "profiles":
        from planner.plots.profiles import plot_profiles

        return plot_profiles(trajectory, arm, look, **part)
    tip_mm = _tip_mm(trajectory, arm)
    if kind == "phase":
        from planner.plots.phase_plane import plot_phase_plane

        return plot_phase_plane(trajectory, arm, tip_mm, options.stroke, look)
    if kind == "timeline":
        from planner.plots.timeline import plot_timeline

        return plot_timeline(trajectory, tip_mm, arm.pen.clearance_mm, look, **part)
    return _on_paper(trajectory, arm, tip_mm, kind, options, look)


def _on_paper(
    trajectory: Trajectory, arm: Arm, tip_mm: FloatArray, kind: str, options: argparse.Namespace, look: Look
) -> Figure:
    from planner.drawing.svg import read_drawing

    drawing = read_drawing(options.drawing) if options.drawing else None
    canvas, reach_mm = _paper_of(arm)
    if kind == "speed":
        from planner.plots.coloured_path import plot_speed

        return plot_speed(trajectory, tip_mm, canvas, reach_mm, look)
    if kind == "error" and drawing is not None:
        from planner.checking.coverage import distance_from_drawing
        from planner.plots.coloured_path import plot_error

        return plot_error(
            trajectory,
            tip_mm,
            distance_from_drawing(trajectory, drawing, tip_mm),
            options.tolerance or PlanSettings().tolerance_mm,
            canvas,
            reach_mm,
            look,
        )
    from planner.plots.drawing import plot_drawing

    return plot_drawing(trajectory, tip_mm, drawing, canvas, reach_mm, look)


def _paper_of(arm: Arm) -> tuple[FloatArray | None, tuple[float, float] | None]:
    """Canvas corners and reach; None for an arm without: a trajectory from elsewhere can be shown all the same."""
    from planner.redundancy.arm_model import ArmModel
    from planner.workspace.reach import paper_in_reach

    try:
        paper = paper_in_reach(ArmModel(arm))
    except PlanError:
        return None, None
    return paper.corners_arm_mm, paper.reach_mm


def _tip_mm(trajectory: Trajectory, arm: Arm) -> FloatArray:
    from planner.checking.chain import chain_poses

    return chain_poses(arm, arm.from_file_units(trajectory.positions)).tip_mm.T


def _workspace(arm: Arm, look: Look) -> Figure:
    from planner.plots.workspace import plot_workspace
    from planner.redundancy.arm_model import ArmModel
    from planner.settings import CanvasKind
    from planner.workspace.canvas import canvas_of
    from planner.workspace.paper_map import paper_map
    from planner.workspace.reach import paper_in_reach

    model = ArmModel(arm)
    reach_mm = paper_in_reach(model).reach_mm
    canvases = {}
    for kind in CanvasKind:
        try:
            canvases[kind] = canvas_of(model, kind, arm.pen.lift_mm).corners_arm_mm
        except PlanError:  # a narrow ring has no documented canvas
            continue
    return plot_workspace(arm.name, paper_map(model), canvases, reach_mm, look)


def _film(trajectory: Trajectory, arm: Arm, options: argparse.Namespace, look: Look) -> None:
    from planner.plots.film_file import save_film
    from planner.plots.motion import motion_of

    canvas, reach_mm = _paper_of(arm)
    motion = motion_of(
        trajectory,
        arm,
        _tip_mm(trajectory, arm),
        speed_factor=options.speed_factor,
        fps=options.fps,
        from_s=options.from_s,
        to_s=options.to_s,
    )
    with progress(quiet=options.quiet) as show:
        save_film(motion, options.output, canvas, reach_mm, look, show)
