"""`plan DRAWING.svg -o traj.csv`: the bare command."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING

from planner import DISTRIBUTION, __version__
from planner.cli.files import STANDARD_INPUT, input_file, output_file
from planner.cli.interrupts import interrupts_remembered
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.preferences import preferences_for, with_preferences
from planner.cli.quantities import (
    angle_deg,
    configuration_weights,
    coordinate_mm,
    grid,
    length_mm,
    names,
    number,
    paper,
    pens_file,
    scale,
    speed_mm_s,
    whole_number,
)
from planner.cli.reading import add_reading_options, reading_of
from planner.cli.report import check_report, write_report_of
from planner.cli.terminal import print_lines, print_summary, print_warnings, progress
from planner.cli.workers import add_workers_option
from planner.drawing.fill_options import (
    LEAST_SPACING_MM,
    USUAL_SPACING_MM,
    FillBy,
    FillKind,
    FillOptions,
    WideStrokes,
)
from planner.errors import UsageError
from planner.files import STANDARD
from planner.paper_size import Orientation
from planner.pens import GroupBy
from planner.progress import of_all_stages
from planner.settings import (
    MAX_RATE_HZ,
    MIN_RATE_HZ,
    MIN_TOLERANCE_MM,
    Anchor,
    CanvasKind,
    Method,
    PlaceKind,
    PlanSettings,
)

if TYPE_CHECKING:
    from planner.trajectory import Trajectory

USUAL_DEDUP_MM = 0.05
_CHORD_MM = 0.01
"""What curves are off by where their lengths are listed."""

_DESCRIPTION = """\
Plan the motion of an arm that draws DRAWING.svg with a pen, and write it as a trajectory of joint positions.

other commands (each has its own --help; a drawing of that name is planned as ./NAME):
  plan batch FOLDER         plan every drawing of a folder
  plan lines DRAWING.svg    what would be drawn, as plain lines on the page
  plan run traj.csv         play a trajectory on the simulated arm
  plan pattern --arm ARM    a trajectory of marks to calibrate an arm with
  plan calibrate ARM        an arm file from marks that the arm made
  plan predict traj.csv     how well an arm is going to draw
  plan jog --arm ARM        one joint at a time, on the first day of an arm
  plan ports                list the serial devices that are plugged in
  plan check traj.csv       an independent check of a trajectory
  plan plot traj.csv -o F   pictures of a trajectory
  plan compare DRAWING.svg  the same points by every method of inverse kinematics
  plan fonts                the single-line faces that text is written in
  plan measure PHOTO        where the marks of a calibration sheet came
  plan arm [NAME]           list the arms, or describe one
  plan paper --arm ARM      where to lay the paper, as a sheet to print
  plan estimate FOLDER      how long each drawing takes, without writing anything
  plan config               which options are in force, and where each is said"""

_EPILOG = """\
examples:
  plan flower.svg                                  writes flower.csv into the current folder
  plan flower.svg -o traj.csv --arm my_arm.toml    for an arm of your own
  plan flower.svg --speed 4cm/s --margin 0.5in --rotate 90
  plan flower.svg -o traj.csv --report flower      and a page about it, flower/index.html
  draw | plan - > traj.csv                         from a program that writes an SVG, as part of a pipe
  plan city.svg --workers 4                        with four processes; the result does not depend on them
  plan flower.svg --weights sensitivity=0          configurations for speed rather than for fine lines
  plan letter.svg --text outline --font Lora.ttf   letters as the outlines of a font, not as single lines
  plan flower.svg --no-fit --skip-unreachable      at its true size, what is out of reach left out
  plan flower.svg --paper a6 --align top-left      at the top left of a sheet
  plan stamp.svg --at 20 15 --copies 3x2           six of them at true size, the first 20 mm right and 15 mm down

Lengths are in mm, or carry one of the suffixes mm cm in px (96 px to the inch).

exit codes: 0 done; 1 a check found fault; 2 unusable input or usage; 3 cannot be planned;
4 hardware fault; 70 a defect of the planner, or a damaged installation; 130 interrupted"""


def plan(arguments: list[str]) -> int:
    """Plan one drawing. Errors: PlannerError."""
    options = preferred(plan_parser(), arguments)
    drawing: Path = options.drawing
    target: Path = options.output or (Path(STANDARD) if drawing == STANDARD_INPUT else Path(f"{drawing.stem}.csv"))
    if options.list_layers:
        print_lines(_layers(drawing))
        return 0
    check_target(target, drawing)
    if options.split and target == Path(STANDARD):
        raise UsageError("--split writes a file for each pen: name one with -o")
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
        made = {target: planned.trajectory}
        if options.split and planned.by_pen:
            made = {_of_pen(target, index, part): part for index, part in enumerate(planned.by_pen, 1)}
        for file, trajectory in made.items():
            check_target(file, drawing)
            write_trajectory(trajectory, file)
        written = list(made)
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
        place=PlaceKind(options.place),
        fit=options.fit,
        scale=options.scale,
        paper=options.paper,
        orientation=Orientation(options.orientation),
        align=Anchor(options.align),
        at_mm=tuple(options.at) if options.at else None,
        origin=Anchor(options.origin),
        copies=options.copies,
        mirror=options.mirror,
        margin_mm=options.margin,
        rotate_deg=options.rotate,
        join_mm=options.join,
        dedup_mm=options.dedup or 0.0,
        simplify_mm=options.simplify,
        min_length_mm=options.min_length,
        passes=options.passes,
        keep_order=options.keep_order,
        reverse=options.reverse,
        fill=fill_of(options),
        layers=options.layers,
        by=None if options.by is None else GroupBy(options.by),
        pens=options.pens,
        skip_unreachable=options.skip_unreachable,
        weights=options.weights,
        reading=reading_of(options),
    )


def _of_pen(target: Path, index: int, part: Trajectory) -> Path:
    """The file of one pen's part: numbered, and with its name as far as file names hold it."""
    name = re.sub(r"[^\w.-]+", "-", part.pens[0].name).strip("-.")[:40]
    return target.with_name(f"{target.stem}_{index}{'_' if name else ''}{name}{target.suffix}")


