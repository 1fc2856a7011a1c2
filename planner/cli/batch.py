"""`plan batch FOLDER`: a trajectory for each drawing of a folder."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from planner.cli.files import output_file
from planner.cli.interrupts import interrupts_remembered
from planner.cli.parser import Parser
from planner.cli.plan_options import add_plan_options, preferred, settings_of
from planner.cli.terminal import print_lines, print_note, print_warnings, progress
from planner.counted import clock, counted, metres

if TYPE_CHECKING:
    from planner.batch import Job, Outcome
    from planner.settings import PlanSettings

_DESCRIPTION = """\
Plan every drawing (.svg) of a folder, each into a trajectory of its own name. Drawings are shared out among the
workers; one that cannot be planned is named and does not stop the others."""

_EPILOG = """\
examples:
  plan batch drawings                              writes drawings/NAME.csv for each drawings/NAME.svg
  plan batch drawings -o trajectories --arm scara --workers 8
  plan batch drawings --workers tcp://10.0.0.5:8786   on a Dask cluster that sees the same folders (extra 'dask')

exit codes: 0 all planned; else the highest code among the drawings: 2 unusable input; 3 cannot be planned"""

_ESTIMATE_DESCRIPTION = """\
Say how long each drawing of a folder takes to draw, and write nothing: they are planned as they would be, so that the
times are those of the trajectories."""

_ESTIMATE_EPILOG = """\
examples:
  plan estimate drawings
  plan estimate flower.svg --arm scara --speed 4cm/s"""

_NO_MEMORY_CODE = 2


def batch(arguments: list[str]) -> int:
    """Plan all drawings of a folder. Errors: PlannerError where no drawing can be begun."""
    options = preferred(_parser(), arguments)
    folder: Path = options.folder
    settings = settings_of(options)

    from planner.batch import jobs_of

    return _done(jobs_of(folder, options.output or folder), settings, options)


def _done(jobs: Sequence[Job], settings: PlanSettings, options: argparse.Namespace) -> int:
    """Do all jobs and tell what became of them; the exit code."""
    from planner.batch import plan_all

    outcomes: list[Outcome] = []
    with progress(quiet=options.quiet) as show, interrupts_remembered() as raise_if_interrupted:
        show("drawings", 0, len(jobs))
        for outcome in plan_all(jobs, settings, options.workers):
            raise_if_interrupted()
            outcomes.append(outcome)
            show("drawings", len(outcomes), len(jobs))
    for outcome in outcomes:
        if outcome.summary is not None:
            print_warnings(f"{outcome.job.drawing.name}: {warning}" for warning in outcome.summary.warnings)
        else:
            reason = "not enough memory" if isinstance(outcome.error, MemoryError) else str(outcome.error)
            print_note(f"error: {outcome.job.drawing.name}: {reason.removeprefix(f'{outcome.job.drawing.name}: ')}")
    if not options.quiet:
        print_lines(_table(outcomes))
    return max(_exit_code(outcome) for outcome in outcomes)


def estimate(arguments: list[str]) -> int:
    """Tell how long drawings take. Errors: PlannerError where no drawing can be begun."""
    parser = Parser("plan estimate", _ESTIMATE_DESCRIPTION, _ESTIMATE_EPILOG)
    parser.add_argument("folder", type=output_file, metavar="FOLDER|DRAWING.svg")
    add_plan_options(parser)
    options = preferred(parser, arguments)
    settings = settings_of(options)

    from planner.batch import estimates_of

    return _done(estimates_of(options.folder), settings, options)


def _exit_code(outcome: Outcome) -> int:
    if outcome.error is None:
        return 0
    return _NO_MEMORY_CODE if isinstance(outcome.error, MemoryError) else outcome.error.exit_code


def _table(outcomes: Sequence[Outcome]) -> list[str]:
    """Aligned columns, a drawing a line, and how many there are."""
    width = max(len("drawing"), *(len(outcome.job.drawing.name) for outcome in outcomes))
    lines = [f"{'drawing':<{width}}  strokes  {'drawn':>9}  {'takes':>12}  trajectory"]
    for outcome in outcomes:
        name, summary = outcome.job.drawing.name, outcome.summary
        if summary is None:
            lines.append(f"{name:<{width}}  {'-':>7}  {'-':>9}  {'-':>12}  none")
        else:
            lines.append(
                f"{name:<{width}}  {summary.n_strokes:>7}  {metres(summary.drawn_mm):>9}"
                f"  {clock(summary.duration_s):>12}  {outcome.job.target or '-'}"
            )
    planned = sum(outcome.summary is not None for outcome in outcomes)
    whole = clock(sum(outcome.summary.duration_s for outcome in outcomes if outcome.summary is not None))
    return [*lines, f"{planned} of {counted(len(outcomes), 'drawing')} planned; they take {whole} in all"]


def _parser() -> Parser:
    parser = Parser("plan batch", _DESCRIPTION, _EPILOG)
    parser.usage = "plan batch FOLDER [-o OUTFOLDER] [options of plan]"
    parser.add_argument("folder", type=output_file, metavar="FOLDER")
    parser.add_argument(
        "-o",
        "--output",
        type=output_file,
        metavar="OUTFOLDER",
        help="where the trajectories go, made if missing (default: beside the drawings)",
    )
    add_plan_options(parser)
    return parser
