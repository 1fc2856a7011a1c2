"""`plan run`: the files that a run goes by, a trajectory that keeps its name and the journal beside it."""

from __future__ import annotations

import argparse
import stat
from pathlib import Path

from hardware.drivers.table import SIMULATORS
from hardware.playback.journal import journal_path
from planner.errors import TrajectoryFileError, UsageError

_STREAMS = ("/dev/stdin", "/dev/fd/", "/proc/")


def journal_of(options: argparse.Namespace) -> Path:
    """Where the journal of this run is, whether there is one or not."""
    return journal_path(options.trajectory, simulated=options.driver in SIMULATORS)


def is_kept(trajectory: Path) -> bool:
    """Whether it is a file that will be found again by its name, so that a journal can lie beside it."""
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
            f"{trajectory} is not a file that keeps its name, so --resume cannot know whether it has changed; "
            "write the trajectory to a file, or use --from-stroke"
        )
