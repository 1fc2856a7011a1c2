"""`plan lines DRAWING.svg`: what would be drawn, before it is placed."""

from __future__ import annotations

from pathlib import Path
from typing import IO, cast

from planner.cli.files import input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import length_mm
from planner.cli.reading import add_reading_options, reading_of
from planner.cli.terminal import print_summary, print_warnings, waiting
from planner.counted import counted
from planner.errors import UsageError

_DESCRIPTION = """\
Write what would be drawn of DRAWING.svg as plain lines: in millimetres on its page, x to the right and y down from the
corner at the top left, in the order of painting, before it is placed on paper and put in an order for the pen. Curves
are short straight lines. Layers and colours are kept. To look at, and for other programs."""

_EPILOG = """\
examples:
  plan lines flower.svg -o lines.svg                an SVG of polylines alone
  plan lines flower.svg --json lines.json --text outline --occlude
  plan lines flower.svg -o - | vpype read - linesort write sorted.svg

The JSON is {"page_mm": [width, height], "has_page": whether the file has one, "lines": [{"points": [[x, y], ...],
"layer": name, "colour": "#rrggbb"}], "skipped": {kind: count}}; a tap is a line of one point.

exit codes: 0 done; 2 unusable input or usage"""

_CHORD_ERROR_MM = 0.005
_MIN_CHORD_ERROR_MM = 1e-5


def lines(arguments: list[str]) -> int:
    """Write the lines of one drawing. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    targets: list[Path] = [*filter(None, (options.output, options.json))]
    if not targets:
        raise UsageError("-o FILE.svg or --json FILE says where the lines go; - is standard output")
    if len(targets) == 2 and targets[0] == targets[1]:
        raise UsageError(f"-o and --json name the same file, {targets[0]}")
    for target in targets:
        check_target(target, options.drawing)
    reading = reading_of(options)

    from planner.drawing.image.lines import with_images
    from planner.drawing.plain_lines import as_json, as_svg, plain_lines
    from planner.drawing.svg import read_drawing
    from planner.files import written_aside

    with waiting("reading", quiet=options.quiet):
        drawing = read_drawing(options.drawing, options=reading)
        drawing = with_images(drawing, drawing.user_to_page)
        found = plain_lines(drawing, options.tolerance)
    with waiting("writing", quiet=options.quiet):
        for target, written in ((options.output, as_svg), (options.json, as_json)):
            if target is not None:
                with written_aside(target) as file:
                    cast("IO[str]", file).write(written(drawing, found))
    print_warnings(drawing.notes())
    if not options.quiet:
        n_taps = sum(len(line.points_mm) == 1 for line in found)
        width, height = drawing.page_mm
        print_summary(
            [
                f"{counted(len(found) - n_taps, 'line')} and {counted(n_taps, 'tap')} on a page of {width:.4g} x"
                f" {height:.4g} mm"
            ],
            *targets,
        )
    return 0


def _parser() -> Parser:
    parser = Parser("plan lines", _DESCRIPTION, _EPILOG)
    parser.add_argument(
        "drawing", type=input_file, metavar="DRAWING.svg", help="the drawing, gzipped or not; - for standard input"
    )
    parser.add_argument("-o", "--output", type=output_file, metavar="FILE", help="the lines as an SVG")
    parser.add_argument("--json", type=output_file, metavar="FILE", help="the lines as JSON")
    parser.add_argument(
        "--tolerance",
        type=length_mm(minimum_mm=_MIN_CHORD_ERROR_MM),
        default=_CHORD_ERROR_MM,
        metavar="LENGTH",
        help="how far straight lines may be off the curves (default: %(default)g mm)",
    )
    parser.add_argument("--quiet", action="store_true", help="no summary, only warnings and errors")
    add_reading_options(parser)
    return parser
