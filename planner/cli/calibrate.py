"""`plan calibrate`: an arm, and marks that it made, to an arm file that says how it really is."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import IO, TYPE_CHECKING, cast

from planner.cli.expected import expected
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.terminal import print_lines, print_warnings
from planner.errors import UsageError

if TYPE_CHECKING:
    from planner.error_model.calibration.calibrate import Calibrated

_DESCRIPTION = """\
Find out how an arm really is from marks that it made: the curve and the zero of every servo, the slack of every joint,
lengths, and where the paper lies. Writes a new arm file; plan, run and predict with that one from then on. Several
sheets may be given, each with its own record."""

_EPILOG = """\
examples:
  plan calibrate my_arm.toml --record pulses.csv --marks measured.csv -o my_arm_2.toml
  plan calibrate drawing_arm_2022 --record a.csv --marks a_marks.csv --record b.csv --marks b_marks.csv -o arm2.toml

measured.csv has the columns mark,x_mm,y_mm and, where known, h_mm (height of the tip over the paper, negative where it
is pressed) and sd_mm (how well the mark was measured); cells of marks that were not seen are empty."""


def calibrate(arguments: list[str]) -> int:
    """Calibrate one arm. Errors: PlannerError."""
    parser = Parser("plan calibrate", _DESCRIPTION, _EPILOG)
    parser.add_argument("arm", metavar="ARM", help="the arm that the pattern was planned for, by name or file")
    parser.add_argument(
        "--record",
        type=Path,
        action="append",
        required=True,
        metavar="FILE",
        help="what its servos were told: plan run --record",
    )
    parser.add_argument(
        "--marks", type=Path, action="append", required=True, metavar="FILE", help="the marks of that record, measured"
    )
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="ARM.toml", help="the calibrated arm")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write what was found there as well")
    parser.add_argument("--quiet", action="store_true", help="no summary, only warnings and errors")
    options = parser.parse_args(arguments)
    _check(options)

    from planner.arms.arm_edit import edited
    from planner.arms.arm_file import arm_file_text, load_arm
    from planner.error_model.calibration.calibrate import calibrate as calibrated_by
    from planner.error_model.calibration.files import read_marks, read_record
    from planner.error_model.calibration.sheets import Sheet
    from planner.error_model.calibration.summary import as_json, lines, warnings
    from planner.files import written_aside

    arm = load_arm(options.arm)
    sheets = [
        Sheet(str(marks), read_record(record, arm), read_marks(marks))
        for record, marks in zip(options.record, options.marks, strict=True)
    ]
    found: Calibrated = calibrated_by(arm, sheets)
    marks = found.arm.accuracy.marks if found.arm.accuracy else 0
    remark = f"{arm.name} as calibrated from {marks} marks by plan calibrate."
    text = edited(arm_file_text(options.arm), arm, found.arm, remark)
    prediction = expected(text)
    with written_aside(options.output) as file:
        cast("IO[str]", file).write(text)
    if options.json:
        with written_aside(options.json) as file:
            cast("IO[str]", file).write(json.dumps(as_json(found, prediction), indent=2) + "\n")
    print_warnings(warnings(found))
    if not options.quiet:
        print_lines([*lines(found, prediction), f"wrote {options.output}"])
    return 0


def _check(options: argparse.Namespace) -> None:
    if len(options.record) != len(options.marks):
        raise UsageError(f"{len(options.record)} --record and {len(options.marks)} --marks: give each record its marks")
    if options.output.suffix != ".toml":
        raise UsageError(f"{options.output}: an arm file ends in .toml")
    sources = [*options.record, *options.marks] + ([Path(options.arm)] if options.arm.endswith(".toml") else [])
    check_target(options.output, *sources)
    if options.json:
        check_target(options.json, *sources)
