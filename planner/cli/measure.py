"""`plan measure PHOTO --marks marks.csv -o measured.csv`: where the marks of a calibration sheet came."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from planner.cli.files import input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import length_mm
from planner.cli.terminal import print_note, print_warnings
from planner.errors import UsageError

if TYPE_CHECKING:
    from planner.error_model.sheet.marks import Mark

BAR_MM = 150.0
"""What `planner.error_model.sheet.layout` prints; told here too, so that no help has to load that."""

_DESCRIPTION = """\
Read a photo or a scan of a drawn calibration sheet: where each mark came on the sheet, and, by where the ink of its
stroke begins, how high the tip was over the paper. Any phone will do, held so that the whole sheet is in the picture;
tilt and lens are made up for. The result can as well be written by hand, with a ruler: one row a mark."""

_EPILOG = """\
examples:
  plan measure photo.jpg --marks marks.csv -o measured.csv
  plan measure photo.jpg --marks marks.csv -o measured.csv --picture reading.png
  plan measure scan.png --marks marks.csv -o measured.csv --bar 149.5,150.1

measured.csv: mark,x_mm,y_mm,h_mm,sd_mm; h_mm is the height of the tip over the paper at that mark, negative where it
pressed, and empty where it was not seen. Marks that were not found are left out, and named.

No photo can tell at what scale a sheet was printed: put a ruler to its two bars. They must be 150 mm; if they are not,
say with --bar how long they are, one length for both, or the one across the page and the one along it."""

_LONGEST_LIST = 12
_MOST_OFF = 0.15


def measure(arguments: list[str]) -> int:
    """Read one picture. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    source: Path = options.photo
    for target in filter(None, (options.output, options.picture)):
        check_target(target, source, options.marks)
    if options.picture and options.picture.absolute() == options.output.absolute():
        raise UsageError("-o and --picture name the same file")

    from planner.error_model.sheet.marks import read_marks

    marks = read_marks(options.marks)

    from planner.error_model.photo.measured_file import write_measured
    from planner.error_model.photo.picture import read_picture
    from planner.error_model.photo.reading import read_sheet

    if options.picture:
        from planner.plots.figure_file import picture_format

        picture_format(options.picture)
    picture = read_picture(source)
    reading = read_sheet(str(source), picture, marks, options.bar or (BAR_MM, BAR_MM))
    if options.picture:
        from planner.plots.figure_file import save_figure
        from planner.plots.reading import plot_reading

        save_figure(plot_reading(picture, reading, source.name), options.picture)
    write_measured(options.output, reading.measured)
    if not options.quiet:
        heights = sum(each.contact is not None for each in reading.measured)
        print_note(
            f"{len(reading.measured)} of {len(marks)} marks found on sheet {reading.layout.name}, "
            f"{heights} with a height"
        )
        if options.bar is None:
            print_note(
                f"check the bars on the sheet with a ruler: they must be {BAR_MM:g} mm; if they are not, give --bar MM"
            )
    print_warnings((*reading.warnings, *_not_found(reading.missing)))
    return 0


def _parser() -> Parser:
    parser = Parser("plan measure", _DESCRIPTION, _EPILOG)
    parser.add_argument("photo", type=input_file, metavar="PHOTO", help="JPEG, PNG or TIFF; - for standard input")
    parser.add_argument(
        "--marks",
        type=input_file,
        metavar="marks.csv",
        required=True,
        help="what `plan pattern --marks` wrote for this sheet",
    )
    parser.add_argument("-o", "--output", type=output_file, metavar="measured.csv", required=True, help="the result")
    parser.add_argument(
        "--picture", type=output_file, metavar="FILE", help="draw what was read over the photo: .png, .svg or .pdf"
    )
    parser.add_argument(
        "--bar",
        type=_bars_mm,
        metavar="MM[,MM]",
        help="how long the bars on the sheet are by a "
        "ruler: both, or the one across the page and the one along it (default: 150)",
    )
    parser.add_argument("--quiet", action="store_true", help="say only what is wrong")
    return parser


def _bars_mm(text: str) -> tuple[float, float]:
    """Lengths of the bar across the page and of the one along it."""
    lengths = [length_mm()(part) for part in text.split(",")]
    if len(lengths) > 2:
        raise argparse.ArgumentTypeError(f"'{text}' has to be one length, or two with a comma between them")
    for length in lengths:
        if abs(length / BAR_MM - 1) > _MOST_OFF:
            raise argparse.ArgumentTypeError(
                f"'{length:g}' is not near {BAR_MM:g} mm, which the bars are meant to be; "
                "print the sheet anew, at 100 %"
            )
    return lengths[0], lengths[-1]


def _not_found(missing: Sequence[Mark]) -> list[str]:
    """One warning that names marks, if there are any."""
    if not missing:
        return []
    names = [str(mark.number) for mark in missing[:_LONGEST_LIST]]
    more = f" and {len(missing) - len(names)} more" if len(missing) > len(names) else ""
    return [f"{len(missing)} {'marks' if len(missing) > 1 else 'mark'} not found: {', '.join(names)}{more}"]
