"""`plan pattern`: a trajectory of marks to calibrate an arm with."""

from __future__ import annotations

import argparse
from pathlib import Path

from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.terminal import print_lines
from planner.errors import UsageError

_DESCRIPTION = """\
Make a trajectory of marks that tell all errors of an arm apart, and a list of them. Each mark is where the pen rests at
the end of a stroke, along which it comes down slowly: where ink begins tells how high the pen is. Draw it with plan run
--record, measure the marks, and give both to plan calibrate."""

_EPILOG = """\
examples:
  plan pattern --arm my_arm.toml -o pattern.csv --marks marks.csv
  plan pattern --arm my_arm.toml -o pattern.csv --marks marks.csv --count 25   for a ruler
  plan run pattern.csv --driver maestro --port /dev/ttyACM0 --record pulses.csv"""

_FEWEST, _MOST = 12, 400


def pattern(arguments: list[str]) -> int:
    """Make one pattern. Errors: PlannerError."""
    parser = Parser("plan pattern", _DESCRIPTION, _EPILOG)
    parser.add_argument("--arm", required=True, metavar="NAME|FILE", help="the arm as it is known so far")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="the trajectory")
    parser.add_argument(
        "--marks",
        type=Path,
        required=True,
        metavar="FILE",
        help="the list of marks: when each is made, and where on the paper it is meant to be",
    )
    parser.add_argument(
        "--sheet",
        type=Path,
        metavar="FILE.pdf",
        help="a sheet to print, from a photo of which plan measure reads the marks",
    )
    parser.add_argument(
        "--count",
        type=_count,
        default=49,
        metavar="N",
        help=f"how many marks, {_FEWEST} to {_MOST} (default: %(default)s)",
    )
    parser.add_argument(
        "--seed",
        type=int,
        default=0,
        metavar="N",
        help="another seed makes another pattern, to prove a calibration with (default: %(default)s)",
    )
    parser.add_argument("--quiet", action="store_true", help="no summary")
    options = parser.parse_args(arguments)
    check_target(options.output)
    check_target(options.marks)
    if options.sheet:
        check_target(options.sheet)
    if options.seed < 0:
        raise UsageError(f"--seed {options.seed}: seeds are 0 or more")
    if options.output.resolve() == options.marks.resolve():
        raise UsageError("-o and --marks name the same file")

    from hardware.playback.program import make_program
    from planner.arms.arm_file import load_arm
    from planner.error_model.pattern.listed import listed_marks
    from planner.error_model.pattern.pattern import make_pattern
    from planner.error_model.sheet.marks import write_marks
    from planner.trajectory import write_trajectory

    arm = load_arm(options.arm)
    made = make_pattern(arm, options.arm, options.count, options.seed, on_sheet=options.sheet is not None)
    trajectory = made.trajectory
    played = make_program(
        arm, arm.from_file_units(trajectory.positions), trajectory.stroke, trajectory.rate_hz, park=arm.park
    )
    write_trajectory(trajectory, options.output)
    marks = listed_marks(arm, made, played.approach)
    write_marks(options.marks, marks)
    written = [options.output, options.marks]
    if options.sheet:
        from planner.error_model.sheet.pdf import write_sheet

        write_sheet(options.sheet, arm.name, marks)
        written.append(options.sheet)
    if not options.quiet:
        print_lines(
            [f"{options.count} marks, drawn in {trajectory.duration_s:.0f} s", *(f"wrote {file}" for file in written)]
        )
    return 0


def _count(text: str) -> int:
    if not text.isdecimal() or not _FEWEST <= int(text) <= _MOST:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of marks from {_FEWEST} to {_MOST}")
    return int(text)
