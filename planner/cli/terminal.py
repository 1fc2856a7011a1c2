"""What the user sees: results on standard output, progress and warnings on standard error."""

from __future__ import annotations

import errno
import io
import os
import stat
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from planner.errors import OutputError
from planner.files import is_standard_output
from planner.progress import Report, bars


def print_lines(lines: Iterable[str]) -> None:
    """Results. A reader that has gone away (`| head`, a closed terminal) is no error; a full disk is.

    Errors: OutputError.
    """
    if sys.stdout is None:  # started with standard output closed
        return
    if isinstance(sys.stdout, io.TextIOWrapper):  # a file name may hold what the terminal's encoding does not
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        for line in lines:
            print(line)
        sys.stdout.flush()
    except BrokenPipeError:
        _silence(sys.stdout)
    except OSError as error:
        gone = _is_gone(sys.stdout, error)
        _silence(sys.stdout)
        if not gone:
            raise OutputError("to standard output", error.strerror or str(error)) from error


def print_summary(lines: Iterable[str], *results: Path) -> None:
    """What people read about results: on standard output, unless a result itself goes there, else on standard error.
    Errors: OutputError."""
    if not any(map(is_standard_output, results)):
        print_lines(lines)
        return
    for line in lines:
        _print_aside(line)


def print_warnings(warnings: Iterable[str]) -> None:
    for warning in warnings:
        print_note(f"warning: {warning}")


def print_note(message: str) -> None:
    """One line on standard error, in the program's name."""
    _print_aside("plan: " + " ".join(message.splitlines()))


def _print_aside(line: str) -> None:
    if sys.stderr is None:
        return
    try:
        print(line, file=sys.stderr, flush=True)
    except OSError:  # nobody is left to tell
        _silence(sys.stderr)


@contextmanager
def progress(*, quiet: bool, paced: bool = True) -> Iterator[Report]:
    """A bar while standard error is a terminal, else nothing. paced: as of `bars`."""
    if quiet or sys.stderr is None or not sys.stderr.isatty():
        yield lambda label, done, total: None
        return
    with bars(paced=paced) as show:
        yield show


@contextmanager
def waiting(what: str, *, quiet: bool) -> Iterator[None]:
    """Shows what takes so long, where nothing tells how far it is."""
    with progress(quiet=quiet) as show:
        show(what, 0, 1)
        yield


def _is_gone(stream: io.TextIOBase | object, error: OSError) -> bool:
    """Whether it is a terminal that somebody has closed."""
    return (
        error.errno == errno.EIO
        and isinstance(stream, io.TextIOWrapper)
        and stat.S_ISCHR(os.fstat(stream.fileno()).st_mode)
    )


def _silence(stream: io.TextIOBase | object) -> None:
    """Send what is left in the stream's buffer nowhere, so that the interpreter's own flush at exit cannot fail."""
    if isinstance(stream, io.TextIOWrapper):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
