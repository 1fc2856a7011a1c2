"""Claims on an arm: a run claims its trajectory and its port, and a second run learns which run has them.

The operating system keeps a claim, as a lock on a file, for as long as the process lives: a run that was killed blocks
nobody, though its file may stay. What the file says is only for people to read.
"""

from __future__ import annotations

import hashlib
import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path

_LONGEST_HOLDER = 500


class Claimed(Exception):
    """Another run has it. Its text says which, since when, and what to do."""


def claim_of_journal(journal: Path) -> Path:
    """The file by which a journal is claimed, beside it."""
    return journal.with_name(journal.name + ".lock")


def claim_of_port(name: str) -> Path:
    """The file by which a port is claimed, by device name or by URL, the same for all names of one device."""
    one_name = name.lower() if "://" in name else os.path.realpath(name)
    return Path(tempfile.gettempdir()) / f"plan-port-{hashlib.sha256(os.fsencode(one_name)).hexdigest()[:16]}.lock"


@contextmanager
def claim(path: Path, doing: str) -> Iterator[None]:
    """Hold the claim until this ends; `doing` is what another run reads about this one.

    Where no such file can be made there is no claim: then no journal can be written there either, and what holds a
    port is up to the system alone. Errors: Claimed.
    """
    try:
        descriptor = _locked(path)
    except OSError:
        yield
        return
    try:
        since = datetime.now(UTC).isoformat(sep=" ", timespec="seconds")
        with suppress(OSError):  # a full disk: the lock holds all the same
            os.ftruncate(descriptor, 0)
            os.write(
                descriptor,
                f"process {os.getpid()}, {doing}, since {since}; wait for it to end, or end it: "
                f"kill {os.getpid()}".encode(),
            )
        yield
    finally:
        path.unlink(missing_ok=True)
        os.close(descriptor)


if sys.platform == "win32":

    def _locked(path: Path) -> int:
        raise OSError("there are no locks of this kind")  # a port is exclusive there by itself

else:
    import fcntl

    def _locked(path: Path) -> int:
        """A descriptor of the file, locked. Errors: OSError, Claimed."""
        while True:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK, 0o644)
            try:
                found = os.fstat(descriptor)
                if not stat.S_ISREG(found.st_mode):
                    raise OSError("it is not a file")
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                if _is_there(path, found):  # and was not removed by the run that had it before
                    return descriptor
                os.close(descriptor)
            except BlockingIOError:
                holder = os.read(descriptor, _LONGEST_HOLDER).decode(errors="replace")
                os.close(descriptor)
                raise Claimed("".join(filter(str.isprintable, holder)) or "it has just begun; try again") from None
            except OSError:
                os.close(descriptor)
                raise

    def _is_there(path: Path, found: os.stat_result) -> bool:
        try:
            return os.path.samestat(path.lstat(), found)
        except FileNotFoundError:
            return False