def _layers(drawing_file: Path) -> list[str]:
    from planner.drawing.flatten import flatten_all
    from planner.drawing.pen_groups import described
    from planner.drawing.svg import read_drawing
    from planner.polyline_length import polyline_length

    drawing = read_drawing(drawing_file)
    return described(
        drawing, lambda outlines: sum(map(polyline_length, flatten_all(outlines, drawing.user_to_page, _CHORD_MM)))
    )


def preferred(parser: Parser, arguments: list[str]) -> argparse.Namespace:
    """The options, with what people prefer where `arguments` say nothing. Errors: UsageError."""
    said = parser.parse_args(arguments)
    place: Path = said.drawing if "drawing" in said else said.folder
    return with_preferences(parser, arguments, preferences_for(place), said.preset)[0]


def plan_parser() -> Parser:
    """The parser of the bare command."""
    parser = Parser("plan", _DESCRIPTION, _EPILOG)
    parser.usage = (
        "plan DRAWING.svg [-o traj.csv] [options]\n"
        "       plan batch|lines|run|pattern|measure|calibrate|predict|jog|ports|check ...\n"
        "       plan plot|compare|fonts|arm|paper|estimate|config ..."
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
    parser.add_argument("--list-layers", action="store_true", help="print the drawing's layers, and plan nothing")
    parser.add_argument(
        "--split", action="store_true", help="a trajectory for each pen, traj_PEN.csv, instead of one with halts"
    )
    add_plan_options(parser)
    return parser


def add_plan_options(parser: Parser) -> None:
    """The options that say how drawings are planned, whether one or many."""
    add_workers_option(parser)
    parser.add_argument("--preset", metavar="NAME", help="options by a name of yours (see plan config --help)")
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

    add_reading_options(parser)
    add_placement_options(parser.add_argument_group("placement"))
    add_pen_options(parser.add_argument_group("layers and pens"))
    add_path_options(parser.add_argument_group("lines"))
    add_fill_options(parser.add_argument_group("fills"))


def add_pen_options(pens: argparse._ArgumentGroup) -> None:
    """The options that say which layers are drawn, and with which pens."""
    pens.add_argument(
        "--layers",
        type=names,
        metavar="NAME,...",
        help="draw these layers alone, by name or by the number that their names begin with (default: all but those"
        " whose names begin with %%)",
    )
    pens.add_argument(
        "--by",
        choices=[by.value for by in GroupBy],
        help="a pen for each layer, colour or width; between two the arm parks, and you are asked for the next",
    )
    pens.add_argument(
        "--pens",
        type=pens_file,
        default=(),
        metavar="FILE",
        help="the pens that there are: tables [[pen]] with name, colour, width_mm, speed_mm_s, lift_mm,"
        " lowering_speed_mm_s, layers; each draws the layers it names, or the colours or widths nearest to it",
    )


def add_fill_options(fills: argparse._ArgumentGroup) -> None:
    """The options that say how areas are filled."""
    default = PlanSettings().fill
    fills.add_argument(
        "--fill",
        choices=[kind.value for kind in FillKind],
        default=default.kind.value,
        help="lines across areas that the drawing fills (default: their edges alone)",
    )
    fills.add_argument(
        "--fill-angle", type=angle_deg, default=default.angle_deg, metavar="DEGREES", help="(default: %(default)g)"
    )
    fills.add_argument(
        "--fill-spacing",
        type=length_mm(minimum_mm=LEAST_SPACING_MM),
        metavar="LENGTH",
        help=f"between lines (default: the width of the finest of --pens, or {USUAL_SPACING_MM:g} mm)",
    )
    fills.add_argument(
        "--fill-inset", type=length_mm(zero=True), metavar="LENGTH", help="from the edge (default: half the spacing)"
    )
    fills.add_argument(
        "--fill-by",
        choices=[by.value for by in FillBy],
        default=default.by.value,
        help="lightness: darker is denser; colour: each has an angle of its own (default: all are alike)",
    )
    fills.add_argument(
        "--stroke-width",
        choices=[how.value for how in WideStrokes],
        default=default.wide_strokes.value,
        help="strokes wider than the pen's line (the spacing) are drawn once, or in passes side by side"
        " (default: %(default)s)",
    )


def fill_of(options: argparse.Namespace) -> FillOptions:
    """The fill that options from `add_fill_options` amount to."""
    widths_mm = [pen.width_mm for pen in options.pens if pen.width_mm]
    usual_mm = max(min(widths_mm, default=USUAL_SPACING_MM), LEAST_SPACING_MM)
    return FillOptions(
        FillKind(options.fill),
        options.fill_angle,
        usual_mm if options.fill_spacing is None else options.fill_spacing,
        options.fill_inset,
        FillBy(options.fill_by),
        WideStrokes(options.stroke_width),
    )


def add_path_options(lines: argparse._ArgumentGroup) -> None:
    """The options that say what is done to lines before they are drawn."""
    default = PlanSettings()
    lines.add_argument(
        "--join", type=length_mm(zero=True), metavar="LENGTH", help="join ends that are nearer (default: that touch)"
    )
    lines.add_argument(
        "--dedup",
        type=length_mm(zero=True),
        nargs="?",
        const=USUAL_DEDUP_MM,
        metavar="LENGTH",
        help=f"draw one of lines that run within so much of each other (without a length: {USUAL_DEDUP_MM:g} mm)",
    )
    lines.add_argument(
        "--simplify",
        type=length_mm(zero=True),
        default=default.simplify_mm,
        metavar="LENGTH",
        help="drop points that change a line by less, beside the tolerance",
    )
    lines.add_argument(
        "--min-length",
        type=length_mm(zero=True),
        default=default.min_length_mm,
        metavar="LENGTH",
        help="leave out strokes that are shorter, taps aside",
    )
    lines.add_argument(
        "--passes", type=whole_number, default=default.passes, metavar="N", help="draw each line so often, pen down"
    )
    lines.add_argument("--keep-order", action="store_true", help="draw in the order of the drawing, nothing joined")
    lines.add_argument("--reverse", action="store_true", help="draw in the opposite order, each line backwards")


def add_placement_options(placement: argparse._ArgumentGroup) -> None:
    """The options that say where a drawing goes."""
    default = PlanSettings()
    anchors = [anchor.value for anchor in Anchor]
    placement.add_argument(
        "--canvas",
        choices=[kind.value for kind in CanvasKind],
        default=default.canvas.value,
        help="the rectangle of the paper to draw on (default: %(default)s)",
    )
    placement.add_argument(
        "--place",
        choices=[kind.value for kind in PlaceKind],
        default=default.place.value,
        help="what is placed: the drawing's page, ink wherever it is on it, so that drawings of one page land in"
        " register; or the extent of its ink, as for drawings without a page (default: %(default)s)",
    )
    placement.add_argument(
        "--fit",
        action=argparse.BooleanOptionalAction,
        default=default.fit,
        help="scale it to the room that there is, or keep its true size (default: --fit)",
    )
    placement.add_argument("--scale", type=scale, metavar="F", help="scale its true size by so much: 0.5, 50%%")
    placement.add_argument(
        "--paper",
        type=paper,
        metavar="SIZE",
        help="the sheet, amid the canvas: a0 to a10, letter, legal, 100x150, 4x6in",
    )
    placement.add_argument(
        "--orientation",
        choices=[kind.value for kind in Orientation],
        default=default.orientation.value,
        help="which way the paper lies (default: as the drawing)",
    )
    placement.add_argument(
        "--align",
        choices=anchors,
        default=default.align.value,
        metavar="WHERE",
        help=f"where it goes in what room there is: {', '.join(anchors)} (default: %(default)s)",
    )
    placement.add_argument(
        "--at",
        type=coordinate_mm,
        nargs=2,
        metavar=("X", "Y"),
        help="where it goes at its true size instead: to the right and down from the paper's top left corner",
    )
    placement.add_argument(
        "--origin",
        choices=anchors,
        default=default.origin.value,
        metavar="WHERE",
        help="which point of it goes to --at (default: %(default)s)",
    )
    placement.add_argument(
        "--copies",
        type=grid,
        default=default.copies,
        metavar="NxM",
        help="columns and rows of copies, a margin between",
    )
    placement.add_argument(
        "--margin",
        type=length_mm(zero=True),
        default=default.margin_mm,
        metavar="LENGTH",
        help="kept free along the edges of canvas and paper (default: %(default)g mm)",
    )
    placement.add_argument(
        "--rotate",
        type=angle_deg,
        default=default.rotate_deg,
        metavar="DEGREES",
        help="turn the drawing before placing it (default: %(default)g)",
    )
    placement.add_argument("--mirror", action="store_true", help="exchange left and right before turning it")
    placement.add_argument(
        "--skip-unreachable",
        action="store_true",
        help="leave out what the arm cannot reach, and say so, instead of failing",
    )
