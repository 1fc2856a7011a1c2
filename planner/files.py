"""Files that are written whole or not at all, and which file is meant: `-` and its like are standard output, which is
written to as it is."""

from __future__ import annotations

import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from planner.errors import OutputError

STANDARD = "-"
STANDARD_OUTPUT_DESCRIPTOR = 1


def is_standard_output(target: Path) -> bool:
    """Whether a result for `target` goes to standard output: named `-`, or by a name such as /dev/stdout."""
    if str(target) == STANDARD:
        return True
    try:
        return os.path.samestat(target.stat(), os.fstat(STANDARD_OUTPUT_DESCRIPTOR))
    except (OSError, ValueError):
        return False


@contextmanager
def written_aside(target: Path, *, binary: bool = False) -> Iterator[IO[str] | IO[bytes]]:
    """A file that takes the place of `target` only once it is complete and on disk; nothing is left
    behind otherwise. A symbolic link stays one, and the file that it points to is replaced; a device or
    a pipe is written to as it is, and so is standard output; a reader of that who has gone away (`| head`) is no
    error. Errors: OutputError."""
    aside = None
    try:
        if is_standard_output(target):
            if sys.stdout is not None:
                sys.stdout.flush()
            with suppress(BrokenPipeError), _opened(os.dup(STANDARD_OUTPUT_DESCRIPTOR), binary) as file:
                yield file
            return
        if target.is_dir():
            raise OutputError(str(target), "it is a folder")
        if target.exists() and not target.is_file():
            with _opened(os.open(target, os.O_WRONLY), binary) as file:
                yield file
            return
        final = Path(os.path.realpath(target))
        if not final.parent.is_dir():
            raise OutputError(str(target), f"there is no folder {final.parent}")
        if final.exists() and not os.access(final, os.W_OK):
            raise OutputError(str(target), "it is write-protected")
        descriptor, name = tempfile.mkstemp(dir=final.parent, prefix=".unfinished-")
        aside = Path(name)
        with _opened(descriptor, binary) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        aside.chmod(_usual_mode(final))  # mkstemp makes files private; a result is for everybody, as usual
        aside.replace(final)
        aside = None
    except OSError as error:
        name = "to standard output" if is_standard_output(target) else str(target)
        raise OutputError(name, error.strerror or str(error)) from error
    finally:
        if aside is not None:
            with suppress(OSError):
                aside.unlink()


def _opened(descriptor: int, binary: bool) -> IO[str] | IO[bytes]:
    if binary:
        return os.fdopen(descriptor, "wb")
    # A file name that is no Unicode may stand in a comment line: better a "?" than no trajectory.
    return os.fdopen(descriptor, "w", encoding="utf-8", errors="replace")


def _usual_mode(target: Path) -> int:
    """Permissions of the file that is replaced, or those that a new one would get."""
    if target.exists():
        return stat.S_IMODE(target.stat().st_mode)
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
