"""All that a server knows, in one place: its drawings, the work on them, the arm, and who looks on."""

from __future__ import annotations

import asyncio
from dataclasses import asdict
from pathlib import Path
from typing import Any

from hardware.drivers.table import DRIVERS, SIMULATED, SIMULATORS
from hardware.playback.journal import journal_path
from hardware.playback.journal_entry import read_journal
from planner.arms.arm_file import known_arms
from planner.errors import PlannerError, UsageError
from planner.serve.child import finished
from planner.serve.feed import Feed
from planner.serve.planning import VIEW, Planning
from planner.serve.run import Arm
from planner.serve.store import Job, State, Store


class House:
    """drivers: those that may move an arm here. Errors: OutputError where the folder cannot be had."""

    def __init__(self, folder: Path, drivers: tuple[str, ...] = DRIVERS) -> None:
        self.drivers = drivers
        self.store = Store(folder)
        self.feed = Feed()
        self.planning = Planning(self.store, self.arms, self.tell_job)
        self.arm = Arm(self.store, drivers, self._run_changed)
        self._views: dict[str, asyncio.Task[str | None]] = {}

    def arms(self) -> tuple[str, ...]:
        return known_arms()

    def state(self) -> dict[str, Any]:
        """Everything, for a page that has just been opened."""
        return {
            "jobs": [self.job_state(job) for job in self.store],
            "run": self.arm.state(),
            "arms": list(self.arms()),
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

    def remove(self, job: Job) -> None:
        """Errors: UsageError while it is being drawn."""
        if self.arm.is_busy and self.arm.running.job == job.id:
            raise UsageError(f"{job.name} is being drawn: stop that first")
        self.planning.cancel(job)
        self.store.remove(job)
        self.tell_job(job)

    async def arm_view(self, name: str) -> Path:
        """The file of what the page shows of an arm, worked out once. Errors: UsageError."""
        if name not in self.arms():
            raise UsageError(f"there is no arm '{name:.40}'")
        folder = self.store.folder / "arms"
        folder.mkdir(exist_ok=True)
        target = folder / f"{name}.view.json"
        if name not in self._views:
            self._views[name] = asyncio.create_task(finished(["arm", name, str(target)], folder, module=VIEW))
        error = await self._views[name]
        if error is not None:
            raise UsageError(error)
        return target

    async def close(self) -> None:
        """The arm is parked and nothing runs any more."""
        await asyncio.gather(self.arm.close(), self.planning.close())
        for task in self._views.values():
            task.cancel()

    def _run_changed(self, job: Job | None) -> None:
        self.feed.changed("run", self.arm.state)
        if job is not None:
            self.tell_job(job)

    def _resumable(self, job: Job) -> str:
        """The driver whose run of it may go on, by the journal that the run has left; "" for none."""
        if job.state is not State.PLANNED or (self.arm.is_busy and self.arm.running.job == job.id):
            return ""
        for simulated in (False, True):
            try:
                entry = read_journal(journal_path(self.store.trajectory(job), simulated=simulated))
            except PlannerError:
                continue
            if entry is not None and not entry.complete:
                return entry.driver or SIMULATED
        return ""
