"""`plan DRAWING.svg -o traj.csv`: the bare command."""

from __future__ import annotations

import argparse
from pathlib import Path

from planner import DISTRIBUTION, __version__
from planner.cli.files import STANDARD_INPUT, input_file, output_file
from planner.cli.interrupts import interrupts_remembered
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import (
    angle_deg,
    configuration_weights,
    length_mm,
    number,
    speed_mm_s,
)
from planner.cli.report import check_report, write_report_of
from planner.cli.terminal import print_summary, print_warnings, progress
from planner.cli.workers import add_workers_option
from planner.files import STANDARD
from planner.progress import of_all_stages
from planner.settings import (
    MAX_RATE_HZ,
    MIN_RATE_HZ,
    MIN_TOLERANCE_MM,
    CanvasKind,
    Method,
    PlanSettings,
)

_DESCRIPTION = """\
Plan the motion of an arm that draws DRAWING.svg with a pen, and write it as a trajectory of joint positions.

other commands (each has its own --help; a drawing of that name is planned as ./NAME):
  plan batch FOLDER         plan every drawing of a folder
  plan run traj.csv         play a trajectory on the simulated arm
  plan pattern --arm ARM    a trajectory of marks to calibrate an arm with
  plan calibrate ARM        an arm file from marks that the arm made
  plan predict traj.csv     how well an arm is going to draw
  plan jog --arm ARM        one joint at a time, on the first day of an arm
  plan ports                list the serial devices that are plugged in
  plan check traj.csv       an independent check of a trajectory
  plan plot traj.csv -o F   pictures of a trajectory
  plan compare DRAWING.svg  the same points by every method of inverse kinematics
  plan measure PHOTO        where the marks of a calibration sheet came
  plan arm [NAME]           list the arms, or describe one"""

_EPILOG = """\
examples:
  plan flower.svg                                  writes flower.csv into the current folder
  plan flower.svg -o traj.csv --arm my_arm.toml    for an arm of your own
  plan flower.svg --speed 4cm/s --margin 0.5in --rotate 90
  plan flower.svg -o traj.csv --report flower      and a page about it, flower/index.html
  draw | plan - > traj.csv                         from a program that writes an SVG, as part of a pipe
  plan city.svg --workers 4                        with four processes; the result does not depend on them
  plan flower.svg --weights sensitivity=0          configurations for speed rather than for fine lines
  plan flower.svg --no-fit --skip-unreachable      at its true size, what is out of reach left out

Lengths are in mm, or carry one of the suffixes mm cm in px (96 px to the inch).

exit codes: 0 done; 1 a check found fault; 2 unusable input or usage; 3 cannot be planned;
4 hardware fault; 70 a defect of the planner, or a damaged installation; 130 interrupted"""


