"""`plan DRAWING.svg -o traj.csv`: the bare command."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from planner import DISTRIBUTION, __version__
from planner.cli.events import add_events_option, refuse_events_among_results, tell_summary, told_progress
from planner.cli.files import STANDARD_INPUT, input_file, output_file
from planner.cli.interrupts import interrupts_remembered
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.plan_options import add_plan_options, preferred, settings_of
from planner.cli.reading import reading_of
from planner.cli.report import check_report, write_report_of
from planner.cli.sheets import check_tile
from planner.cli.terminal import print_lines, print_summary, print_warnings, progress, waiting
from planner.errors import UsageError
from planner.files import STANDARD
from planner.progress import of_all_stages

if TYPE_CHECKING:
    from planner.drawing.options import ReadingOptions
    from planner.pipeline import Plan
    from planner.tiled_plan import TiledPlan
    from planner.trajectory import Trajectory

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
  plan identify --arm ARM   a test motion that finds the limits of its joints
  plan predict traj.csv     how well an arm is going to draw
  plan jog --arm ARM        one joint at a time, on the first day of an arm
  plan serve                a page to place, plan, watch and run drawings on
  plan ports                list the serial devices that are plugged in
  plan check traj.csv       an independent check of a trajectory
  plan plot traj.csv -o F   pictures of a trajectory
  plan compare DRAWING.svg  the same points by every method of inverse kinematics
  plan fonts                the single-line faces that text is written in
  plan measure PHOTO        where the marks of a calibration sheet came
  plan arm [NAME]           list the arms, or describe one
  plan paper --arm ARM      where to lay the paper, as a sheet to print
  plan estimate FOLDER      how long each drawing takes, without writing anything
  plan inkscape             install the extension for Inkscape
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
  plan photo.jpg --image scribble --image-ink 60%  a picture as one line that never lifts
  plan flower.svg --no-fit --skip-unreachable      at its true size, what is out of reach left out
  plan flower.svg --paper a6 --align top-left      at the top left of a sheet
  plan map.svg --list-layers                       what there is to draw, with colours
  plan map.svg --layers sea,2 --by layer           two of them, and a halt for the pen between
  plan map.svg --by colour --pens pens.toml        the pens that there are, each for the colours nearest to it
  plan map.svg --by width --split                  a trajectory for each width of stroke
  plan logo.svg --fill hatch --fill-spacing 0.6mm  areas filled, and not their edges alone
  plan logo.svg --fill spiral --fill-by lightness --stroke-width passes
  plan old.svg --join 0.2mm --dedup --simplify 0.1mm --min-length 1mm
  plan ink.svg --passes 2 --keep-order             twice over each line, in the order of the file
  plan flower.svg --preset fast                    options that you gave a name (plan config)
  vpype read x.svg write -f svg - | plan - | plan run -
  plan stamp.svg --at 20 15 --copies 3x2           six of them at true size, the first 20 mm right and 15 mm down
  plan flower.svg --place best --scale 0.5         turned and moved to where it is drawn soonest and most accurately
  plan poster.svg --tile -o poster.csv             at its true size, on as many sheets as that takes
  plan flower.svg --tile --paper a3                fills an A3 that is put together from sheets

Lengths are in mm, or carry one of the suffixes mm cm in px (96 px to the inch).

exit codes: 0 done; 1 a check found fault; 2 unusable input or usage; 3 cannot be planned;
4 hardware fault; 70 a defect of the planner, or a damaged installation; 130 interrupted"""


