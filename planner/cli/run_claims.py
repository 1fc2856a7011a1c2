"""One run at a time draws a trajectory, and one process at a time uses a port."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hardware.playback.claims import Claimed, claim, claim_of_journal, claim_of_port
from planner.cli.run_files import is_kept, journal_of
from planner.errors import HardwareError, UsageError

_LOOP = "loop://"


@contextmanager
def one_at_a_time(options: argparse.Namespace) -> Iterator[None]:
    """No other run draws the same trajectory, or by the same port, until this ends.

    Errors: UsageError, HardwareError, naming the run that does.
    """
    by = f" by port {options.port}" if options.port else " on a simulated arm"
    journal = claim_of_journal(journal_of(options)) if is_kept(options.trajectory) else None
    with (
        _claimed(journal, f"drawing it{by}", UsageError, f"{options.trajectory} is being drawn by another run"),
        alone_on(options.port, f"drawing {options.trajectory}"),
    ):
        yield


@contextmanager
def alone_on(port: str | None, doing: str) -> Iterator[None]:
    """No other process plays or jogs by the same port until this ends; None for a simulated arm, which is at none.
    `doing` is what another process reads about this one. Errors: HardwareError, naming the process that does."""
    path = claim_of_port(port) if port and port != _LOOP else None
    with _claimed(path, doing, HardwareError, f"{port}: another run has it"):
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
