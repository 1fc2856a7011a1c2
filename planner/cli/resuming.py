"""`plan run --resume`: where an earlier run got to, keeping that for a later one, and one run at a time."""

from __future__ import annotations

import argparse
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hardware.claims import Claimed, claim, claim_of_journal, claim_of_port
from hardware.drivers import SIMULATORS
from hardware.journal import Entry, Journal, digest, journal_path, read_journal
from planner.arms.arm import Arm
from planner.cli.terminal import print_note, print_warnings
from planner.errors import HardwareError, OutputError, TrajectoryFileError, UsageError

_LOOP = "loop://"
_STREAMS = ("/dev/stdin", "/dev/fd/", "/proc/")


def is_kept(trajectory: Path) -> bool:
    """Whether it is a file that will be found again by its name, so that a journal can stand beside it."""
    try:
        return stat.S_ISREG(trajectory.stat().st_mode) and not str(trajectory.absolute()).startswith(_STREAMS)
    except OSError:
        return False


def refuse_unkept(trajectory: Path) -> None:
    """Errors: TrajectoryFileError, UsageError where --resume could not tell whether it is what was being drawn."""
    try:
        trajectory.stat()
    except OSError as error:
        raise TrajectoryFileError(str(trajectory), None, f"cannot be read: {error.strerror}") from error
    if not is_kept(trajectory):
        raise UsageError(f"{trajectory} is no file that keeps its name, so that it cannot be told whether it is what "
                         "was being drawn; write the trajectory to a file, or go on with --from-stroke")


@contextmanager
def one_at_a_time(options: argparse.Namespace) -> Iterator[None]:
    """No other run draws the same trajectory, or by the same port, until this ends.

    Errors: UsageError, HardwareError, naming the run that does.
    """
    by = f" by port {options.port}" if options.port else " on a simulated arm"
    journal = claim_of_journal(_path(options)) if is_kept(options.trajectory) else None
    port = claim_of_port(options.port) if options.port and options.port != _LOOP else None
    with (_claimed(journal, f"drawing it{by}", UsageError, f"{options.trajectory} is being drawn by another run"),
          _claimed(port, f"drawing {options.trajectory}", HardwareError, f"{options.port}: another run has it")):
        yield


@contextmanager
def _claimed(path: Path | None, doing: str, error: type[UsageError | HardwareError], words: str) -> Iterator[None]:
    if path is None:
        yield
        return
    try:
        with claim(path, doing):
            yield
    except Claimed as other:
        raise error(f"{words}: {other}") from None


def where_to_begin(options: argparse.Namespace, arm: Arm, last_stroke: int) -> Entry:
    """From which stroke, of which file and for which arm. Errors: TrajectoryFileError, UsageError."""
    if not options.resume:
        sha256 = digest(options.trajectory) if is_kept(options.trajectory) else ""
        return Entry(sha256, arm.name, options.driver, options.from_stroke or 0, "")
    path = _path(options)
    earlier = read_journal(path)
    if earlier is None:
        raise UsageError(f"there is nothing to resume: no journal {path}")
    if earlier.sha256 != digest(options.trajectory):
        raise UsageError(f"{options.trajectory} is not what was being drawn, for it has changed since; "
                         "draw it without --resume")
    if earlier.arm != arm.name:
        raise UsageError(f"arm '{earlier.arm}' was drawing {options.trajectory}, not '{arm.name}'")
    if max(earlier.next_stroke - 1, earlier.last_sent) > last_stroke:
        raise UsageError(f"{path} tells of strokes that {options.trajectory} does not have, so it is damaged; "
                         "go on with --from-stroke")
    return earlier


class RunJournal:
    """What this run has drawn, told to a journal once the arm is there to draw: a wrong port must not cost an earlier
    run's."""

    def __init__(self, options: argparse.Namespace, beginning: Entry, last_stroke: int) -> None:
        self._options, self._beginning, self._last_stroke = options, beginning, last_stroke
        self._journal: Journal | None = None

    def open(self) -> None:
        """In place of the earlier run's; where none can be written, that is said."""
        options = self._options
        if options.resume:
            print_note(_earlier(self._beginning))
        if not is_kept(options.trajectory):
            print_warnings([f"there will be nothing for --resume to go by: {options.trajectory} is no file to find "
                            "again"])
            return
        try:
            self._journal = Journal(_path(options), self._beginning, options.port or "")
        except OutputError as error:
            print_warnings([f"there will be nothing for --resume to go by: {error}"])

    def sent(self, stroke: int) -> None:
        if self._journal is not None:
            self._journal.sent(stroke)

    def finished(self, stroke: int) -> None:
        if self._journal is not None:
            self._journal.finished(stroke)

    def close(self, ended: str, *, complete: bool) -> None:
        """Say how the run ended, and from where another goes on. Errors: OutputError where all else went well."""
        if self._journal is None:
            return
        try:
            self._journal.close(ended, complete=complete)
        except OutputError as error:
            if complete:
                raise
            print_warnings([str(error)])
        if not complete:
            print_note(self._rest(self._journal.next_stroke, self._journal.in_doubt))

    def _rest(self, next_stroke: int, in_doubt: range) -> str:
        if next_stroke > self._last_stroke:
            return "all strokes are drawn; there is nothing left for --resume"
        return f"--resume goes on from stroke {next_stroke} of 0..{self._last_stroke}{_doubt(in_doubt)}"


def _earlier(entry: Entry) -> str:
    how = f" ({entry.ended})" if entry.ended else ""
    return (f"the earlier run ended before stroke {entry.next_stroke} was finished{how}; "
            f"going on from stroke {entry.next_stroke}{_doubt(entry.in_doubt)}")


def _doubt(strokes: range) -> str:
    if not strokes:
        return ""
    which = f"stroke {strokes[0]} was" if len(strokes) == 1 else f"strokes {strokes[0]} to {strokes[-1]} were"
    return (f"; {which} sent, but the controller was not heard to have drawn so far: drawn again, unless you see the "
            f"ink and take --from-stroke {strokes[-1] + 1} instead")


def _path(options: argparse.Namespace) -> Path:
    return journal_path(options.trajectory, simulated=options.driver in SIMULATORS)