def plan(arguments: list[str]) -> int:
    """Plan one drawing. Errors: PlannerError."""
    options = preferred(plan_parser(), arguments)
    drawing: Path = options.drawing
    target: Path = options.output or (Path(STANDARD) if drawing == STANDARD_INPUT else Path(f"{drawing.stem}.csv"))
    if options.list_layers:
        with waiting("reading", quiet=options.quiet):
            found = _layers(drawing, reading_of(options))
        print_lines(found)
        return 0
    check_target(target, drawing)
    refuse_events_among_results(options, target)
    if options.split and target == Path(STANDARD):
        raise UsageError("--split writes a file for each pen: name one with -o")
    if options.report:
        check_report(options.report, drawing, target)
    settings = settings_of(options)
    if options.tile:
        check_tile(settings, target)
    last = "report" if options.report else "writing"

    with (
        told_progress() if options.events else progress(quiet=options.quiet) as show,
        interrupts_remembered() as raise_if_interrupted,
    ):

        def report(stage: str, done: int, total: int) -> None:
            raise_if_interrupted()
            show(stage, *((done, total) if options.tile else of_all_stages(stage, done, total, last)))

        report("reading", 0, 1)
        from planner.pipeline import plan as plan_drawing
        from planner.trajectory import write_trajectory

        planned: Plan | TiledPlan
        if options.tile:
            from planner.tiled_plan import plan_tiles

            planned = plan_tiles(drawing, settings, report, options.workers)
            plans = {f"{sheet.tile}": sheet.plan for sheet in planned.sheets}
        else:
            planned = plan_drawing(drawing, settings, report, options.workers)
            plans = {"": planned}
        raise_if_interrupted()
        made: dict[Path, Trajectory] = {}
        for sheet, one in plans.items():
            file = target.with_name(f"{target.stem}-{sheet}{target.suffix}") if sheet else target
            if options.split and one.by_pen:
                made |= {_of_pen(file, index, part): part for index, part in enumerate(one.by_pen, 1)}
            else:
                made[file] = one.trajectory
        for file in made:
            check_target(file, drawing)
        for index, (file, trajectory) in enumerate(made.items()):
            report("writing", index, len(made))
            write_trajectory(trajectory, file)
        written = list(made)
        if options.report:
            for sheet, one in plans.items():
                written.append(
                    write_report_of(one, settings, arguments, options.report / sheet, partial(report, "report"))
                )
    print_warnings(planned.warnings)
    if options.events:
        tell_summary(planned.lines(), map(str, written))
    elif not options.quiet:
        wrote = [f"wrote {file}" for file in written if str(file) != STANDARD]
        print_summary([*planned.lines(), *wrote], target)
    return 0


def _of_pen(target: Path, index: int, part: Trajectory) -> Path:
    """The file of one pen's part: numbered, and with its name as far as file names hold it."""
    name = re.sub(r"[^\w.-]+", "-", part.pens[0].name).strip("-.")[:40]
    return target.with_name(f"{target.stem}_{index}{'_' if name else ''}{name}{target.suffix}")


def _layers(drawing_file: Path, reading: ReadingOptions) -> list[str]:
    from planner.drawing.flatten import flatten_all
    from planner.drawing.image.lines import with_images
    from planner.drawing.pen_groups import described
    from planner.drawing.svg import read_drawing
    from planner.polyline_length import polyline_length

    drawing = read_drawing(drawing_file, options=reading)
    drawing = with_images(drawing, drawing.user_to_page)
    return described(
        drawing, lambda outlines: sum(map(polyline_length, flatten_all(outlines, drawing.user_to_page, _CHORD_MM)))
    )


def plan_parser() -> Parser:
    """The parser of the bare command."""
    parser = Parser("plan", _DESCRIPTION, _EPILOG)
    parser.usage = (
        "plan DRAWING.svg [-o traj.csv] [options]\n"
        "       plan batch|lines|run|pattern|measure|calibrate|predict|jog|ports|check|serve|mcp ...\n"
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
        help="write DIR/index.html too: a page with the sheet, where to lay it, time, pens, accuracy, film and check",
    )
    parser.add_argument("--list-layers", action="store_true", help="print the drawing's layers, and plan nothing")
    parser.add_argument(
        "--split", action="store_true", help="a trajectory for each pen, traj_PEN.csv, instead of one with halts"
    )
    parser.add_argument(
        "--tile",
        action="store_true",
        help="cut a page or a --paper larger than the canvas into sheets with register marks, each a trajectory of its"
        " own, traj-COLUMN-ROW.csv",
    )
    add_plan_options(parser)
    add_events_option(parser)
    return parser
