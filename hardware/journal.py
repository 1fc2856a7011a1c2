"""What of a trajectory has been drawn, kept beside its file so that it outlives whatever may happen to the host.

A line of JSON for each thing to remember: the first says what is being drawn, from which stroke on and by which run,
the others up to which stroke all has been sent, which stroke comes next because all before it are known to be drawn,
and at last how the run ended. Lines are only ever added, and each is on disk before the next. A line that is whole
holds, whatever is torn before or behind it: each says all that it has to say, and a first line begins anew.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import stat
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import IO, Any, cast

from planner.errors import OutputError, TrajectoryFileError
from planner.trajectory import written_aside

_VERSION = 1
_COMPLETE = "complete"
_MOST_BYTES = 1 << 26
"""No journal is as long as that: a stroke adds some fifty bytes."""
_LONGEST_TEXT = 1000


def journal_path(trajectory: Path, *, simulated: bool) -> Path:
    """`traj.csv.journal`; a rehearsal on a simulated arm keeps its own."""
    return trajectory.with_name(trajectory.name + (".sim.journal" if simulated else ".journal"))


def digest(trajectory: Path) -> str:
    """SHA-256 of the file. Errors: TrajectoryFileError."""
    try:
        with trajectory.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise TrajectoryFileError(str(trajectory), None, f"cannot be read: {error.strerror}") from error


@dataclass(frozen=True, slots=True)
class Entry:
    """What a journal says: the trajectory's digest, the arm and the driver, the stroke to go on from, how the last run
    ended, "" if nobody was left to say, and the last stroke of which all was sent, -1 for none.
    """

    sha256: str
    arm: str
    driver: str
    next_stroke: int
    ended: str
    last_sent: int = -1

    @property
    def complete(self) -> bool:
        return self.ended == _COMPLETE

    @property
    def in_doubt(self) -> range:
        """Strokes that were sent, and of which nobody knows whether they were drawn."""
        return range(self.next_stroke, self.last_sent + 1)


def read_journal(path: Path) -> Entry | None:
    """What the journal says, None where there is none. Errors: TrajectoryFileError if it is no journal."""
    told: dict[str, Any] = {}
    try:
        lines = _content(path).splitlines()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise TrajectoryFileError(str(path), None, f"cannot be read: {error.strerror}") from error
    for line in lines:
        said = _said(line)
        told = said if "journal" in said else told | said
    entry = (told.get("sha256"), told.get("arm"), told.get("driver"), told.get("next_stroke"), told.get("ended", ""),
             told.get("sent_stroke", -1))
    match entry:
        case (str(sha256), str(arm), str(driver), int(next_stroke), str(ended), int(last_sent)) if (
                told.get("journal") == _VERSION and not isinstance(next_stroke, bool) and next_stroke >= 0):
            return Entry(sha256, _shown(arm), driver, next_stroke, _shown(ended), last_sent)
    raise TrajectoryFileError(str(path), None, "is not a journal of this program; draw without --resume to replace it")


def _content(path: Path) -> bytes:
    """Errors: OSError; TrajectoryFileError where it cannot be a journal. A pipe is not waited for."""
    with open(path, "rb", opener=lambda name, flags: os.open(name, flags | getattr(os, "O_NONBLOCK", 0))) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise TrajectoryFileError(str(path), None, "is no file, and so no journal; remove it")
        content = file.read(_MOST_BYTES)
    if len(content) == _MOST_BYTES:
        raise TrajectoryFileError(str(path), None, "is too long for a journal; draw without --resume to replace it")
    return content


def _said(line: bytes) -> dict[str, Any]:
    """What a whole line says, nothing where it is torn."""
    try:
        said = json.loads(line)
    except (ValueError, RecursionError):
        return {}
    return said if isinstance(said, dict) else {}


def _shown(text: str) -> str:
    """Fit for one line of a terminal."""
    return "".join(character if character.isprintable() else " " for character in text[:_LONGEST_TEXT])


class Journal:
    """A journal being written. What is told while the arm moves is put on disk by a thread of its own: a slow disk
    never makes a set point late."""

    def __init__(self, path: Path, beginning: Entry, port: str = "") -> None:
        """Begin a new journal in place of any other, on disk when this returns. Errors: OutputError."""
        self._path, self.next_stroke, self._last_sent = path, beginning.next_stroke, -1
        self._torn = False
        if os.path.lexists(path) and not path.is_file():
            raise OutputError(str(path), "it is no file")  # a pipe would be waited for
        with written_aside(path) as file:
            cast("IO[str]", file).write(_line(
                journal=_VERSION, sha256=beginning.sha256, arm=beginning.arm, driver=beginning.driver,
                next_stroke=beginning.next_stroke, port=port, process=os.getpid(),
                began=datetime.now(UTC).isoformat(timespec="seconds")))
        try:
            _sync_folder(path.parent)
            self._file = path.open("ab", buffering=0)
        except OSError as error:
            raise OutputError(str(path), error.strerror or str(error)) from error
        self._writer = ThreadPoolExecutor(max_workers=1, thread_name_prefix="journal")
        self._written: list[Future[None]] = []

    @property
    def in_doubt(self) -> range:
        """As of an Entry."""
        return range(self.next_stroke, self._last_sent + 1)

    def sent(self, stroke: int) -> None:
        """All of stroke `stroke` and of those before it has been sent."""
        self._last_sent = stroke
        self._written.append(self._writer.submit(self._add, _line(sent_stroke=stroke)))

    def finished(self, stroke: int) -> None:
        """Stroke `stroke` and all before it are drawn."""
        self.next_stroke = stroke + 1
        self._written.append(self._writer.submit(self._add, _line(next_stroke=self.next_stroke)))

    def close(self, ended: str, *, complete: bool = False) -> None:
        """Say how the run ended, and wait until everything is on disk. Errors: OutputError."""
        self._written.append(self._writer.submit(self._add, _line(ended=_COMPLETE if complete else ended)))
        self._writer.shutdown()
        self._file.close()
        for future in self._written:
            error = future.exception()
            if isinstance(error, OSError):
                raise OutputError(str(self._path), error.strerror or str(error)) from error

    def _add(self, line: str) -> None:
        """Behind a line that a full disk has torn, begin a new one."""
        content = ("\n" * self._torn + line).encode()
        self._torn = True
        if self._file.write(content) != len(content):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        os.fsync(self._file.fileno())
        self._torn = False


def _line(**told: object) -> str:
    return json.dumps(told) + "\n"


def _sync_folder(folder: Path) -> None:
    """A new name is on disk only once its folder is; where folders cannot be opened, the system sees to it."""
    if os.name == "posix":
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
