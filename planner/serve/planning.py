"""Drawings are read and planned, one after the other, each by the command in a process of its own."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Mapping, Sequence
from typing import Any

from planner.serve.arms import VIEW, Arms
from planner.serve.asked import arguments_of, command_of
from planner.serve.child import Child, error_of, finished, follow, start
from planner.serve.store import Job, State, Store

LINES = "lines.json"
MOTION = "motion.json"


Work = Callable[[], Coroutine[Any, Any, None]]


class Planning:
    """The work on jobs. changed: called with each job that has changed."""

    def __init__(self, store: Store, arms: Arms, changed: Callable[[Job], None]) -> None:
        self._store, self._arms, self._changed = store, arms, changed
        self._turn = asyncio.Semaphore(1)
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._children: dict[str, Child] = {}

    def read(self, job: Job) -> None:
        """Begin to read a new drawing."""
        self._begin(job, State.READING, lambda: self._read(job))

    def plan(self, job: Job, asked: Mapping[str, Any]) -> None:
        """Begin to plan, in the place of what was being done with the job. Errors: UsageError for options that mean
        nothing."""
        words = arguments_of(asked, self._arms.word)
        job.options, job.command = dict(asked), self.command(job, asked)
        self._begin(job, State.PLANNING, lambda: self._plan(job, words))

    def command(self, job: Job, asked: Mapping[str, Any]) -> str:
        """What `plan` would do, for a terminal. Errors: UsageError for options that mean nothing."""
        return command_of(job.name, job.trajectory_name, arguments_of(asked, self._arms.word))

    def cancel(self, job: Job) -> None:
        """Leave it; what had been planned before is kept."""
        task = self._tasks.get(job.id)
        if task is not None:
            task.cancel()

    async def close(self) -> None:
        tasks = list(self._tasks.values())
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def _begin(self, job: Job, state: State, work: Work) -> None:
        self.cancel(job)
        before = self._tasks.get(job.id)
        job.state, job.error, job.progress, job.stage = state, "", 0.0, ""
        self._tasks[job.id] = asyncio.get_running_loop().create_task(self._in_turn(job, work, before))
        self._changed(job)

    async def _in_turn(self, job: Job, work: Work, before: asyncio.Task[None] | None) -> None:
        try:
            if before is not None:
                await asyncio.wait([before])
            async with self._turn:
                await work()
        except asyncio.CancelledError:
            if self._tasks.get(job.id) is asyncio.current_task():  # else the next work on it has begun
                job.state = State.READ if (self._store.of(job) / LINES).exists() else State.FAILED
                job.error = "cancelled"
            raise
        finally:
            child = self._children.pop(job.id, None)
            if child is not None and child.process.returncode is None:
                await child.end()
            if self._tasks.get(job.id) is asyncio.current_task():
                del self._tasks[job.id]
                self._settled(job)

    def _settled(self, job: Job) -> None:
        if self._store.of(job).exists():  # it may have been thrown away meanwhile
            self._store.keep(job)
        self._changed(job)

    async def _read(self, job: Job) -> None:
        arguments = ["lines", job.name, "--json", LINES, "--quiet"]
        error = await finished(arguments, self._store.of(job), lambda child: self._children.__setitem__(job.id, child))
        job.state, job.error = (State.READ, "") if error is None else (State.FAILED, error)

    async def _plan(self, job: Job, words: Sequence[str]) -> None:
        folder = self._store.of(job)
        (folder / MOTION).unlink(missing_ok=True)
        child = await start([job.name, *words, "-o", job.trajectory_name, "--events"], folder, behind=True)
        self._children[job.id] = child

        def told(event: dict[str, Any]) -> None:
            if event.get("event") == "progress":
                job.stage, job.progress = str(event["stage"]), event["done"] / max(event["total"], 1)
                self._changed(job)
            elif event.get("event") == "done":
                job.summary = [str(line) for line in event["summary"]]

        code = await follow(child, told)
        job.notes = [note.removeprefix("warning: ") for note in child.notes if note.startswith("warning: ")]
        if code:
            self._store.trajectory(job).unlink(missing_ok=True)
            job.state, job.error, job.summary = State.FAILED, error_of(child, code), []
            return
        job.stage = "film"
        self._changed(job)
        error = await finished(["film", job.trajectory_name, MOTION], folder, module=VIEW)
        job.state, job.progress, job.error = State.PLANNED, 1.0, error or ""
