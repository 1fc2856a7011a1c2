"""What a journal says: which trajectory a run was drawing, how far it is known to have come, and how it ended.

A journal is a file of lines, each a JSON object. The first names its version, the trajectory and the run; the others
say what has become known since, and each is complete in itself. A line that is torn is passed over, and another first
line begins anew. Version 1 knows only whole strokes; version 2 counts set points as well, where the controller
remembers its count.
"""

from __future__ import annotations

import json
import math
import os
import stat
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hardware.drivers.driver import Tally
from hardware.playback.sample_map import Piece, sample_after
from planner.errors import TrajectoryFileError

VERSION = 2
COMPLETE = "complete"
_READABLE = (1, 2)
_MOST = 1 << 48
"""More than a journal ever counts."""
_MOST_BYTES = 1 << 26
"""No journal is as long as that: a stroke adds some fifty bytes, a pause some hundred."""
_LONGEST_TEXT = 1000
_UNSAID: dict[str, Any] = {
    "ended": "",
    "sample": None,
    "tally": None,
    "reached": 0,
    "sent": 0,
    "course_until": None,
    "at": None,
    "sent_stroke": -1,
}
"""What holds where no line says otherwise."""


@dataclass(frozen=True, slots=True)
class Entry:
    """What a journal says: the trajectory's digest, the arm and the driver, the stroke to go on from, and how the last
    run ended, "" if nobody was left to say.

    last_sent: the last stroke of which all was sent, -1 for none, or where the controller counts.
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
    last_sent: int = -1
    sample: int | None = None
    tally: Tally | None = None
    course: tuple[Piece, ...] = ()
    reached: int = 0
    sent: int = 0
    course_until: int | None = None
    at: float | None = None

    @property
    def complete(self) -> bool:
        return self.ended == COMPLETE

    @property
    def in_doubt(self) -> range:
        """Strokes that were sent, and of which nobody knows whether they were drawn."""
        return range(self.next_stroke, self.last_sent + 1)

    @property
    def all_reached(self) -> bool:
        """Whether the run ended by itself and saw everything that it sent being reached."""
        return bool(self.ended) and self.reached == self.sent

    def come_to(self, reached: int) -> float | None:
        """The sample of the trajectory where `reached` set points have led, None for the beginning of its stroke."""
        by_course = sample_after(self.course, reached if self.course_until is None else min(reached, self.course_until))
        known = (self.sample, by_course, self.at if reached >= self.reached else None)
        return max((sample for sample in known if sample is not None), default=None)


def read_journal(path: Path) -> Entry | None:
    """What the journal says, None where there is none. Errors: TrajectoryFileError if it is no journal."""
    try:
        lines = _content(path).splitlines()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise TrajectoryFileError(str(path), None, f"cannot be read: {error.strerror}") from error
    facts: dict[str, Any] = {}
    course: list[Any] = []
    for line in lines:
        said = _said(line)
        if "journal" in said:
            facts, course = dict(_UNSAID), []
        if "course" in said:
            course.append(said.pop("course"))
        facts |= said
    try:
        if facts["journal"] in _READABLE:
            return _entry(facts, course)
    except (KeyError, TypeError, ValueError, OverflowError):
        pass
    raise TrajectoryFileError(str(path), None, "is not a journal of this program; draw without --resume to replace it")


def _content(path: Path) -> bytes:
    """Errors: OSError; TrajectoryFileError where it cannot be a journal. A pipe is not waited for."""
    with open(path, "rb", opener=lambda name, flags: os.open(name, flags | getattr(os, "O_NONBLOCK", 0))) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise TrajectoryFileError(str(path), None, "is not a file, so it is not a journal; remove it")
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


def _entry(facts: dict[str, Any], course: list[Any]) -> Entry:
    """Errors: KeyError, TypeError, ValueError, OverflowError where something is missing or not what it should be."""
    tally = None if facts["tally"] is None else Tally(**facts["tally"])
    at = None if facts["at"] is None else float(facts["at"])
    pieces = tuple(tuple((int(count), float(sample)) for count, sample in one) for one in course)
    words = [facts[key] for key in ("sha256", "arm", "driver", "ended")]
    counts = [
        *(facts[key] for key in ("next_stroke", "reached", "sent")),
        *(asdict(tally).values() if tally else ()),
        *(count for one in pieces for count, _ in one),
        *(facts[key] for key in ("sample", "course_until") if facts[key] is not None),
    ]
    if not all(isinstance(word, str) for word in words):
        raise TypeError
    if not all(type(count) is int for count in (*counts, facts["sent_stroke"])):
        raise TypeError
    if (
        not all(0 <= count < _MOST for count in (*counts, facts["sent_stroke"] + 1))
        or not all(pieces)
        or not all(math.isfinite(sample) for one in (*pieces, [(0, at or 0.0)]) for _, sample in one)
    ):
        raise ValueError
    return Entry(
        words[0],
        _shown(words[1]),
        words[2],
        facts["next_stroke"],
        _shown(words[3]),
        facts["sent_stroke"],
        facts["sample"],
        tally,
        pieces,
        facts["reached"],
        facts["sent"],
        facts["course_until"],
        at,
    )


def _shown(text: str) -> str:
    """Fit for one line of a terminal."""
    return "".join(character if character.isprintable() else " " for character in text[:_LONGEST_TEXT])
