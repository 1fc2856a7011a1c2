"""`plan plot traj.csv -o FILE`: pictures and films of a trajectory, and pictures of the workspace of an arm."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from planner.cli.files import input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import length_mm, number
from planner.cli.terminal import progress, waiting
from planner.errors import UsageError
from planner.pictures import PlotKind, figure_of, film_to_file, motion_for_film, workspace_figure
from planner.settings import MIN_TOLERANCE_MM, PlanSettings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from planner.arms.arm import Arm
    from planner.plots.look import Look
    from planner.trajectory import Trajectory

_DESCRIPTION = """\
Draw a trajectory, or play it in a film. Or, with --kind workspace and no trajectory, draw how well an arm moves over
its paper.

kinds:
  sheet      the paper as it will look: ink in its colours, as wide as the pens draw, with rulers
  profiles   position, velocity, acceleration and jerk of every joint, with their limits
  drawing    the same on the paper before the arm, over what was to be drawn, with the way of the lifted pen
  speed      the pen's path with its speed as colour
  error      how far the pen is off the drawing, on the paper and along the way
  phase      the pen's speed along one stroke, under what the joints allow on that path
  timeline   when the arm lowers, rests, draws, lifts and travels, with totals
  film       the arm as it draws, from above and from the side
  workspace  the reach of an arm, its canvases, and how freely and how surely the pen moves"""

_EPILOG = """\
examples:
  plan plot traj.csv -o profiles.png
  plan plot traj.csv -o sheet.png --kind sheet
  plan plot traj.csv -o start.png --from 0 --to 2.5
  plan plot traj.csv -o drawn.svg --kind drawing --drawing flower.svg
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
_KINDS = (*(kind.value for kind in PlotKind), "film", "workspace")
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
    from planner.plots.figure_file import save_figure
    from planner.plots.look import Look, Size, Theme
    from planner.plots.samples import require_joints
    from planner.trajectory import read_trajectory

    look = Look.of(Theme(options.theme), Size(options.size), options.dpi or (_FILM_DPI if kind == "film" else None))
    _check_format(target, kind)
    if kind == _WITHOUT_TRAJECTORY:
        with waiting("drawing", quiet=options.quiet):
            save_figure(workspace_figure(load_arm(options.arm or DEFAULT_ARM), look), target, look)
        return 0
    with waiting("reading", quiet=options.quiet):
        trajectory = read_trajectory(options.trajectory)
    arm = load_arm(options.arm or trajectory.arm)
    require_joints(trajectory, arm)
    if kind == "film":
        _film(trajectory, arm, options, look)
        return 0
    with waiting("drawing", quiet=options.quiet):
        save_figure(_figure(trajectory, arm, kind, options, look), target, look)
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
    parser.add_argument("--quiet", action="store_true", help="no progress")
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
    from planner.drawing.svg import read_drawing

    return figure_of(
        trajectory,
        arm,
        PlotKind(kind),
        look,
        drawing=read_drawing(options.drawing, options=trajectory.reading) if options.drawing else None,
        tolerance_mm=options.tolerance or PlanSettings().tolerance_mm,
        stroke=options.stroke,
        from_s=options.from_s,
        to_s=options.to_s,
    )


def _film(trajectory: Trajectory, arm: Arm, options: argparse.Namespace, look: Look) -> None:
    motion = motion_for_film(
        trajectory,
        arm,
        speed_factor=options.speed_factor,
        fps=options.fps,
        from_s=options.from_s,
        to_s=options.to_s,
    )
    with progress(quiet=options.quiet) as show:
        film_to_file(motion, options.output, look, show)
