"""The command `plan`: which command it is, and how every one of them ends.

Nothing heavy is imported before a command needs it, so that `plan --help` answers at once.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from planner.cli.terminal import print_lines, print_note
from planner.errors import PlannerError
from planner.execution.workers import THREAD_VARIABLES

TRACEBACK_VARIABLE = "PLAN_TRACEBACK"
EXIT_INTERRUPTED = 130
EXIT_NO_MEMORY = 2
EXIT_DEFECT = 70
"""A fault of the program itself: EX_SOFTWARE, away from the codes that say something about the input."""
_QUIET = "--quiet"


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; the exit code. Every error ends as one line on standard error."""
    for variable in THREAD_VARIABLES:  # before NumPy is loaded
        os.environ.setdefault(variable, "1")
    try:
        try:
            return _command(list(sys.argv[1:] if argv is None else argv))
        except SystemExit as request:  # argparse has printed the help
            print_lines(())
            return int(request.code or 0)
    except PlannerError as error:
        print_note(f"error: {error}")
        return error.exit_code
    except KeyboardInterrupt:
        print_note("interrupted")
        return EXIT_INTERRUPTED
    except MemoryError as error:
        asked = f" ({error})" if str(error) else ""
        print_note(
            f"error: this machine has not enough memory for it{asked}; a lower --rate, a larger --tolerance and"
            " fewer --workers take less"
        )
        return EXIT_NO_MEMORY
    except Exception as error:
        if os.environ.get(TRACEBACK_VARIABLE):
            raise
        from planner.entry.damage import damage

        complaint = (
            damage(error) or f"this is a defect of the planner, not of the input: {type(error).__name__}: {error}"
        )
        print_note(f"error: {complaint} (set {TRACEBACK_VARIABLE}=1 to see where)")
        return EXIT_DEFECT


def _command(arguments: list[str]) -> int:
    """A first argument, but for `--quiet`, that names a command is that command; anything else is planned."""
    quiet = arguments[:1] == [_QUIET]
    name, *rest = [*arguments[1:], _QUIET] if quiet and len(arguments) > 1 else arguments or [""]
    match name:
        case "batch":
            from planner.cli.batch import batch

            return batch(rest)
        case "estimate":
            from planner.cli.batch import estimate

            return estimate(rest)
        case "config":
            from planner.cli.config import config

            return config(rest)
        case "paper":
            from planner.cli.paper import paper

            return paper(rest)
        case "run":
            from planner.cli.run import run

            return run(rest)
        case "plot":
            from planner.cli.plot import plot

            return plot(rest)
        case "check":
            from planner.cli.check import check

            return check(rest)
        case "ports":
            from planner.cli.ports import ports

            return ports(rest)
        case "measure":
            from planner.cli.measure import measure

            return measure(rest)
        case "lines":
            from planner.cli.lines import lines

            return lines(rest)
        case "compare":
            from planner.cli.compare import compare

            return compare(rest)
        case "pattern":
            from planner.cli.pattern import pattern

            return pattern(rest)
        case "calibrate":
            from planner.cli.calibrate import calibrate

            return calibrate(rest)
        case "identify":
            from planner.cli.identify import identify

            return identify(rest)
        case "predict":
            from planner.cli.predict import predict

            return predict(rest)
        case "mcp":
            from planner.cli.mcp import mcp

            return mcp(rest)
        case "serve":
            from planner.cli.serve import serve

            return serve(rest)
        case "export":
            from planner.cli.export import export

            return export(rest)
        case "fonts":
            from planner.cli.fonts import fonts

            return fonts(rest)
        case "inkscape":
            from planner.cli.inkscape import inkscape

            return inkscape(rest)
        case "step":
            from planner.cli.step import step

            return step(rest)
        case "jog":
            from planner.cli.jog import jog

            return jog(rest)
        case "arm":
            from planner.cli.arm import arm

            return arm(rest)
        case _:
            from planner.cli.plan import plan

            return plan(arguments)
