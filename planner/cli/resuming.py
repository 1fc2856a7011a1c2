"""`plan run --resume`: where an earlier run got to, and keeping that for a later one."""

from __future__ import annotations

import argparse
from pathlib import Path

from hardware.drivers import SIMULATORS
from hardware.journal import Entry, Journal, digest, journal_path, read_journal
from planner.arms.arm import Arm
from planner.cli.terminal import print_note, print_warnings
from planner.errors import OutputError, UsageError


def where_to_begin(options: argparse.Namespace, arm: Arm) -> Entry:
    """From which stroke, of which file and for which arm. Errors: TrajectoryFileError, UsageError."""
    path = _path(options)
    sha256 = digest(options.trajectory) if options.trajectory.is_file() else ""  # a pipe has been read already
    if not options.resume:
        return Entry(sha256, arm.name, options.driver, options.from_stroke or 0, "")
    earlier = read_journal(path)
    if earlier is None:
        raise UsageError(f"there is nothing to resume: no journal {path}")
    if earlier.sha256 != sha256:
        raise UsageError(f"{options.trajectory} is not what was being drawn, for it has changed since; "
                         "draw it without --resume")
    if earlier.arm != arm.name:
        raise UsageError(f"arm '{earlier.arm}' was drawing {options.trajectory}, not '{arm.name}'")
    if not earlier.complete:
        how = f" ({earlier.ended})" if earlier.ended else ""
        print_note(f"the earlier run ended before stroke {earlier.next_stroke} was finished{how}; "
                   f"going on from stroke {earlier.next_stroke}")
    return earlier


def open_journal(options: argparse.Namespace, beginning: Entry) -> Journal | None:
    """A new journal in place of the earlier run's; None, with a warning, where none can be written."""
    try:
        return Journal(_path(options), beginning)
    except OutputError as error:
        print_warnings([f"there will be nothing for --resume to go by: {error}"])
        return None


def _path(options: argparse.Namespace) -> Path:
    return journal_path(options.trajectory, simulated=options.driver in SIMULATORS)
