"""What of a trajectory has been drawn, kept beside its file so that it outlives whatever may happen to the host.

A line of JSON for each thing to remember: the first says what is being drawn and from which stroke on, the others
which stroke comes next and, at last, how the run ended. Lines are only ever added, and each is on disk before the next;
one that a power failure has torn is passed over.
"""

from __future__ import annotations

import hashlib
import json
import os
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, cast

from planner.errors import OutputError, TrajectoryFileError
from planner.trajectory import written_aside

_VERSION = 1
_COMPLETE = "complete"


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
    """What a journal says: the trajectory's digest, the arm and the driver, the stroke to go on from, and how the last
    run ended, "" if nobody was left to say."""

    sha256: str
    arm: str
    driver: str
    next_stroke: int
    ended: str

    @property
    def complete(self) -> bool:
        return self.ended == _COMPLETE


def read_journal(path: Path) -> Entry | None:
    """What the journal says, None where there is none. Errors: TrajectoryFileError if it is no journal."""
    try:
        lines = path.read_bytes().splitlines()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise TrajectoryFileError(str(path), None, f"cannot be read: {error.strerror}") from error
    told: dict[str, Any] = {}
    for line in lines:
        try:
            told |= json.loads(line)
        except (ValueError, TypeError):
            break  # torn by a power failure: what is before it holds
    entry = (told.get("sha256"), told.get("arm"), told.get("driver"), told.get("next_stroke"), told.get("ended", ""))
    match entry:
        case (str(sha256), str(arm), str(driver), int(next_stroke), str(ended)) if told.get("journal") == _VERSION:
            return Entry(sha256, arm, driver, next_stroke, ended)
    raise TrajectoryFileError(str(path), None, "is not a journal of this program; draw without --resume to replace it")


class Journal:
    """A journal being written. What is told while the arm moves is put on disk by a thread of its own: a slow disk
    never makes a set point late."""

    def __init__(self, path: Path, beginning: Entry) -> None:
        """Begin a new journal in place of any other, on disk when this returns. Errors: OutputError."""
        self._path, self.next_stroke = path, beginning.next_stroke
        with written_aside(path) as file:
            cast("IO[str]", file).write(_line(journal=_VERSION, sha256=beginning.sha256, arm=beginning.arm,
                                              driver=beginning.driver, next_stroke=beginning.next_stroke))
        try:
            _sync_folder(path.parent)
            self._file = path.open("ab", buffering=0)
        except OSError as error:
            raise OutputError(str(path), error.strerror or str(error)) from error
        self._writer = ThreadPoolExecutor(max_workers=1, thread_name_prefix="journal")
        self._written: list[Future[None]] = []

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
        self._file.write(line.encode())
        os.fsync(self._file.fileno())


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
