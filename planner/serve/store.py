"""Drawings and what became of them, in a folder that outlives the server."""

from __future__ import annotations

import json
import re
import secrets
import shutil
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass, field, fields
from enum import StrEnum
from pathlib import Path
from typing import IO, Any, cast

from planner.errors import OutputError, UsageError
from planner.files import written_aside

_JOB = "job.json"
_ID = re.compile(r"[0-9a-f]{16}")
_LONGEST_NAME = 60
_MOST_NAME_BYTES = 200
"""Names of files may have 255 on most systems, and those of journals are longer than their drawing's."""
SUFFIXES = (".svg", ".svgz", ".png", ".jpg", ".jpeg")


class State(StrEnum):
    """Where a job stands."""

    READING = "reading"
    READ = "read"
    PLANNING = "planning"
    PLANNED = "planned"
    FAILED = "failed"


_UNSETTLED = {State.READING: State.FAILED, State.PLANNING: State.READ}
"""What a job has come back to that a server died over."""


@dataclass(slots=True)
class Job:
    """One drawing. options: of the plan, as the page gave them; command: the same for a terminal; error: why it could
    not be read or planned; notes: warnings; progress: share of the plan that is done; drawn: its runs, the newest
    last: when they ended (at, s since the epoch), the driver, and how."""

    id: str
    name: str
    made: float
    state: State = State.READING
    options: dict[str, Any] = field(default_factory=dict)
    command: str = ""
    error: str = ""
    notes: list[str] = field(default_factory=list)
    summary: list[str] = field(default_factory=list)
    stage: str = ""
    progress: float = 0.0
    drawn: list[dict[str, Any]] = field(default_factory=list)

    @property
    def trajectory_name(self) -> str:
        return f"{Path(self.name).stem}.csv"


class Store:
    """Jobs by their ids, each with a folder of its own. Errors: OutputError where the folder cannot be had."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder.absolute()
        try:
            (self.folder / "jobs").mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(str(folder), error.strerror or str(error)) from error
        self._jobs = {job.id: job for job in sorted(self._found(), key=lambda job: job.made)}

    def __iter__(self) -> Iterator[Job]:
        return iter(list(self._jobs.values()))

    def __getitem__(self, key: str) -> Job:
        """Errors: KeyError."""
        return self._jobs[key]

    def of(self, job: Job) -> Path:
        """The folder of a job."""
        return self.folder / "jobs" / job.id

    def trajectory(self, job: Job) -> Path:
        return self.of(job) / job.trajectory_name

    def add(self, name: str, content: bytes) -> Job:
        """A new job. Errors: UsageError for what is no drawing by its name, OutputError."""
        job = Job(secrets.token_hex(8), safe_name(name), time.time())
        try:
            self.of(job).mkdir()
            (self.of(job) / job.name).write_bytes(content)
        except OSError as error:
            shutil.rmtree(self.of(job), ignore_errors=True)
            raise OutputError(job.name, error.strerror or str(error)) from error
        self._jobs[job.id] = job
        self.keep(job)
        return job

    def keep(self, job: Job) -> None:
        """Write down what has changed, where the disk allows it."""
        with suppress(OutputError), written_aside(self.of(job) / _JOB) as file:
            cast("IO[str]", file).write(json.dumps(asdict(job)))

    def remove(self, job: Job) -> None:
        self._jobs.pop(job.id, None)
        shutil.rmtree(self.of(job), ignore_errors=True)

    def _found(self) -> Iterator[Job]:
        """Those of earlier servers; what cannot be read is passed over."""
        known = {field.name for field in fields(Job)}
        for folder in (self.folder / "jobs").iterdir():
            with suppress(OSError, ValueError, TypeError, KeyError, UsageError):
                said = json.loads((folder / _JOB).read_text(encoding="utf-8"))
                job = Job(**{key: value for key, value in said.items() if key in known})
                if job.id != folder.name or not _ID.fullmatch(job.id) or job.name != safe_name(job.name):
                    continue
                job.state = State(job.state)
                job.drawn = [run for run in job.drawn if isinstance(run, dict)]
                if job.state in _UNSETTLED:
                    job.state, job.error = _UNSETTLED[job.state], "the server ended meanwhile"
                yield job


def safe_name(name: str) -> str:
    """A file name of letters, digits and a few signs, that says what it was. Errors: UsageError for what is no drawing
    by its suffix."""
    last = name.replace("\\", "/").rpartition("/")[2]
    stem, dot, suffix = last.rpartition(".")
    if f"{dot}{suffix.lower()}" not in SUFFIXES:
        raise UsageError(f"'{last[:_LONGEST_NAME]}' is not a drawing: its name should end in {', '.join(SUFFIXES)}")
    cleaned = re.sub(r"[^\w-]+", "-", stem).strip("-_")[:_LONGEST_NAME] or "drawing"
    cleaned = cleaned.encode()[:_MOST_NAME_BYTES].decode(errors="ignore")
    return f"{cleaned}.{suffix.lower()}"
