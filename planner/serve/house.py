"""All that a server knows, in one place: its drawings, the work on them, the arm, and who looks on."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from hardware.drivers.table import DRIVERS, SIMULATED, SIMULATORS
from hardware.playback.journal import journal_path
from hardware.playback.journal_entry import read_journal
from planner.errors import PlannerError, UsageError
from planner.serve.arms import Arms
from planner.serve.calibration import KEY, Calibration
from planner.serve.feed import Feed
from planner.serve.jog import Jog
from planner.serve.planning import Planning
from planner.serve.run import Arm, Playable
from planner.serve.store import Job, State, Store
from planner.serve.turn import Turn

MOST_JOBS = 200
_MOST_RUNS = 20
"""Whose ends are kept of a job."""


class House:
    """drivers: those that may move an arm here. Errors: OutputError where the folder cannot be had."""

    def __init__(self, folder: Path, drivers: tuple[str, ...] = DRIVERS) -> None:
        self.drivers = drivers
        self.store = Store(folder)
        self.feed = Feed()
        self.arms = Arms(self.store.folder / "arms")
        self.planning = Planning(self.store, self.arms, self.tell_job)
        turn = Turn()
        self.arm = Arm(drivers, turn, lambda: self.feed.changed("run", self.arm.state))
        self.jog = Jog(self.store.folder, self.arms, drivers, turn, self._jog_changed, self._arms_changed)
        self.calibration = Calibration(
            self.store.folder / KEY, self.arms, self._calibration_changed, self._arms_changed
        )

    def state(self) -> dict[str, Any]:
        """Everything, for a page that has just been opened."""
        return {
            "jobs": [self.job_state(job) for job in self.store],
            "run": self.arm.state(),
            "jog": self.jog.state(),
            "calibration": self.calibration.state(),
            "arms": list(self.arms.names()),
            "drivers": list(self.drivers),
            "simulators": list(SIMULATORS),
        }

    def job_state(self, job: Job) -> dict[str, Any]:
        return asdict(job) | {"trajectory": job.trajectory_name, "resumable": self._resumable(job)}

    def tell_job(self, job: Job) -> None:
        def state() -> dict[str, Any]:
            known = any(other is job for other in self.store)
            return self.job_state(job) if known else {"id": job.id, "gone": True}

        self.feed.changed(f"job {job.id}", state)

    def add(self, name: str, content: bytes) -> Job:
        """A new drawing, that is going to be read, in the place of the oldest where there are too many: but what is
        drawn stays. Errors: UsageError for what is no drawing by its name, OutputError."""
        job = self.store.add(name, content)
        for oldest in list(self.store)[:-MOST_JOBS]:
            with suppress(UsageError):
                self.remove(oldest)
        self.planning.read(job)
        return job

    def remove(self, job: Job) -> None:
        """Errors: UsageError while it is being drawn."""
        self.refuse_while_drawn(job.id, job.name)
        self.planning.cancel(job)
        self.store.remove(job)
        self.tell_job(job)

    def refuse_while_drawn(self, key: str, name: str) -> None:
        """Errors: UsageError."""
        if self.arm.runs(key):
            raise UsageError(f"{name} is being drawn: stop that first")

    def run(self, job: Job, asked: Mapping[str, Any]) -> None:
        """Errors: UsageError where it is not planned, and as `Arm.begin`."""
        if job.state is not State.PLANNED or not self.store.trajectory(job).is_file():
            raise UsageError(f"{job.name} is not planned yet")

        def ended(how: str, complete: bool) -> None:
            run = {"at": time.time(), "driver": str(asked.get("driver", SIMULATED)), "how": how}
            job.drawn = [*job.drawn, run][-_MOST_RUNS:]
            self.store.keep(job)
            self.tell_job(job)

        self.arm.begin(Playable(job.id, job.name, self.store.of(job), job.trajectory_name, ended), asked)

    async def close(self) -> None:
        """The arm is parked and nothing runs any more."""
        await asyncio.gather(self.arm.close(), self.jog.close(), self.planning.close(), self.calibration.close())
        self.arms.close()

    def _jog_changed(self) -> None:
        self.feed.changed("jog", self.jog.state)

    def _calibration_changed(self) -> None:
        self.feed.changed("calibration", self.calibration.state)

    def _arms_changed(self) -> None:
        self.feed.changed("arms", lambda: list(self.arms.names()))

    def _resumable(self, job: Job) -> str:
        """The driver whose run of it may go on, by the journal that the run has left; "" for none."""
        if job.state is not State.PLANNED or self.arm.runs(job.id):
            return ""
        for simulated in (False, True):
            try:
                entry = read_journal(journal_path(self.store.trajectory(job), simulated=simulated))
            except PlannerError:
                continue
            if entry is not None and not entry.complete:
                return entry.driver or SIMULATED
        return ""
