"""What of a trajectory has been drawn, kept beside its file so that it outlives whatever may happen to the host.

A line of JSON for each thing to remember. The first says what is being drawn and from where on. The second, which is
as long as ever and is written over, says how many set points the arm has reached. The others, only ever added, say how
the controller counts, where in the trajectory the set points are, which stroke comes next and, at last, how the run
ended. A line that a power failure or a full disk has torn is passed over.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, Any, cast

from hardware.clock import Clock
from hardware.course import Piece, piece, sample_after
from hardware.driver import Tally
from planner.arrays import FloatArray
from planner.errors import OutputError, TrajectoryFileError
from planner.trajectory import written_aside

_VERSION = 2
_READABLE = (1, 2)
_COMPLETE = "complete"
_MOST = 1 << 48
"""Nothing that a journal counts comes to so many."""
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


@dataclass(frozen=True, slots=True)
class Entry:
    """What a journal says: the trajectory's digest, the arm and the driver, the stroke to go on from, and how the last
    run ended, "" if nobody was left to say.

    sample: the sample of the trajectory that the run began at, None for that of its stroke. tally: how the controller
    counts the run, None where it does not. course: where its set points are, to be believed up to number
    `course_until` if that is not None. reached, sent: set points known to have been reached, of how many; at: the
    sample that they led to.
    """

    sha256: str
    arm: str
    driver: str
    next_stroke: int
    ended: str
    sample: int | None = None
    tally: Tally | None = None
    course: tuple[Piece, ...] = ()
    reached: int = 0
    sent: int = 0
    course_until: int | None = None
    at: float | None = None

    @property
    def complete(self) -> bool:
        return self.ended == _COMPLETE

    @property
    def settled(self) -> bool:
        """Whether the run was there to see all that it sent being reached."""
        return bool(self.ended) and self.reached == self.sent

    def come_to(self, reached: int) -> float | None:
        """The sample of the trajectory where `reached` set points have led, None for the beginning of its stroke."""
        by_course = sample_after(self.course, reached if self.course_until is None else min(reached, self.course_until))
        known = (self.sample, by_course, self.at if reached >= self.reached else None)
        return max((sample for sample in known if sample is not None), default=None)


def read_journal(path: Path) -> Entry | None:
    """What the journal says, None where there is none. Errors: TrajectoryFileError if it is no journal."""
    try:
        lines = path.read_bytes().splitlines()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise TrajectoryFileError(str(path), None, f"cannot be read: {error.strerror}") from error
    told: dict[str, Any] = {"ended": "", "sample": None, "tally": None, "reached": 0, "sent": 0,
                            "course_until": None, "at": None}
    course = []
    for line in lines:
        try:
            told |= json.loads(line)
        except (ValueError, TypeError, RecursionError):
            continue  # torn: what the other lines say holds
        if "course" in told:
            course.append(told.pop("course"))
    try:
        if told["journal"] in _READABLE:
            return _entry(told, course)
    except (KeyError, TypeError, ValueError, OverflowError):
        pass
    raise TrajectoryFileError(str(path), None, "is not a journal of this program; draw without --resume to replace it")


def _entry(told: dict[str, Any], course: list[Any]) -> Entry:
    """Errors: KeyError, TypeError, ValueError, OverflowError where something is missing or not what it should be."""
    tally = None if told["tally"] is None else Tally(**told["tally"])
    at = None if told["at"] is None else float(told["at"])
    pieces = tuple(tuple((int(count), float(at)) for count, at in one) for one in course)
    words = [told[key] for key in ("sha256", "arm", "driver", "ended")]
    counts = [*(told[key] for key in ("next_stroke", "reached", "sent")), *(asdict(tally).values() if tally else ()),
              *(count for one in pieces for count, _ in one),
              *(told[key] for key in ("sample", "course_until") if told[key] is not None)]
    if not all(isinstance(word, str) for word in words) or not all(type(count) is int for count in counts):
        raise TypeError
    if not all(0 <= count < _MOST for count in counts) or not all(pieces) or not all(
            math.isfinite(sample) for one in (*pieces, [(0, at or 0.0)]) for _, sample in one):
        raise ValueError
    return Entry(words[0], words[1], words[2], told["next_stroke"], words[3], told["sample"], tally, pieces,
                 told["reached"], told["sent"], told["course_until"], at)


class Journal:
    """A journal being written. What is told while the arm moves is put on disk by a thread of its own: a slow disk
    never makes a set point late. What cannot be written is an error at the end, and makes nothing untrue."""

    def __init__(self, path: Path, beginning: Entry, clock: Clock) -> None:
        """Begin a new journal in place of any other, on disk when this returns. Errors: OutputError."""
        self._path, self.next_stroke, self._clock = path, beginning.next_stroke, clock
        first = _line(journal=_VERSION, sha256=beginning.sha256, arm=beginning.arm, driver=beginning.driver,
                      next_stroke=beginning.next_stroke, sample=beginning.sample)
        counts = _counts_line(reached=0, sent=0, course_until=None, at=None)
        self._counts_at, self._end = len(first), len(first) + len(counts)
        self._counts = self._noted = (0, 0)
        self._noted_s = -math.inf
        self._course: list[Piece] = []
        self._course_until: int | None = None
        self._failure: OSError | None = None
        with written_aside(path) as file:
            cast("IO[str]", file).write((first + counts).decode())
        try:
            _sync_folder(path.parent)
            self._file = path.open("r+b", buffering=0)
        except OSError as error:
            raise OutputError(str(path), error.strerror or str(error)) from error
        self._writer = ThreadPoolExecutor(max_workers=1, thread_name_prefix="journal")

    def finished(self, stroke: int) -> None:
        """Stroke `stroke` and all before it are drawn."""
        self.next_stroke = stroke + 1
        self._writer.submit(self._add, _line(next_stroke=self.next_stroke))

    def counted(self, tally: Tally) -> None:
        """The controller counts this run so, and remembers its count."""
        self._writer.submit(self._add, _line(tally=asdict(tally)))

    def onward(self, first: int, samples: FloatArray) -> None:
        """Set points from number `first` on, counted from 1, will be at these `samples` (n,) of the trajectory."""
        self._course.append(piece(first, samples))
        self._writer.submit(self._change_course, first, _line(course=self._course[-1]))

    def wait(self) -> None:
        """Until all that was told is on disk. Errors: OutputError if some of it is not, ever."""
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
        self._writer.submit(self._add, _line(ended=_COMPLETE if complete else ended))
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
        line = _counts_line(reached=reached, sent=sent, course_until=self._course_until,
                            at=sample_after(self._course, reached))
        self._write(self._counts_at, line, durable=False)

    def _change_course(self, first: int, line: bytes) -> None:
        """Where there is no room for that, what was told of set points from `first` on must not be believed."""
        if not self._add(line) and self._course_until is None:
            self._course_until = first - 1
            self._overwrite_counts(*self._noted)

    def _add(self, line: bytes) -> bool:
        written = self._write(self._end, line, durable=True)
        self._end += len(line) if written else 0
        return written

    def _write(self, at: int, line: bytes, *, durable: bool) -> bool:
        try:
            self._file.seek(at)
            while line:
                line = line[self._file.write(line) or 0:]
            if durable:
                os.fsync(self._file.fileno())
        except OSError as error:
            self._failure = self._failure or error
            return False
        return True


def _line(**told: object) -> bytes:
    return json.dumps(told).encode() + b"\n"


def _counts_line(**told: float | None) -> bytes:
    """As long whatever it says."""
    return _line(**told).rstrip().ljust(_COUNTS_LENGTH) + b"\n"


def _sync_folder(folder: Path) -> None:
    """A new name is on disk only once its folder is; where folders cannot be opened, the system sees to it."""
    if os.name == "posix":
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
