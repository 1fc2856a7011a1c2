"""Many drawings, each planned by itself: one that fails does not stop the others."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from planner.arms.arm_file import load_arm
from planner.errors import OutputError, PlannerError, UsageError
from planner.execution.context import PlanContext
from planner.execution.workers import ALONE, Workers, executor_of
from planner.pipeline import plan_with
from planner.settings import PlanSettings
from planner.summary import PlanSummary
from planner.trajectory import write_trajectory


@dataclass(frozen=True, slots=True)
class Job:
    """A drawing and the file that its trajectory goes to, if to any."""

    drawing: Path
    target: Path | None


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a drawing: a summary, or the error that says why there is none."""

    job: Job
    summary: PlanSummary | None
    error: PlannerError | MemoryError | None


def jobs_of(folder: Path, out_folder: Path) -> list[Job]:
    """A job for each SVG of a folder, by name; `out_folder` is made if it is missing. Errors: UsageError,
    OutputError."""
    jobs = [Job(drawing, out_folder / f"{drawing.stem}.csv") for drawing in _drawings_of(folder)]
    targets = [job.target for job in jobs]
    for job in jobs:
        if targets.count(job.target) > 1:
            raise UsageError(f"several drawings would be written to {job.target}: rename one of them")
    try:
        out_folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(str(out_folder), error.strerror or str(error)) from error
    return jobs


def estimates_of(drawings: Path) -> list[Job]:
    """A job without a file for a drawing, or for each of a folder. Errors: UsageError."""
    return [Job(drawing, None) for drawing in (_drawings_of(drawings) if drawings.is_dir() else [drawings])]


def _drawings_of(folder: Path) -> list[Path]:
    try:
        drawings = sorted(path for path in folder.iterdir() if path.suffix.lower() == ".svg" and path.is_file())
    except OSError as error:
        raise UsageError(f"{folder} cannot be read as a folder: {error.strerror}") from error
    if not drawings:
        raise UsageError(f"there are no drawings (.svg) in {folder}")
    return drawings


def plan_all(jobs: Sequence[Job], settings: PlanSettings, workers: Workers) -> Iterator[Outcome]:
    """Plan and write all drawings, at most one a worker at a time; outcomes come in the order of the jobs. What is
    computed of the arm is computed once in each process. A cluster has to see the same files under the same names.
    Errors: PlannerError where there is no such arm."""
    context = PlanContext.of(load_arm(settings.arm, cache=settings.cache), settings)
    with executor_of(workers if len(jobs) > 1 else ALONE) as executor:
        yield from executor(partial(_planned, context), jobs)


def _planned(context: PlanContext, job: Job) -> Outcome:
    try:
        result = plan_with(context, job.drawing)  # whole drawings are counted, not what is done within one
        if job.target is not None:
            write_trajectory(result.trajectory, job.target)
    except (PlannerError, MemoryError) as error:
        return Outcome(job, None, error)
    return Outcome(job, result.summary, None)
