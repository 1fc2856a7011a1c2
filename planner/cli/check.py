"""`plan check traj.csv`: an independent check of a trajectory."""

from __future__ import annotations

import json
from typing import IO, cast

from planner.cli.files import input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import length_mm
from planner.cli.terminal import print_summary, waiting
from planner.settings import MIN_TOLERANCE_MM, PlanSettings

_DESCRIPTION = """\
Examine a trajectory with mathematics of the check's own: limits at and between samples, couplings, the pen's height
and, with --drawing, whether the pen draws that drawing, all of it and nothing else."""

_EPILOG = """\
examples:
  plan check traj.csv
  plan check traj.csv --verbose
  plan check traj.csv --drawing flower.svg --tolerance 0.1mm
  plan check traj.csv --arm my_arm.toml --json result.json

exit codes: 0 everything holds; 1 something does not; 2 the files cannot be used"""

EXIT_FAULT = 1


def check(arguments: list[str]) -> int:
    """Judge one trajectory. Errors: PlannerError."""
    parser = Parser("plan check", _DESCRIPTION, _EPILOG)
    parser.add_argument("trajectory", type=input_file, metavar="traj.csv", help="- for standard input")
    parser.add_argument("--drawing", type=input_file, metavar="DRAWING.svg", help="compare what is drawn with this")
    parser.add_argument("--arm", metavar="NAME|FILE", help="judge it for this arm (default: the one in the trajectory)")
    parser.add_argument(
        "--tolerance",
        type=length_mm(minimum_mm=MIN_TOLERANCE_MM),
        metavar="LENGTH",
        help=f"how far the pen may be off the drawing (default: {PlanSettings().tolerance_mm:g} mm, or half the"
        " expected error of a calibrated arm)",
    )
    parser.add_argument(
        "--json", type=output_file, metavar="FILE", help="write the check result there as well; - for standard output"
    )
    loudness = parser.add_mutually_exclusive_group()
    loudness.add_argument(
        "--verbose", action="store_true", help="print every law with its worst figure and where it is"
    )
    loudness.add_argument(
        "--quiet", action="store_true", help="print the faults alone, and nothing where there is none"
    )
    options = parser.parse_args(arguments)
    sources = [options.trajectory] + ([options.drawing] if options.drawing else [])
    if options.json:
        check_target(options.json, *sources)

    from planner.arms.arm_file import load_arm
    from planner.arms.usual_settings import usual_tolerance_mm
    from planner.checking.check import check_trajectory
    from planner.drawing.svg import read_drawing
    from planner.files import written_aside
    from planner.trajectory import read_trajectory

    with waiting("reading", quiet=options.quiet):
        trajectory = read_trajectory(options.trajectory)
        arm = load_arm(options.arm or trajectory.arm)
        drawing = read_drawing(options.drawing, options=trajectory.reading) if options.drawing else None
    with waiting("checking", quiet=options.quiet):
        tolerance_mm = usual_tolerance_mm(arm) if options.tolerance is None else options.tolerance
        check_result = check_trajectory(trajectory, arm, drawing, tolerance_mm)
    if options.json:
        with written_aside(options.json) as file:
            cast("IO[str]", file).write(json.dumps(check_result.as_dict(), indent=2) + "\n")
    faults = [str(fault) for fault in check_result.faults]
    told = [check_result.text()] if options.verbose else faults if options.quiet else [check_result.verdict(), *faults]
    print_summary(told, *filter(None, [options.json]))
    return 0 if check_result.passed else EXIT_FAULT
