"""`plan paper`: where the paper lies, in words and as a sheet to print at true size."""

from __future__ import annotations

from planner.cli.files import output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import paper as paper_size
from planner.cli.terminal import print_summary
from planner.paper_size import Orientation
from planner.settings import CanvasKind, PlanSettings

_DESCRIPTION = """\
Say where the paper lies before an arm, and draw it to print at true size: rings for the base, the corners of the paper,
the middle line, what the arm reaches. Lay it under the base, mark the corners, or draw on it."""

_EPILOG = """\
examples:
  plan paper --arm drawing_arm -o sheet.pdf
  plan paper --arm my_arm.toml --paper a5 -o sheet.pdf
  plan run traj.csv --frame                          and the pen goes round it in the air"""


def paper(arguments: list[str]) -> int:
    """Write the sheet. Errors: PlannerError."""
    default = PlanSettings()
    parser = Parser("plan paper", _DESCRIPTION, _EPILOG)
    parser.add_argument("-o", "--output", type=output_file, metavar="FILE", help="the sheet, .pdf, .svg or .png")
    parser.add_argument("--arm", default=default.arm, metavar="NAME|FILE", help="the arm (default: %(default)s)")
    parser.add_argument("--canvas", choices=[kind.value for kind in CanvasKind], default=default.canvas.value)
    parser.add_argument("--paper", type=paper_size, metavar="SIZE", help="the paper: a0 to a10, letter, 100x150 ...")
    parser.add_argument(
        "--orientation", choices=[kind.value for kind in Orientation], default=Orientation.AUTO.value, help="of it"
    )
    options = parser.parse_args(arguments)
    if options.output:
        check_target(options.output)

    from planner.arms.arm_file import load_arm
    from planner.placement.board import board_of
    from planner.redundancy.arm_model import ArmModel
    from planner.workspace.canvas import canvas_of
    from planner.workspace.reach import paper_in_reach

    model = ArmModel(load_arm(options.arm))
    canvas = canvas_of(model, CanvasKind(options.canvas), model.arm.pen.lift_mm)
    is_wide = canvas.width_mm > canvas.height_mm
    board = board_of(canvas, options.paper, Orientation(options.orientation), 0.0, is_wide)
    where = board.where(model.arm.paper)
    lines = [where]
    if options.output:
        from planner.plots.figure_file import picture_format, save_figure
        from planner.plots.placement_sheet import plot_placement_sheet

        picture_format(options.output)
        figure, page = plot_placement_sheet(
            canvas,
            board.sheet,
            paper_in_reach(model).ring_mm,
            model.arm.name,
            where.partition(";")[0],
            model.arm.paper,
        )
        save_figure(figure, options.output)
        lines.append(f"wrote {options.output}: print it on {page} at 100 %")
    print_summary(lines, *filter(None, [options.output]))
    return 0
