"""`plan fonts`: the single-line faces that text of a drawing is written in."""

from __future__ import annotations

from typing import TYPE_CHECKING

from planner.cli.files import output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.terminal import print_lines, print_summary, print_warnings

if TYPE_CHECKING:
    from planner.drawing.text.faces import Face

_DESCRIPTION = """\
List the single-line faces that the text of drawings is written in, with what each stands for, what it has, and its
licence. With -o, draw them."""

_EPILOG = """\
examples:
  plan fonts
  plan fonts -o fonts.svg
  plan fonts -o name.png "Grüße aus Łódź"

The suffix of FILE says the format: .png, .svg or .pdf. What a face lacks is taken from NewStroke."""


def fonts(arguments: list[str]) -> int:
    """List the faces, and draw them. Errors: PlannerError."""
    parser = Parser("plan fonts", _DESCRIPTION, _EPILOG)
    parser.add_argument(
        "text", nargs="?", metavar="TEXT", help="what to write (default: sentences in several languages)"
    )
    parser.add_argument("-o", "--output", type=output_file, metavar="FILE", help="a picture of the faces")
    options = parser.parse_args(arguments)
    if options.text is not None and not options.text.strip():
        parser.error("TEXT is empty")
    if options.text is not None and options.output is None:
        parser.error("TEXT goes with -o FILE")
    if options.output is not None:
        from planner.plots.figure_file import picture_format

        check_target(options.output)
        picture_format(options.output)

    from planner.drawing.text.specimen import PANGRAM, faces, written

    known = faces()
    lines = [line for kind, face in known.items() for line in _lines(kind, face)]
    if options.output is None:
        print_lines(lines)
        return 0

    from planner.plots.figure_file import save_figure
    from planner.plots.specimen import plot_faces

    texts = PANGRAM if options.text is None else tuple(options.text.splitlines())
    save_figure(plot_faces(known, texts), options.output)
    missing = sorted({character for text in texts for character in written(text, next(iter(known.values()))).missing})
    if missing:
        print_warnings([f"no face has {', '.join(f'U+{ord(character):04X}' for character in missing)}"])
    print_summary(lines, options.output)
    return 0


def _lines(kind: str, face: Face) -> list[str]:
    from planner.drawing.text.specimen import coverage

    found = ", ".join(f"{name} {n} of {total}" for name, (n, total) in coverage(face).items())
    return [f"{kind}: {face.name} ({face.licence})", f"  {len(face.lines)} characters: {found}"]
