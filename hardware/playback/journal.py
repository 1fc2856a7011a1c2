"""A journal beside a trajectory: what of it has been drawn, whatever happens to the host.

A line of JSON for each thing to remember, read by hardware/playback/journal_entry.py. The first says what is being
drawn, from where on and by which run. The second, which is as long as ever and is written over, says how many set
points the arm has reached. The others, only ever added, say how the controller counts, where in the trajectory the set
points are, up to which stroke all has been sent, which stroke comes next because all before it are known to be drawn
and, at the end, how the run ended. Each is on disk before the next.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import IO, cast

from hardware.clock import Clock
from hardware.drivers.driver import Tally
from hardware.playback.journal_entry import COMPLETE, VERSION, Entry
from hardware.playback.sample_map import Piece, piece, sample_after
from planner.arrays import FloatArray
from planner.errors import OutputError, TrajectoryFileError
from planner.files import written_aside

_COUNTS_LENGTH = 140
"""Of the line that is written over: three numbers of 15 digits, one of 22, and their names."""
NOTED_EVERY_S = 0.05
"""How far the arm has come: so much may be drawn twice where neither host nor controller is left to tell."""


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


class Journal:
    """A journal being written. A thread of its own writes while the arm moves, so that a slow disk never makes a set
    point late. What cannot be written is an error at the end; what is written stays true."""

    def __init__(self, path: Path, beginning: Entry, clock: Clock, port: str = "") -> None:
        """Begin a new journal in place of any other, on disk when this returns. Errors: OutputError."""
        self._path, self.next_stroke, self._last_sent, self._clock = path, beginning.next_stroke, -1, clock
        first = _line(
            journal=VERSION,
            sha256=beginning.sha256,
            arm=beginning.arm,
            driver=beginning.driver,
            next_stroke=beginning.next_stroke,
            sample=beginning.sample,
            port=port,
            process=os.getpid(),
            began=datetime.now(UTC).isoformat(timespec="seconds"),
        )
        counts = _counts_line(reached=0, sent=0, course_until=None, at=None)
        self._counts_at, self._end = len(first), len(first) + len(counts)
        self._counts = self._noted = (0, 0)
        self._noted_s = -math.inf
        self._map: list[Piece] = []
        self._map_until: int | None = None
        self._failure: OSError | None = None
        if os.path.lexists(path) and not path.is_file():
            raise OutputError(str(path), "it is not a file")  # a pipe would be waited for
        with written_aside(path) as file:
            cast("IO[str]", file).write((first + counts).decode())
        try:
            _sync_folder(path.parent)
            self._file = path.open("r+b", buffering=0)
        except OSError as error:
            raise OutputError(str(path), error.strerror or str(error)) from error
        self._writer = ThreadPoolExecutor(max_workers=1, thread_name_prefix="journal")

    @property
    def in_doubt(self) -> range:
        """As of an Entry."""
        return range(self.next_stroke, self._last_sent + 1)

    def sent(self, stroke: int) -> None:
        """All of stroke `stroke` and of those before it has been sent."""
        self._last_sent = stroke
        self._writer.submit(self._add, _line(sent_stroke=stroke))

    def finished(self, stroke: int) -> None:
        """Stroke `stroke` and all before it are drawn."""
        self.next_stroke = stroke + 1
        self._writer.submit(self._add, _line(next_stroke=self.next_stroke))

    def counted(self, tally: Tally) -> None:
        """The controller counts this run so, and remembers its count."""
        self._writer.submit(self._add, _line(tally=asdict(tally)))

    def planned(self, first: int, samples: FloatArray) -> None:
        """Set points from number `first` on, counted from 1, will be at these `samples` (n,) of the trajectory."""
        self._map.append(piece(first, samples))
        self._writer.submit(self._change_map, first, _line(course=self._map[-1]))

    def wait(self) -> None:
        """Until everything said so far is on disk. Errors: OutputError if some of it is not, ever."""
        self._writer.submit(lambda: None).result()
        if self._failure is not None:
            raise OutputError(str(self._path), self._failure.strerror or str(self._failure)) from self._failure

    def reached(self, executed: int, sent: int) -> None:
        """So many set points are known to have been reached, of so many; noted every now and then, and at the end."""
        self._counts = executed, sent
        if self._clock.now_s() - self._noted_s >= NOTED_EVERY_S:
            self._note_counts()

    def close(self, ended: str, *, complete: bool = False) -> None:
        """Say how the run ended, and wait until everything is on disk. Errors: OutputError."""
        self._note_counts()
        self._writer.submit(self._add, _line(ended=COMPLETE if complete else ended))
        try:
            self.wait()
        finally:
            self._writer.shutdown()
            self._file.close()

    def _note_counts(self) -> None:
        self._noted_s = self._clock.now_s()
        if self._counts != self._noted:
            self._noted = self._counts
            self._writer.submit(self._overwrite_counts, *self._counts)

    def _overwrite_counts(self, reached: int, sent: int) -> None:
        """Too often to wait for the disk: it outlives this process, and a power failure costs a few of them."""
        line = _counts_line(
            reached=reached, sent=sent, course_until=self._map_until, at=sample_after(self._map, reached)
        )
        self._write(self._counts_at, line, durable=False)

    def _change_map(self, first: int, line: bytes) -> None:
        """Where there is no room for that, what was said before of set points from `first` on no longer holds."""
        if not self._add(line) and self._map_until is None:
            self._map_until = first - 1
            self._overwrite_counts(*self._noted)

    def _add(self, line: bytes) -> bool:
        written = self._write(self._end, line, durable=True)
        self._end += len(line) if written else 0
        return written

    def _write(self, at: int, line: bytes, *, durable: bool) -> bool:
        try:
            self._file.seek(at)
            while line:
                line = line[self._file.write(line) or 0 :]
            if durable:
                os.fsync(self._file.fileno())
        except OSError as error:
            self._failure = self._failure or error
            return False
        return True


def _line(**facts: object) -> bytes:
    return json.dumps(facts).encode() + b"\n"


def _counts_line(**counts: float | None) -> bytes:
    """As long whatever it says."""
    return _line(**counts).rstrip().ljust(_COUNTS_LENGTH) + b"\n"


def _sync_folder(folder: Path) -> None:
    """A new name is on disk only once its folder is; where folders cannot be opened, the system sees to it."""
    if os.name == "posix":
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
