"""`plan run`: a trajectory is drawn by one run at a time, a port has one run, and a run goes by a file that is kept."""

from __future__ import annotations

import argparse
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hardware.drivers.table import SIMULATORS
from hardware.playback.claims import Claimed, claim, claim_of_journal, claim_of_port
from hardware.playback.journal import journal_path
from planner.errors import HardwareError, TrajectoryFileError, UsageError

_LOOP = "loop://"
_STREAMS = ("/dev/stdin", "/dev/fd/", "/proc/")


def journal_of(options: argparse.Namespace) -> Path:
    """Where the journal of this run is, whether there is one or not."""
    return journal_path(options.trajectory, simulated=options.driver in SIMULATORS)


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
        raise UsageError(
            f"{trajectory} is no file that keeps its name, so that it cannot be told whether it is what "
            "was being drawn; write the trajectory to a file, or go on with --from-stroke"
        )


@contextmanager
def one_at_a_time(options: argparse.Namespace) -> Iterator[None]:
    """No other run draws the same trajectory, or by the same port, until this ends.

    Errors: UsageError, HardwareError, naming the run that does.
    """
    by = f" by port {options.port}" if options.port else " on a simulated arm"
    journal = claim_of_journal(journal_of(options)) if is_kept(options.trajectory) else None
    port = claim_of_port(options.port) if options.port and options.port != _LOOP else None
    with (
        _claimed(journal, f"drawing it{by}", UsageError, f"{options.trajectory} is being drawn by another run"),
        _claimed(port, f"drawing {options.trajectory}", HardwareError, f"{options.port}: another run has it"),
    ):
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
