"""`--events`: for programs that drive this one. One JSON object a line on standard output, in the place of bars and
summaries; errors and warnings stay on standard error, and exit codes are the same."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic

from planner.cli.parser import Parser
from planner.cli.terminal import print_lines
from planner.errors import UsageError
from planner.files import is_standard_output
from planner.progress import Report

_SHORTEST_S = 0.1


def add_events_option(parser: Parser, more: str = "") -> None:
    parser.add_argument(
        "--events",
        action="store_true",
        help=f"for programs: one JSON object a line on standard output, instead of progress and summary{more}",
    )


def refuse_events_among_results(options: argparse.Namespace, *results: Path | None) -> None:
    """Errors: UsageError where both would go to standard output."""
    if options.events and any(result is not None and is_standard_output(result) for result in results):
        raise UsageError("--events go to standard output: name a file for the result")


def tell(event: str, **facts: object) -> None:
    """Errors: OutputError."""
    print_lines([json.dumps({"event": event, **facts})])


@contextmanager
def told_progress() -> Iterator[Report]:
    """A few times a second, and at every new label."""
    last: tuple[str, float] = ("", 0.0)

    def show(label: str, done: int, total: int) -> None:
        nonlocal last
        now = monotonic()
        if label != last[0] or now - last[1] >= _SHORTEST_S:
            last = label, now
            tell("progress", stage=label, done=done, total=total)

    yield show


def tell_summary(lines: Iterable[str], files: Iterable[str]) -> None:
    tell("done", summary=list(lines), files=list(files))