def plan(arguments: list[str]) -> int:
    """Plan one drawing. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    drawing: Path = options.drawing
    target: Path = options.output or (Path(STANDARD) if drawing == STANDARD_INPUT else Path(f"{drawing.stem}.csv"))
    check_target(target, drawing)
    if options.report:
        check_report(options.report, drawing, target)
    settings = settings_of(options)

    from planner.pipeline import plan as plan_drawing
    from planner.trajectory import write_trajectory

    with progress(quiet=options.quiet, single=True) as show, interrupts_remembered() as raise_if_interrupted:

        def report(stage: str, done: int, total: int) -> None:
            raise_if_interrupted()
            show(stage, *of_all_stages(stage, done, total))

        planned = plan_drawing(drawing, settings, report, options.workers)
        raise_if_interrupted()
        write_trajectory(planned.trajectory, target)
        written = [target]
        if options.report:
            report("report", 0, 1)
            written.append(write_report_of(planned, settings, arguments, options.report))
    print_warnings(planned.summary.warnings)
    if not options.quiet:
        wrote = [f"wrote {file}" for file in written if str(file) != STANDARD]
        print_summary([*planned.summary.lines(), *wrote], target)
    return 0


def settings_of(options: argparse.Namespace) -> PlanSettings:
    """The settings that options from `add_plan_options` amount to."""
    return PlanSettings(
        arm=options.arm,
        method=Method(options.method),
        rate_hz=options.rate,
        tolerance_mm=options.tolerance,
        speed_mm_s=options.speed,
        lowering_speed_mm_s=options.lowering_speed,
        dwell_s=options.dwell,
        lift_mm=options.lift,
        canvas=CanvasKind(options.canvas),
        fit=options.fit,
        margin_mm=options.margin,
        rotate_deg=options.rotate,
        skip_unreachable=options.skip_unreachable,
        weights=options.weights,
    )


def _parser() -> Parser:
    parser = Parser("plan", _DESCRIPTION, _EPILOG)
    parser.usage = (
        "plan DRAWING.svg [-o traj.csv] [options]\n"
        "       plan batch|run|pattern|measure|calibrate|predict|jog|ports|check|plot|compare|arm ..."
    )
    parser.add_argument(
        "drawing", type=input_file, metavar="DRAWING.svg", help="the drawing, gzipped or not; - for standard input"
    )
    parser.add_argument(
        "--version", action="version", version=f"{DISTRIBUTION} {__version__}", help="print name and version"
    )
    parser.add_argument(
        "-o",
        "--output",
        type=output_file,
        metavar="FILE",
        help="the trajectory, - for standard output (default: the drawing's name with .csv, in the"
        " current folder; of a drawing from standard input, standard output)",
    )
    parser.add_argument(
        "--report",
        type=output_file,
        metavar="DIR",
        help="write DIR/index.html too: a page with summary, pictures, tables and the result of the check",
    )
    add_plan_options(parser)
    return parser


def add_plan_options(parser: Parser) -> None:
    """The options that say how drawings are planned, whether one or many."""
    add_workers_option(parser)
    parser.add_argument("--quiet", action="store_true", help="no progress and no summary, only warnings and errors")
    parser.add_argument(
        "--method",
        choices=[method.value for method in Method],
        default=PlanSettings().method.value,
        help="how configurations are found (default: %(default)s)",
    )
    add_arm_and_placement_options(parser)


def add_arm_and_placement_options(parser: Parser) -> None:
    """The options that have a meaning whatever method finds the configurations."""
    default = PlanSettings()
    parser.add_argument(
        "--arm",
        default=default.arm,
        metavar="NAME|FILE",
        help="an arm by name, or its .toml file (default: %(default)s)",
    )
    motion = parser.add_argument_group("motion")
    motion.add_argument(
        "--weights",
        type=configuration_weights,
        default=default.weights,
        metavar="NAME=W,...",
        help="what method path spends spare joints on: time, sensitivity (of the drawing to joints that run late or"
        " stand wrong), reversals (of joints), limits (distance from them); those not named weigh 1, reversals 0",
    )
    motion.add_argument(
        "--rate",
        type=number(minimum=MIN_RATE_HZ, maximum=MAX_RATE_HZ),
        default=default.rate_hz,
        metavar="HZ",
        help="samples a second (default: %(default)g)",
    )
    motion.add_argument(
        "--tolerance",
        type=length_mm(minimum_mm=MIN_TOLERANCE_MM),
        default=default.tolerance_mm,
        metavar="LENGTH",
        help="how far the pen may be off the drawing (default: %(default)g mm)",
    )
    motion.add_argument(
        "--speed",
        type=speed_mm_s,
        default=default.speed_mm_s,
        metavar="SPEED",
        help="fastest motion of the pen on the paper (default: the arm's own)",
    )
    motion.add_argument(
        "--lift",
        type=length_mm(),
        default=default.lift_mm,
        metavar="LENGTH",
        help="height of the pen while travelling (default: the arm's own)",
    )
    motion.add_argument(
        "--lowering-speed",
        type=speed_mm_s,
        default=default.lowering_speed_mm_s,
        metavar="SPEED",
        help="fastest lowering of the pen (default: %(default)g mm/s)",
    )
    motion.add_argument(
        "--dwell",
        type=number(zero=True),
        default=default.dwell_s,
        metavar="SECONDS",
        help="rest on the paper after lowering (default: %(default)g s)",
    )

    placement = parser.add_argument_group("placement")
    placement.add_argument(
        "--canvas",
        choices=[kind.value for kind in CanvasKind],
        default=default.canvas.value,
        help="the rectangle of the paper to draw on (default: %(default)s)",
    )
    placement.add_argument(
        "--fit",
        action=argparse.BooleanOptionalAction,
        default=default.fit,
        help="scale the drawing to the canvas, or keep its true size (default: --fit)",
    )
    placement.add_argument(
        "--margin",
        type=length_mm(zero=True),
        default=default.margin_mm,
        metavar="LENGTH",
        help="kept free along the edges of the canvas (default: %(default)g mm)",
    )
    placement.add_argument(
        "--rotate",
        type=angle_deg,
        default=default.rotate_deg,
        metavar="DEGREES",
        help="turn the drawing before placing it (default: %(default)g)",
    )
    placement.add_argument(
        "--skip-unreachable",
        action="store_true",
        help="leave out what the arm cannot reach, and say so, instead of failing",
    )
